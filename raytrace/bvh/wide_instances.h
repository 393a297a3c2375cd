// Kept instances in the wide tree. Each mesh has a wide tree in its own space. A ray comes to it by the inverse of the
// instance's matrix (Rubin and Whitted 1980). The nodes above them are the wide tree's own.
//
// Notation as in raytrace/bvh/wide_ray.h; M is the instance's matrix, N its inverse in double, T its translation. A ray N
// (o - T) + t N d is off by something, and so are the triangles, whose corners were rounded in the world. Both are as if
// the ray's origin were off. With k = |M| |N|, that is by no more than
//   |N| (e' + 2^-46 (|o| + |T| + |M| (|c| + r))) + 2^-40 k r
// for every hit. Here e' is what the given origin is off by, c the mesh's centre, and t |d| of N d at most 2^8 (q + r).
// The first term's 2^-46 holds all of the doubles' own roundings in the world. The last term holds the inverse's, of
// less than 2^-50 k. Where that is at most 2^-35 r it is part of the 2^-34 r that the bounds have to spare. Other rays
// meet the instance by its plain boxes.
//
// A ray whose origin is too far from the mesh for floats starts at t0 instead. There it is 16 r before the plane through c
// across the direction's largest component. Every hit is later by at least 15 r along that axis. So t counted from t0 is
// positive, and as right as t, to 2^-40 of itself. The point at t0 is as right as a hit. Its roundings, of less than 2^-50
// |N| (|o| + |T| + |M| (|c| + r)), are part of the first term. Where bounds of t and of t - t0 are made of each other, they
// give way by 2^-20 of t upwards and 2^-21 downwards. That is more than the floats' roundings.
#pragma once

#include "raytrace/bvh/wide_traverse.h"

namespace gnomon::raytrace {

/// Fills the tree's instances from its origin's, if that has any.
void add_wide_instances(const World& world, WideTree& tree);

/// How far off a ray's origin, which is given to within `origin_error`, may be for the doubles of the world, in the maximum
/// norm: e' + 2^-46 |o|.
double error_in_world(const Vec3& origin, double origin_error);

/// Parts of a mesh's `reach` by which a ray's origin may be off in its space. Bounds of boxes and triangles have the first
/// to spare, those of a shaft's boxes (raytrace/bvh/wide_shaft.h) the second.
constexpr double ray_to_spare = 0x1p-35, shaft_to_spare = 0x1p-22;

/// Whether floats suffice for a ray of such an error.
inline bool has_bounds(const WideInstance& instance, double error, double to_spare = ray_to_spare) {
  return instance.mesh != nullptr && instance.inverse_norm * error + instance.error <=
                                         to_spare * static_cast<double>(instance.mesh->reach);
}

/// All leaves of an instance whose plain boxes the ray may intersect before `limited` ends; visit(leaf) returns true to
/// end, and may limit. Returns whether it was ended.
bool visit_plainly(const WideTree& tree, std::uint32_t instance, const Ray& ray,
                   const TraversalLimits& limits, WideRay& limited,
                   FunctionRef<bool(std::uint32_t leaf)> visit, WorkCounts* work);

}  // namespace gnomon::raytrace
