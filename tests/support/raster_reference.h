// A slow, independent answer to compare the rasterizer with: brute-force rays in double precision.
#pragma once

#include <optional>

#include "scene/camera.h"
#include "scene/light_map/light_view.h"
#include "scene/world.h"

namespace gnomon::test {

struct ReferenceHit {
  double t = infinity;  ///< in multiples of the ray's direction
  std::uint32_t primitive = no_id;
  bool operator==(const ReferenceHit& o) const { return primitive == o.primitive; }
};

inline double hit_triangle(const Ray& ray, const std::array<Vec3, 3>& corners) {
  const Vec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
  const Vec3 p = glm::cross(ray.direction, e2);
  const double det = glm::dot(e1, p);
  if (det == 0.0) return infinity;
  const Vec3 s = ray.origin - corners[0];
  const double u = glm::dot(s, p) / det;
  const Vec3 q = glm::cross(s, e1);
  const double v = glm::dot(ray.direction, q) / det;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 ? glm::dot(e2, q) / det : infinity;
}

inline double hit_shape(const Ray& ray, const Shape& shape) {
  if (const auto* plane = std::get_if<Plane>(&shape.geometry))
    return glm::dot(plane->normal, plane->point - ray.origin) / glm::dot(plane->normal, ray.direction);
  const auto& sphere = std::get<Sphere>(shape.geometry);
  const Vec3 to_center = sphere.center - ray.origin;
  const double a = glm::dot(ray.direction, ray.direction);
  const double b = glm::dot(to_center, ray.direction) / a;
  const Vec3 beside = to_center - b * ray.direction;
  const double under_root = (sphere.radius * sphere.radius - glm::dot(beside, beside)) / a;
  if (under_root < 0.0) return infinity;
  const double near = b - std::sqrt(under_root);
  return near >= ray.t.min ? near : b + std::sqrt(under_root);
}

inline ReferenceHit closest_hit(const World& world, const Ray& ray) {
  ReferenceHit best;
  for (std::uint32_t i = 0; i < world.primitive_count(); ++i) {
    const double t =
        world.is_triangle(i) ? hit_triangle(ray, world.corners(i)) : hit_shape(ray, world.shape(i));
    if (t >= ray.t.min && t < best.t) best = {t, i};
  }
  return best;
}

/// The primitive at a pixel's centre, where the whole pixel agrees on it (its corners, moved in a little).
inline std::optional<ReferenceHit> hit_away_from_edges(const World& world, const View& view, int x, int y) {
  const ReferenceHit center = closest_hit(world, pixel_ray(view, x + 0.5, y + 0.5));
  for (int corner = 0; corner < 4; ++corner) {
    const Ray ray = pixel_ray(view, x + ((corner & 1) ? 0.75 : 0.25), y + ((corner & 2) ? 0.75 : 0.25));
    if (!(closest_hit(world, ray) == center)) return std::nullopt;
  }
  return center;
}

/// Returns the hit for a texel of a light's map.
inline std::optional<ReferenceHit> hit_away_from_edges(const World& world, const LightView& view, int face,
                                                       int column, int row) {
  const ReferenceHit center = closest_hit(world, texel_ray(view, face, column + 0.5, row + 0.5));
  for (int corner = 0; corner < 4; ++corner) {
    const Ray ray =
        texel_ray(view, face, column + ((corner & 1) ? 0.75 : 0.25), row + ((corner & 2) ? 0.75 : 0.25));
    if (!(closest_hit(world, ray) == center)) return std::nullopt;
  }
  return center;
}

/// Depth along the face's forward direction of a hit on a texel's ray.
inline double depth_of(const LightView& view, int face, const Ray& ray, double t) {
  return glm::dot(ray.at(t) - view.origin, view.faces[static_cast<std::size_t>(face)].forward);
}

}  // namespace gnomon::test
