// Bounding-volume hierarchy over finite primitives: a binary tree by the surface-area heuristic (Wald 2007,
// "On fast construction of SAH-based bounding volume hierarchies"), collapsed into nodes of four children
// (Wald et al. 2008); its upper part splits runs of neighbours (raytrace/bvh/clusters.h). Boxes are floats
// rounded outwards, primitives stay in double. The tree is the same for any number of threads; only the
// numbers of its nodes may differ.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "raytrace/error_bounds.h"
#include "raytrace/huge_array.h"
#include "scene/world.h"

namespace gnomon::raytrace {

/// A reference to a child: an inner node's index, or a range of leaf primitives.
struct BvhChild {
  std::uint32_t bits;
  static constexpr std::uint32_t leaf_flag = 0x80000000u, first_mask = 0x07ffffffu;
  static constexpr std::uint32_t max_leaf = 15;  ///< four bits of count, 27 bits of first
  static BvhChild empty() { return {leaf_flag}; }
  static BvhChild node(std::uint32_t index) { return {index}; }
  static BvhChild leaf(std::uint32_t first, std::uint32_t count) {
    return {leaf_flag | (count << 27) | first};
  }
  bool is_leaf() const { return (bits & leaf_flag) != 0; }
  std::uint32_t index() const { return bits; }
  std::uint32_t first() const { return bits & first_mask; }
  std::uint32_t count() const { return (bits >> 27) & max_leaf; }
};

/// bounds[axis] holds the four minima, bounds[3 + axis] the four maxima.
struct alignas(16) BvhNode {
  float bounds[6][4];
  BvhChild child[4];
};

/// A triangle's corners (x0 y0 z0 x1 ... z2), or a sphere's centre and radius in the first four; nothing
/// for a solid (scene/solid.h), which is looked up by its id.
struct LeafPrimitive {
  std::array<double, 9> v;
};

/// Leaf primitives one after another.
struct LeafRange {
  std::uint32_t first, count;
};

struct Bvh {
  HugeVector<BvhNode> nodes;             ///< node 0 is the root; empty: traverse all primitives
  HugeVector<LeafRange> below;           ///< of each node: what all its leaves hold
  HugeVector<LeafPrimitive> primitives;  ///< in leaf order; none where they are read from the world
  HugeVector<std::uint32_t> ids;         ///< of the primitives, in leaf order
  std::uint64_t dropped = 0;             ///< primitives left out: not finite, zero area or zero radius
  Vec3 center{0.0};  ///< the boxes count from here, so that scenes far from the origin keep their precision
  /// The tree's depth is limited so that a stack of this size always suffices: three per level and one.
  static constexpr int max_depth = 80, stack_size = 3 * max_depth + 1;

  /// Asks memory for a primitive ahead of need.
  void prefetch(std::size_t leaf) const {
    const char* bytes = reinterpret_cast<const char*>(&primitives[leaf]);
    __builtin_prefetch(bytes), __builtin_prefetch(bytes + sizeof(LeafPrimitive) - 1);
    __builtin_prefetch(&ids[leaf]);
  }
};

/// A primitive's box relative to the centre, rounded outwards.
struct BoxRef {
  std::array<float, 3> min, max;
  std::uint32_t id;
};

/// The finite, non-degenerate triangles, spheres and solids of a world, in ascending order of ids.
struct FinitePrimitives {
  HugeVector<BoxRef> boxes;
  Vec3 center{0.0};  ///< of the world's finite bounds
  std::uint64_t dropped = 0;
};
FinitePrimitives finite_primitives(const World& world);
/// A sphere's or solid's box as it is there.
BoxRef shape_box(const World& world, std::uint32_t id, const Vec3& center);

Bvh build_bvh(const World& world);
/// Over boxes alone: no primitives, and for ids what the boxes have as theirs, in leaf order.
Bvh build_bvh(std::span<const BoxRef> boxes);
/// A primitive as leaves keep it.
LeafPrimitive leaf_primitive(const World& world, std::uint32_t id);
/// No tree: every primitive is tested, in ascending order of ids.
Bvh build_flat(const World& world);

}  // namespace gnomon::raytrace
