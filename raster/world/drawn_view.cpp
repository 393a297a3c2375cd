// From where the world is drawn, so that floats suffice: the reference point, the eye, and how deep a view reaches.
#include <algorithm>
#include <cmath>

#include "raster/world/world_buffers.h"
#include "scene/shapes/triangle_blocks.h"

namespace gnomon::raster {

Vec3 reference_point(const World& world, const Vec3& eye) {
  if (world.finite_bounds.empty()) return eye;
  return glm::clamp(eye, world.finite_bounds.min, world.finite_bounds.max);
}

namespace {

/// The depths before an orthographic view's eye at which it may see something, with room at both ends. Planes count as far as
/// four times beyond what is finite: what of them lies deeper shares its depths.
Interval orthographic_depths(const World& world, const View& view) {
  Interval depths{infinity, -infinity};
  const auto grow = [&](double depth) {
    depths.min = std::min(depths.min, depth), depths.max = std::max(depths.max, depth);
  };
  if (!world.finite_bounds.empty()) {
    const Aabb box{world.finite_bounds.min - view.eye, world.finite_bounds.max - view.eye};
    grow(-farthest_along(box, -view.forward)), grow(farthest_along(box, view.forward));
  }
  const double most = depths.max > 0.0 ? depths.max + 4.0 * world.finite_bounds.diagonal() : infinity;
  for (const Shape& shape : world.shapes) {
    const auto* plane = std::get_if<Plane>(&shape.geometry);
    if (plane == nullptr) continue;
    for (const Vec2 place : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)}) {
      const double depth = glm::dot(plane->normal, plane->point - view.ray_origin(place)) /
                           glm::dot(plane->normal, view.forward);
      if (std::isfinite(depth)) grow(std::min(depth, most));
    }
  }
  if (!(depths.max > 0.0)) return {0.0, 1.0};
  const double room = 1e-3 * (depths.max - std::max(0.0, depths.min)) + 1e-6 * depths.max;
  return {std::max(0.0, depths.min - room), depths.max + room};
}

double near_distance(const World& world, const Vec3& eye) {
  double reach = world.finite_bounds.empty()
                     ? 0.0
                     : world.finite_bounds.diagonal() + glm::length(world.finite_bounds.center() - eye);
  for (const Shape& shape : world.shapes) {
    if (const auto* plane = std::get_if<Plane>(&shape.geometry))
      reach = std::max(reach, std::abs(glm::dot(plane->normal, plane->point - eye)));
  }
  return reach > 0.0 ? 1e-7 * reach : 1.0;
}

}  // namespace

View drawn_view(const World& world, const View& view) {
  View drawn = view;
  if (view.orthographic()) drawn.eye += orthographic_depths(world, view).min * view.forward;
  return drawn;
}

double depth_reach(const World& world, const View& drawn) {
  return drawn.orthographic() ? orthographic_depths(world, drawn).max : near_distance(world, drawn.eye);
}

}  // namespace gnomon::raster
