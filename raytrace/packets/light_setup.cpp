#include "raytrace/packets/light_setup.h"

#include <algorithm>

namespace gnomon::raytrace {
namespace {

/// How wide the rays of a point may spread for one frame to hold them, with room for rounding.
constexpr double widest_frame = widest_slope - 0x1p-10;

struct Range {
  double low = infinity, high = -infinity;
  void grow(double v) { low = std::min(low, v), high = std::max(high, v); }
  /// With room for what rounding may have moved the ends.
  Range with_slack() const {
    const double slack = 0x1p-18 * std::max(std::abs(low), std::abs(high)) + 0x1p-12 * (high - low);
    return {low - slack, high + slack};
  }
};

}  // namespace

bool packets_apply(const Tracer& tracer) {
  const Structures& s = tracer.structures();
  const double size = s.world->finite_bounds.diagonal();
  const double far = max_component(glm::abs(s.bvh.center)) + size;
  return s.precision != Precision::fast && !s.bvh.nodes.empty() && size > 1e-9 && far < 1e9;
}

bool blocks_apply(const Tracer& tracer, const View& view) {
  return packets_apply(tracer) && !view.orthographic() && view.tan_half_x < widest_frame &&
         view.tan_half_y < widest_frame;
}

EdgeSetup edge_setup_of_eye(const Tracer& tracer, const View& view) {
  return edge_setup_from(tracer.structures(), view.eye, false, view.right, view.forward);
}

EdgeSetup edge_setup_of_light(const Tracer& tracer, const Light& light, const Aabb& bounds) {
  const Structures& s = tracer.structures();
  if (light.type == LightType::directional) return edge_setup_along(s, -light.direction);
  const Vec3 middle = bounds.center() - light.position;
  const double distance = glm::length(middle);
  const Vec3 depth = distance > 0.0 ? middle / distance : Vec3(0, 0, 1);
  Vec3 right, up;
  orthonormal_basis(depth, right, up);
  return edge_setup_from(s, light.position, true, right, depth);
}

bool project_point(const EdgeSetup& setup, const Vec3& position, double& u, double& v) {
  const Vec3 p = position - setup.origin;
  u = glm::dot(p, setup.axes[0]), v = glm::dot(p, setup.axes[1]);
  if (setup.directional) return true;
  const double depth = glm::dot(p, setup.axes[2]);
  u /= depth, v /= depth;
  return depth > 0.0;
}

PlaneLimits limits_of(const Structures& s, const EdgeSetup& setup) {
  const Aabb& box = s.world->finite_bounds;
  Range u, v;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3 p = box.min;
    for (int a = 0; a < 3; ++a)
      if ((corner >> a & 1) != 0) p[a] = box.max[a];
    double x = 0.0, y = 0.0;
    if (!project_point(setup, p, x, y)) return {-infinity, infinity, -infinity, infinity};
    u.grow(x), v.grow(y);
  }
  const Range wide_u = u.with_slack(), wide_v = v.with_slack();
  return {wide_u.low, wide_u.high, wide_v.low, wide_v.high};
}

}  // namespace gnomon::raytrace
