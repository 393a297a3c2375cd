// A structure is plain data with a build function and a traverse(), which has the contract of raytrace/bvh/traverse.h.
// It reports every primitive that the ray may intersect before ray.t_max, near ones first as far as it can, some perhaps
// twice. Which structure it is, is decided once per ray and never inside.
#pragma once

#include <variant>

#include "raytrace/accel/bsp.h"
#include "raytrace/accel/grid.h"
#include "raytrace/accel/kdtree.h"
#include "raytrace/accel/median_bvh.h"
#include "raytrace/accel/octree.h"
#include "raytrace/accel/structure.h"
#include "raytrace/accel/two_level.h"

namespace gnomon::raytrace {

using AnyStructure = std::variant<std::monostate, MedianBvh, KdTree, Octree, UniformGrid, BspTree, TwoLevel>;

/// monostate: what is no structure (has_structure).
struct Structure : AnyStructure {
  using AnyStructure::AnyStructure;
};

}  // namespace gnomon::raytrace
