// A conversion to float and back, compiled with the optimisation of the product instead of the tests' own.
#pragma once

#include "scene/math.h"

namespace gnomon::test {

/// Each component rounded to float.
Vec3 through_float(const Vec3& v);

}  // namespace gnomon::test
