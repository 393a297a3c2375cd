// One traversal through the hierarchy for every kind of ray. The slab test is ordered by the sign of 1/d,
// ignores NaN (0 * inf) and is widened by Ize 2013, "Robust BVH ray traversal", JCGT 2(2); the ray's origin
// enters as an interval that holds the exact one, so that boxes in float never cull what the tests in double
// would hit.
#pragma once

#include <bit>
#include <limits>

#include "raytrace/bvh/instance.h"
#include "raytrace/shapes/intersect.h"
#include "raytrace/tracer.h"

namespace gnomon::raytrace {

/// Instrumentation as a template policy: free when off.
struct NoStats {
  void boxes(int) {}
  void primitive() {}
  static WorkCounts* work() { return nullptr; }
};
struct CountWork {
  WorkCounts& counts;
  void boxes(int n) { counts.boxes += static_cast<std::uint64_t>(n); }
  void primitive() { ++counts.primitives; }
  WorkCounts* work() const { return &counts; }
};

/// The ray as the boxes see it.
struct BoxRay {
  std::array<float, 3> near_origin, far_origin, inverse;
  std::array<std::size_t, 3> near_plane, far_plane;  ///< rows of BvhNode::bounds
  float t_min, t_max;
  const RayFrame* frame;  ///< what it was made from, for structures that see the ray from elsewhere
  Vec3 origin_error;

  /// `ray` must outlive it. center: Bvh::center. error: how far the true origin may lie from the frame's,
  /// per axis (0 for a ray that is what it says).
  BoxRay(const RayFrame& ray, const Vec3& center, const Vec3& error = Vec3(0.0))
      : t_min(float_below(ray.t.min)), t_max(float_above(ray.t.max)), frame(&ray), origin_error(error) {
    for (std::size_t a = 0; a < 3; ++a) {
      const double o = ray.origin[a] - center[static_cast<int>(a)], e = origin_error[static_cast<int>(a)];
      const float below = float_below(o - e), above = float_above(o + e);
      inverse[a] = static_cast<float>(1.0 / ray.direction[a]);
      const bool backwards = std::signbit(inverse[a]);
      near_origin[a] = backwards ? below : above;
      far_origin[a] = backwards ? above : below;
      near_plane[a] = backwards ? 3 + a : a;
      far_plane[a] = backwards ? a : 3 + a;
    }
  }
};

/// Share of itself by which a ray's parameter at the wall of a box or cell is moved outwards: >= 2 gamma(3) of
/// float and the rounding of 1/d.
inline constexpr float wall_slack = 4.0f * FLT_EPSILON;

/// Bit i: child i's box may be intersected; t_near[i] is then a lower bound of where.
inline int intersect_boxes(const BvhNode& node, const BoxRay& ray, float t_max, float* t_near) {
  Float4 near = Float4::all(ray.t_min), far = Float4::all(t_max);
  for (std::size_t a = 0; a < 3; ++a) {
    const Float4 inverse = Float4::all(ray.inverse[a]);
    near = max_keep(
        (Float4::load(node.bounds[ray.near_plane[a]]) - Float4::all(ray.near_origin[a])) * inverse, near);
    far = min_keep((Float4::load(node.bounds[ray.far_plane[a]]) - Float4::all(ray.far_origin[a])) * inverse,
                   far);
  }
  // An infinite bound on the wrong side becomes NaN here and fails the comparison, as it must.
  near = near - magnitude(near) * Float4::all(wall_slack);
  far = far + magnitude(far) * Float4::all(wall_slack);
  near.store(t_near);
  return less_equal_mask(near, far);
}

/// leaf(child) for every leaf of a tree, and every instance, whose boxes the ray may intersect before t_max, nearest
/// boxes first; true ends the traversal. `space`: NodesThere or NodesPlaced. `root`: the node to begin with.
template <class Space, class Stats, class Leaf>
bool traverse_tree(const Bvh& tree, const Space& space, BoxRay& ray, Stats& stats, const Leaf& leaf,
                   std::uint32_t root = 0) {
  struct Entry {
    BvhChild child;
    float t_near;
  };
  BvhNode scratch;
  std::array<Entry, Bvh::stack_size> stack;
  std::size_t size = 0;
  stack[size++] = {BvhChild::node(root), -std::numeric_limits<float>::infinity()};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.t_near > ray.t_max) continue;
    if (entry.child.is_leaf()) {
      if (leaf(entry.child)) return true;
      continue;
    }
    const BvhNode& node = space.at(tree.nodes[entry.child.index()], scratch);
    alignas(16) std::array<float, 4> t_near;
    stats.boxes(4);
    const std::size_t base = size;
    for (auto mask = static_cast<unsigned>(intersect_boxes(node, ray, ray.t_max, t_near.data())); mask != 0;
         mask &= mask - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(mask));
      // Farthest at the bottom; insertion keeps the order of equal ones.
      std::size_t at = size++;
      for (; at > base && stack[at - 1].t_near < t_near[i]; --at) stack[at] = stack[at - 1];
      stack[at] = {node.child[i], t_near[i]};
    }
  }
  return false;
}

/// Calls visit(position in leaf order) for every primitive whose boxes the ray may intersect before t_max,
/// nearest boxes first; visit may lower ray.t_max and returns true to end the traversal. Returns whether it
/// was ended.
template <class Stats, class Visit>
bool traverse(const Bvh& bvh, BoxRay& ray, Stats& stats, const Visit& visit) {
  const auto visit_run = [&](const LeafRange& run) {
    for (std::uint32_t i = run.first; i < run.first + run.count; ++i) {
      stats.primitive();
      if (visit(i)) return true;
    }
    return false;
  };
  if (bvh.nodes.empty()) return visit_run({0, static_cast<std::uint32_t>(bvh.ids.size())});
  return traverse_tree(bvh, NodesThere{}, ray, stats, [&](BvhChild child) {
    if (!child.is_instance()) [[likely]]
      return visit_run({child.first(), child.count()});
    const BvhInstance& instance = bvh.instances[child.instance()];
    const NodesPlaced placed{instance};
    return traverse_tree(bvh.trees[instance.tree], placed, ray, stats, [&](BvhChild inner) {
      return visit_run(placed.leaves({inner.first(), inner.count()}));
    });
  });
}

}  // namespace gnomon::raytrace
