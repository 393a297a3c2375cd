#include "raytrace/shading/smooth_surface.h"

#include <algorithm>
#include <array>

namespace gnomon::raytrace {
namespace {

/// Holds a triangle's corners: normals as the mesh has them, and the point's weights.
struct Corners {
  std::array<Vec3, 3> normal;
  std::array<double, 3> weight;

  Corners(const World& world, const SurfacePoint& point)
      : weight{1.0 - point.barycentric.x - point.barycentric.y, point.barycentric.x, point.barycentric.y} {
    const auto t = world.triangle(point.primitive);
    for (std::size_t i = 0; i < 3; ++i) normal[i] = Vec3(world.normal(t[i]));
  }
  Vec3 mean() const { return weight[0] * normal[0] + weight[1] * normal[1] + weight[2] * normal[2]; }
};

}  // namespace

Vec3 shading_normal(const World& world, const SurfacePoint& point) {
  if (!world.is_triangle(point.primitive)) return point.normal;
  const Vec3 n = Corners(world, point).mean();
  const double length = glm::length(n);
  if (!(length > 0.0)) return point.normal;
  return glm::dot(n, point.normal) < 0.0 ? -n / length : n / length;
}

bool corners_see_alike(const World& world, std::uint32_t primitive, const Vec3& normal, const Vec3& direction,
                       double margin) {
  const double side = glm::dot(normal, direction) < 0.0 ? -1.0 : 1.0;
  for (const std::uint32_t corner : world.triangle(primitive)) {
    const Vec3 n(world.normal(corner));
    if (!(glm::dot(n, normal) > 0.0) || !(side * glm::dot(n, direction) > margin)) return false;
  }
  return true;
}

SurfacePoint on_smooth_body(const World& world, const SurfacePoint& point) {
  if (!world.is_triangle(point.primitive)) return point;
  const Corners corners(world, point);
  const double side = glm::dot(corners.mean(), point.normal) < 0.0 ? -1.0 : 1.0;
  const std::array<Vec3, 3> place = world.corners(point.primitive);
  SurfacePoint body = point;
  body.normal = shading_normal(world, point);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 normal = side * corners.normal[i];
    const double below = std::min(0.0, glm::dot(point.position - place[i], normal));
    body.position -= corners.weight[i] * below * normal;
  }
  return body;
}

}  // namespace gnomon::raytrace
