// Every structure but the default one (raytrace/bvh/bvh.h) and brute force, behind one function: traverse().
// A structure is plain data with a build function, and a traverse() that has the contract of
// raytrace/bvh/traverse.h: it reports every primitive that the ray may intersect before ray.t_max, near ones
// first as far as it can, some perhaps twice. Which structure it is, is decided once per ray and never
// inside.
#pragma once

#include <variant>

#include "raytrace/accel/bsp.h"
#include "raytrace/accel/grid.h"
#include "raytrace/accel/kdtree.h"
#include "raytrace/accel/median_bvh.h"
#include "raytrace/accel/octree.h"
#include "raytrace/accel/two_level.h"
#include "raytrace/tracer.h"

namespace gnomon::raytrace {

/// monostate: the default hierarchy or brute force, both in Structures::bvh.
using Structure = std::variant<std::monostate, MedianBvh, KdTree, Octree, UniformGrid, BspTree, TwoLevel>;

/// Whether `accel` lives in a Structure.
bool has_structure(Accel accel);
Structure build_structure(const World& world, Accel accel);

struct StructureSize {
  std::uint64_t nodes = 0, references = 0, bytes = 0;  ///< without the primitives
};
StructureSize size_of(const Structure& structure);

template <class Stats, class Visit>
[[gnu::noinline]] bool traverse_structure(const Structure& structure, BoxRay& ray, Stats& stats,
                                          const Visit& visit) {
  switch (structure.index()) {
    case 1:
      return traverse(*std::get_if<MedianBvh>(&structure), ray, stats, visit);
    case 2:
      return traverse(*std::get_if<KdTree>(&structure), ray, stats, visit);
    case 3:
      return traverse(*std::get_if<Octree>(&structure), ray, stats, visit);
    case 4:
      return traverse(*std::get_if<UniformGrid>(&structure), ray, stats, visit);
    case 5:
      return traverse(*std::get_if<BspTree>(&structure), ray, stats, visit);
    case 6:
      return traverse(*std::get_if<TwoLevel>(&structure), ray, stats, visit);
    default:
      return false;
  }
}

}  // namespace gnomon::raytrace
