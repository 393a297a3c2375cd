// Common origins and directions made ready for packets: the eye's, and a light's for a block of receivers.
#pragma once

#include "raytrace/packets/edge_setup.h"
#include "raytrace/receiver_tiles.h"
#include "raytrace/tracer.h"
#include "scene/camera.h"

namespace gnomon::raytrace {

/// |u| and |v| of a point's rays stay below this: the bounds of raytrace/packets/edge_setup_kernel.cpp.
inline constexpr double widest_slope = 1.5;

/// Whether the eye's rays go by blocks (raytrace/packets/view_block.h): packets apply, all
/// rays start at one point, and one frame holds the whole field of view.
bool blocks_apply(const Tracer& tracer, const View& view);

/// The eye's frame, for such a view.
EdgeSetup edge_setup_of_eye(const Tracer& tracer, const View& view);

/// The light's frame for receivers within `bounds`, which are not empty: a point's looks at their middle. Rays
/// that it cannot hold are left to the double kernels.
EdgeSetup edge_setup_of_light(const Tracer& tracer, const Light& light, const Aabb& bounds);

/// A rectangle of (u, v) with room for rounding, beyond which nothing finite is seen. Infinite where not all that is
/// finite lies ahead.
struct PlaneLimits {
  double u_min, u_max, v_min, v_max;
  bool hold(double u, double v) const { return u >= u_min && u <= u_max && v >= v_min && v <= v_max; }
};
PlaneLimits limits_of(const Structures& structures, const EdgeSetup& setup);

/// A place's (u, v); false: it is not ahead.
bool project_point(const EdgeSetup& setup, const Vec3& position, double& u, double& v);

}  // namespace gnomon::raytrace
