// Kept instances in the hierarchy. Each mesh has one tree, in the mesh's own space, below a tree over the instances
// (Rubin and Whitted 1980, "A 3-dimensional representation for fast rendering of complex scenes"). Rays, packets and
// shafts stay in the world's space; the tree's boxes come to them, each as the box around it in the world. So
// whatever traverses the hierarchy has one more kind of node to know, and no bound of its own to find.
#pragma once

#include "raytrace/bvh/bvh.h"
#include "raytrace/bvh/float4.h"

namespace gnomon::raytrace {

/// A node of the instance's tree, its boxes in the world.
inline void place_node(const BvhNode& node, const BvhInstance& at, BvhNode& out) {
  for (std::size_t r = 0; r < 3; ++r) {
    Float4 low = Float4::all(at.low_offset[r]), high = Float4::all(at.high_offset[r]);
    for (std::size_t c = 0; c < 3; ++c) {
      const Float4 m = Float4::all(at.matrix[r][c]);
      low = low + m * Float4::load(node.bounds[at.low_row[r][c]]);
      high = high + m * Float4::load(node.bounds[(at.low_row[r][c] + 3) % 6]);
    }
    low.store(out.bounds[r]), high.store(out.bounds[3 + r]);
  }
  std::copy_n(node.child, 4, out.child);
}

/// The nodes of a tree that is in the world's space.
struct NodesThere {
  static const BvhNode& at(const BvhNode& node, BvhNode&) { return node; }
  static LeafRange leaves(const LeafRange& range) { return range; }
};
/// Holds the nodes of an instance's tree, placed.
struct NodesPlaced {
  const BvhInstance& instance;
  const BvhNode& at(const BvhNode& node, BvhNode& scratch) const {
    place_node(node, instance, scratch);
    return scratch;
  }
  LeafRange leaves(const LeafRange& range) const { return {range.first + instance.first_leaf, range.count}; }
};

/// Appends the world's kept instances to a hierarchy of all that is flattened.
void add_instances(const World& world, Bvh& bvh);

}  // namespace gnomon::raytrace
