// Two levels, for scenes that show the same mesh many times. Each distinct mesh has one tree, in the mesh's
// own space and shared by all its instances. Above these is one tree over the instances' boxes in the world.
// Sources: Rubin and Whitted 1980, "A 3-dimensional representation for fast rendering of complex scenes";
// Wald, Benthin and Slusallek 2003, "Distributed interactive ray tracing of dynamic scenes". The ray goes
// into the mesh's space, with a bound on that step's rounding (raytrace/accel/placement.h), only to choose
// boxes; what it intersects is decided among the world's triangles, as everywhere. They are read from the
// world, so that no triangle is stored a second time.
//
// A mesh that stands alone, is small, or stands where it cannot be inverted (flattened) has a tree of its own
// in the world's space. Shapes are single entries of the upper tree.
#pragma once

#include "raytrace/accel/crossing.h"
#include "raytrace/accel/placement.h"

namespace gnomon::raytrace {

struct TwoLevel {
  /// What a leaf of the upper tree holds.
  struct Entry {
    CellBox box;              ///< in the world, relative to Bvh::center
    std::uint32_t tree;       ///< no_id: a single primitive
    std::uint32_t placement;  ///< no_id: the tree is in the world's space too
    std::uint32_t first;      ///< the tree's leaves are leaves.ids[first] ...
  };
  Bvh upper;                   ///< nodes alone
  std::vector<Entry> entries;  ///< in the order of the upper tree's leaves
  std::vector<Bvh> trees;      ///< nodes alone
  std::vector<Placement> placements;
  /// Ids without copies of the primitives, each tree's in the order of its leaves. Structures takes them.
  Bvh leaves;

  std::uint64_t nodes() const;
  std::uint64_t bytes() const;  ///< without the leaves' ids
};

TwoLevel build_two_level(const World& world);

/// Entries of the upper tree are no primitives.
template <class Stats>
struct BoxStats {
  Stats& stats;
  void boxes(int n) { stats.boxes(n); }
  void primitive() {}
};

template <class Stats, class Visit>
bool traverse_placed(const Bvh& tree, const Placement& placement, BoxRay& ray, double begin, Stats& stats,
                     const Visit& visit) {
  const PlacedRay placed(placement, ray, std::isfinite(begin) ? begin : 0.0);
  BoxRay inner(placed.frame, Vec3(0.0), placed.origin_error);
  return traverse(tree, inner, stats, [&](std::uint32_t leaf) {
    const float before = ray.t_max;
    const bool ends = visit(leaf);
    if (ray.t_max != before) inner.t_max = float_above(placed.parameter(ray.t_max));
    return ends;
  });
}

/// traverse() of raytrace/bvh/traverse.h; `visit` is given places in `leaves`.
template <class Stats, class Visit>
bool traverse(const TwoLevel& two, BoxRay& ray, Stats& stats, const Visit& visit) {
  if (two.entries.empty()) return false;
  BoxStats<Stats> upper_stats{stats};
  return traverse(two.upper, ray, upper_stats, [&](std::uint32_t at) {
    const TwoLevel::Entry& entry = two.entries[at];
    const auto visit_leaf = [&](std::uint32_t leaf) { return visit(entry.first + leaf); };
    if (entry.tree == no_id) {
      stats.primitive();
      return visit_leaf(0);
    }
    stats.boxes(1);
    const RaySpan span = clip(ray, entry.box);
    if (span.empty()) return false;
    const Bvh& tree = two.trees[entry.tree];
    if (entry.placement == no_id) return traverse(tree, ray, stats, visit_leaf);
    return traverse_placed(tree, two.placements[entry.placement], ray, static_cast<double>(span.begin), stats,
                           visit_leaf);
  });
}

}  // namespace gnomon::raytrace
