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
#include "scene/function_ref.h"

namespace gnomon::raytrace {

/// monostate: the default hierarchy or brute force, both in Structures::bvh.
using Structure = std::variant<std::monostate, MedianBvh, KdTree, Octree, UniformGrid, BspTree, TwoLevel>;

/// Whether `accel` lives in a Structure.
bool has_structure(Accel accel);
Structure build_structure(const World& world, Accel accel);

struct StructureSize {
  std::uint64_t nodes = 0, bytes = 0;  ///< without the primitives
};
StructureSize size_of(const Structure& structure);

/// What a traversal reports to: visit(place in leaf order); true ends it.
using LeafVisitor = FunctionRef<bool(std::uint32_t leaf)>;

/// traverse() of the one that it holds; given `work`, adds what is tested.
bool traverse_structure(const Structure& structure, BoxRay& ray, WorkCounts* work, const LeafVisitor& visit);

}  // namespace gnomon::raytrace
