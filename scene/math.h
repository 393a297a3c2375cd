// The vector types and intervals that every room shares. Right-handed world; lengths in world units
// (metres by convention), angles in radians, double precision unless a name ends in f.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>

namespace gnomon {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using Vec4 = glm::dvec4;
using Mat3 = glm::dmat3;
using Mat4 = glm::dmat4;
using Vec2f = glm::vec2;
using Vec3f = glm::vec3;
using Vec4f = glm::vec4;
using Mat4f = glm::mat4;

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double pi = std::numbers::pi;

/// A closed interval [min, max]; empty when min > max.
struct Interval {
  double min = 0.0;
  double max = infinity;
  bool empty() const { return !(min <= max); }
  bool contains(double v) const { return min <= v && v <= max; }
};

/// Axis-aligned box, empty by default.
struct Aabb {
  Vec3 min{infinity};
  Vec3 max{-infinity};

  bool empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
  void grow(const Vec3& p) { min = glm::min(min, p), max = glm::max(max, p); }
  void grow(const Aabb& b) { min = glm::min(min, b.min), max = glm::max(max, b.max); }
  Vec3 center() const { return 0.5 * (min + max); }
  Vec3 extent() const { return max - min; }
  double diagonal() const { return empty() ? 0.0 : glm::length(max - min); }
  /// Half of the surface area, as the surface-area heuristic needs it.
  double half_area() const {
    if (empty()) return 0.0;
    const Vec3 e = extent();
    return e.x * e.y + e.y * e.z + e.z * e.x;
  }
};

/// Two unit vectors that complete the unit vector n to a right-handed orthonormal basis (tangent, bitangent,
/// n). Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6(1), listing 3.
inline void orthonormal_basis(const Vec3& n, Vec3& tangent, Vec3& bitangent) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1.0 / (sign + n.z);
  const double b = n.x * n.y * a;
  tangent = Vec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x);
  bitangent = Vec3(b, sign + n.y * n.y * a, -n.y);
}

/// The unit square onto the unit disc, area to area (Shirley and Chiu 1997, "A Low Distortion Map Between Disk
/// and Square").
inline Vec2 concentric_disc(const Vec2& square) {
  const Vec2 p = 2.0 * square - 1.0;
  if (p == Vec2(0.0)) return p;
  const bool wide = std::abs(p.x) > std::abs(p.y);
  const double radius = wide ? p.x : p.y;
  const double angle = wide ? pi / 4.0 * (p.y / p.x) : pi / 2.0 - pi / 4.0 * (p.x / p.y);
  return radius * Vec2(std::cos(angle), std::sin(angle));
}

// A ray owns its interval. The direction need not be unit length: t is in multiples of it.

struct Ray {
  Vec3 origin;
  Vec3 direction;
  Interval t{0.0, infinity};

  Vec3 at(double s) const { return origin + s * direction; }
};

}  // namespace gnomon
