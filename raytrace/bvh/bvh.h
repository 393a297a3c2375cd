// Bounding-volume hierarchy over finite primitives. It is a binary tree by the surface-area heuristic (Wald
// 2007, "On fast construction of SAH-based bounding volume hierarchies"), collapsed into nodes of four
// children (Wald et al. 2008). Its upper part splits runs of neighbours (raytrace/bvh/clusters.h). Boxes are
// floats rounded outwards, primitives stay in double. The tree is the same for any number of threads; only
// the numbers of its nodes may differ.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "raytrace/bvh/leaf_primitives.h"
#include "raytrace/huge_array.h"
#include "raytrace/precision/error_bounds.h"
#include "scene/world.h"

namespace gnomon::raytrace {

/// A reference to a child: an inner node's index, a range of leaf primitives, or a kept instance's tree.
struct BvhChild {
  std::uint32_t bits;
  static constexpr std::uint32_t leaf_flag = 0x80000000u, first_mask = 0x07ffffffu;
  static constexpr std::uint32_t max_leaf = 15;  ///< four bits of count, 27 bits of first
  static BvhChild empty() { return {leaf_flag}; }
  static BvhChild node(std::uint32_t index) { return {index}; }
  static BvhChild leaf(std::uint32_t first, std::uint32_t count) {
    return {leaf_flag | (count << 27) | first};
  }
  /// To whom does not look for it: a leaf that holds nothing.
  static BvhChild instance(std::uint32_t index) { return {leaf_flag | (index + 1)}; }
  bool is_leaf() const { return (bits & leaf_flag) != 0; }
  bool is_instance() const { return bits > leaf_flag && bits <= (leaf_flag | first_mask); }
  std::uint32_t instance() const { return first() - 1; }
  std::uint32_t index() const { return bits; }
  std::uint32_t first() const { return bits & first_mask; }
  std::uint32_t count() const { return (bits >> 27) & max_leaf; }
};

/// bounds[axis] holds the four minima, bounds[3 + axis] the four maxima.
struct alignas(16) BvhNode {
  float bounds[6][4];
  BvhChild child[4];
};

/// Leaf primitives one after another.
struct LeafRange {
  std::uint32_t first, count;
};

/// A kept instance (scene/world.h). The boxes of its mesh's tree are brought into the world as they are reached
/// (raytrace/bvh/instance.h), rounded outwards; so are its leaves' corners, to the world's own bits.
struct BvhInstance {
  std::uint32_t tree;            ///< in Bvh::trees
  std::uint32_t first_leaf;      ///< what the tree's first leaf primitive is to who asks
  std::uint32_t first_triangle;  ///< of the world
  Mat4 world_from_object;
  std::array<std::array<float, 3>, 3> matrix;          ///< matrix[row][column], world from object
  std::array<std::array<std::uint8_t, 3>, 3> low_row;  ///< of BvhNode::bounds: what makes the row's sum least
  std::array<float, 3> low_offset, high_offset;  ///< of the tree's centre from Bvh::center, and a margin
};

struct Bvh {
  HugeVector<BvhNode> nodes;      ///< node 0 is the root; empty: traverse all primitives
  HugeVector<LeafRange> below;    ///< of each node: what all its leaves hold
  LeafPrimitives primitives;      ///< in leaf order; none where they are read from the world
  HugeVector<std::uint32_t> ids;  ///< of the primitives, in leaf order
  std::uint64_t dropped = 0;      ///< primitives left out: not finite, zero area or zero radius
  Vec3 center{0.0};  ///< the boxes count from here, so that scenes far from the origin keep their precision
  std::vector<Bvh> trees;  ///< of kept instances' meshes, in object space; ids: the mesh's own triangles
  std::vector<BvhInstance> instances;
  Ranges instance_leaves;  ///< of the instances, counted from the last of `ids`
  /// The tree's depth is limited so that a stack of this size always suffices: three per level and one. Of the
  /// levels some are kept for the nodes above instances.
  static constexpr int max_depth = 88, stack_size = 3 * max_depth + 1;

  /// Leaf primitives: those in `ids`, then each instance's.
  std::uint32_t leaf_count() const { return static_cast<std::uint32_t>(ids.size()) + instance_leaves.size(); }
  /// Whether the primitives are here; else they are read from the world.
  bool has_primitives() const { return !primitives.empty() || !instances.empty(); }
  /// A leaf primitive's id.
  std::uint32_t id_at(std::uint32_t leaf) const {
    if (leaf < ids.size()) [[likely]]
      return ids[leaf];
    return placed_id(leaf);
  }
  /// A leaf primitive itself. Requires `primitives`.
  LeafPrimitive primitive_at(std::uint32_t leaf) const {
    if (leaf < ids.size()) [[likely]]
      return primitives[leaf];
    return placed_primitive(leaf);
  }
  /// Its corners, which are in `scratch` where it is an instance's.
  CornerPointers corners_at(std::uint32_t leaf, PlacedCorners& scratch) const {
    if (leaf < ids.size()) [[likely]]
      return primitives.corners(leaf);
    return scratch.put(placed_primitive(leaf));
  }
  /// Returns the instance of a leaf that is one's.
  const BvhInstance& instance_of(std::uint32_t leaf) const {
    return instances[instance_leaves.of(leaf - static_cast<std::uint32_t>(ids.size()))];
  }
  LeafPrimitive placed_primitive(std::uint32_t leaf) const;
  std::uint32_t placed_id(std::uint32_t leaf) const;

  /// Asks memory for a primitive ahead of need; not for an instance's.
  void prefetch(std::size_t leaf) const {
    if (leaf >= primitives.size()) return;
    for (const double* corner : primitives.corners(leaf)) __builtin_prefetch(corner);
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
/// Without the triangles of kept instances.
FinitePrimitives flattened_primitives(const World& world);
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
