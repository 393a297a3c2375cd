// A conversion to float and back, for core_rounding_test.cpp.
#include "scene/math.h"

namespace gnomon::test {

Vec3 through_float(const Vec3& v);

Vec3 through_float(const Vec3& v) {
  return Vec3(Vec3f(v));
}

}  // namespace gnomon::test
