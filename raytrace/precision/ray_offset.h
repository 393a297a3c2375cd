// The one ray-offset policy. A computed surface point lies within a bound of its surface (PBR 4th ed.,
// section 6.8.4-6.8.5); a ray that leaves it starts where that bound ends along the geometric normal
// (section 6.8.6), on the side it leaves to. Nothing else in the project moves a ray's origin, and no t_min
// above zero is used but by Precision::fast (raytrace/precision/fast.h, textbook_epsilon).
#pragma once

#include <bit>
#include <cmath>

#include "raytrace/tracer.h"

namespace gnomon::raytrace {

/// Triangle corners and barycentric weights -> the point. The second term is the reach of the rounding in a
/// later test of the neighbours, which see their corners from this point: it makes convex bodies free of
/// self-hits.
inline Vec3 triangle_point(const std::array<Vec3, 3>& corners, const Vec2& barycentric, Vec3& error) {
  const double b0 = 1.0 - barycentric.x - barycentric.y;
  const Vec3 a = b0 * corners[0], b = barycentric.x * corners[1], c = barycentric.y * corners[2];
  const Vec3 extent = glm::max(corners[0], glm::max(corners[1], corners[2])) -
                      glm::min(corners[0], glm::min(corners[1], corners[2]));
  error = error_gamma(7) * (glm::abs(a) + glm::abs(b) + glm::abs(c)) +
          error_gamma(24) * Vec3(max_component(extent));
  return a + b + c;
}

/// The point put back onto the sphere along the radius.
inline Vec3 sphere_point(const Sphere& sphere, const Vec3& near_surface, Vec3& error) {
  const Vec3 offset = near_surface - sphere.center;
  const Vec3 on_sphere = offset * (sphere.radius / glm::length(offset));
  const Vec3 point = sphere.center + on_sphere;
  error = error_gamma(16) * glm::abs(on_sphere) + error_gamma(2) * glm::abs(point) +
          Vec3(error_gamma(8) * sphere.radius);
  return point;
}

/// The point moved onto the plane along its normal.
inline Vec3 plane_point(const Plane& plane, const Vec3& near_surface, Vec3& error) {
  const Vec3 offset = near_surface - plane.point;
  const Vec3 point = near_surface - glm::dot(plane.normal, offset) * plane.normal;
  const double distance_error =
      error_gamma(8) * glm::dot(glm::abs(plane.normal), glm::abs(near_surface) + glm::abs(plane.point));
  error = distance_error * glm::abs(plane.normal) + error_gamma(2) * glm::abs(point);
  return point;
}

/// The offset that leaves the error box on the side of `direction` (Pharr et al., OffsetRayOrigin).
inline Vec3 offset_vector(const SurfacePoint& from, const Vec3& direction) {
  const double distance = glm::dot(glm::abs(from.normal), from.position_error);
  return glm::dot(from.normal, direction) < 0.0 ? -distance * from.normal : distance * from.normal;
}

/// std::nextafter towards the infinity that has the sign of `to`; x itself where that is zero. Without
/// branches, for which way is anyone's guess.
inline double stepped(double x, double to) {
  const int step = (to > 0.0 ? 1 : 0) - (to < 0.0 ? 1 : 0);
  if (x == 0.0 || !std::isfinite(x)) [[unlikely]]
    return step == 0 ? x : std::nextafter(x, step * infinity);
  return std::bit_cast<double>(std::bit_cast<std::int64_t>(x) + (x > 0.0 ? step : -step));
}

/// The origin of a ray that leaves the point towards `direction`, rounded away from the surface.
inline Vec3 offset_origin(const SurfacePoint& from, const Vec3& direction) {
  const Vec3 offset = offset_vector(from, direction), origin = from.position + offset;
  return {stepped(origin.x, offset.x), stepped(origin.y, offset.y), stepped(origin.z, offset.z)};
}

}  // namespace gnomon::raytrace
