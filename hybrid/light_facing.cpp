#include "hybrid/light_facing.h"

#include "raytrace/precision/error_bounds.h"
#include "scene/base/parallel.h"

namespace gnomon::hybrid {
namespace {

using raytrace::error_gamma;
using raytrace::max_component;
using raytrace::Topology;

constexpr std::size_t grain = 2048;  // triangles per task
constexpr double product_gamma = error_gamma(16);

double sum_of_magnitudes(const Vec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

/// The sign of the triangle's plane at the light, as raytrace/sheets/column.h has it, in the world's axes.
std::int8_t facing_of(const std::array<Vec3, 3>& corners, const LightView& view, const WorldBounds& bounds) {
  const bool perspective = view.projection == LightProjection::perspective;
  const Vec3 q = corners[0] - view.origin;
  const Vec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
  const Vec3 n = glm::cross(e1, e2);
  const Vec3 ray = perspective ? q : view.faces[0].forward;
  const double error = 3.0 * bounds.position_error;
  const double s1 = max_component(glm::abs(e1)), s2 = max_component(glm::abs(e2));
  const double n_error = 2.0 * (error * (s1 + s2 + error) + product_gamma * s1 * s2);
  const double value = glm::dot(n, ray);
  const double bound = n_error * sum_of_magnitudes(ray) + (perspective ? error * sum_of_magnitudes(n) : 0.0) +
                       product_gamma * glm::dot(glm::abs(n), glm::abs(ray));
  if (!(std::abs(value) > bound) || !std::isfinite(value)) return 0;
  return value < 0.0 ? 1 : -1;
}

bool has_planes(const World& world) {
  for (std::uint32_t id = world.triangle_count(); id < world.primitive_count(); ++id)
    if (std::holds_alternative<Plane>(world.shape(id).geometry)) return true;
  return false;
}

}  // namespace

WorldBounds world_bounds(const World& world, const LightView& view) {
  const Aabb& box = world.finite_bounds;
  const double origin = max_component(glm::abs(view.origin));
  const double finite = box.empty() ? 0.0 : max_component(glm::max(glm::abs(box.min), glm::abs(box.max)));
  // Receivers on infinite planes lie farther away than anything finite, others within the bounds.
  const double beyond = has_planes(world) ? 16.0 : 1.0;
  const Interval depths = view.depth_range();
  const double reach = beyond * (finite + origin + (box.empty() ? depths.max - depths.min : box.diagonal()));
  return {reach, error_gamma(32) * 3.0 * (reach + origin)};
}

std::vector<TriangleFacing> find_facing(const World& world, const Topology& topology, const LightView& view,
                                        const WorldBounds& bounds) {
  std::vector<TriangleFacing> out(world.triangle_count());
  parallel_for(world.triangle_count(), grain,
               [&](std::uint32_t t) { out[t].facing = facing_of(world.corners(t), view, bounds); });
  parallel_for(world.triangle_count(), grain, [&](std::uint32_t t) {
    const bool masked = world.is_masked(t);
    unsigned bits = masked || out[t].facing == 0 ? TriangleFacing::whole : 0U;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t across = topology.across(t, k);
      const bool inner = across != Topology::boundary && across != Topology::non_manifold &&
                         out[t].facing != 0 && out[across].facing == out[t].facing;
      bits |= inner ? 0U : 1U << k;
    }
    out[t].boundary = static_cast<std::uint8_t>(bits);
  });
  return out;
}

}  // namespace gnomon::hybrid
