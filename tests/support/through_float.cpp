#include "support/through_float.h"

namespace gnomon::test {

Vec3 through_float(const Vec3& v) {
  return Vec3(Vec3f(v));
}

}  // namespace gnomon::test
