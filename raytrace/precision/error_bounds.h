// Floating-point error bounds: the only numbers by which the ray tracer ever widens or moves anything.
// gamma(n) bounds the relative error of n rounded operations (Higham 2002, section 3.1; PBR 4th ed.,
// section 6.8.1). Every file of this room must be compiled with -ffp-contract=off.
#pragma once

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "scene/math.h"

namespace gnomon::raytrace {

inline constexpr double unit_roundoff = DBL_EPSILON / 2.0;

constexpr double error_gamma(int operations) {
  return operations * unit_roundoff / (1.0 - operations * unit_roundoff);
}

/// A float that is surely below (above) a double, by at least one unit in its last place; finite below +infinity. -infinity
/// and NaN stay.
inline float float_below(double value) {
  const float f = std::min(static_cast<float>(value), FLT_MAX);
  return f - (std::abs(f) * FLT_EPSILON + FLT_MIN);
}
inline float float_above(double value) {
  return -float_below(-value);
}

inline bool all_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline double max_component(const Vec3& v) {
  return std::max({v.x, v.y, v.z});
}

}  // namespace gnomon::raytrace
