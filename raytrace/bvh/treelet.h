// The lower part of the hierarchy (raytrace/bvh/bvh.cpp): some hundreds of primitives that stay in the cache
// while they are split. They are split by bins as long as they are many and by sorting along each axis when
// they are few. Compiled once per instruction set; the tree is the same for all.
#pragma once

#include <atomic>
#include <optional>

#include "raytrace/bvh/bins.h"

namespace gnomon::raytrace::binned {

/// Nodes in the order in which they are asked for.
class NodeStore {
 public:
  /// Room for `most` nodes: pages that are not reached cost nothing.
  NodeStore(Bvh& bvh, std::size_t most) : bvh_(bvh) { bvh.nodes.resize(most), bvh.below.resize(most); }
  std::uint32_t take(std::uint32_t count) { return used_.fetch_add(count, std::memory_order_relaxed); }
  BvhNode& operator[](std::uint32_t index) { return bvh_.nodes[index]; }
  LeafRange& below(std::uint32_t index) { return bvh_.below[index]; }
  void finish() { bvh_.nodes.resize(used_), bvh_.below.resize(used_); }

 private:
  Bvh& bvh_;
  std::atomic<std::uint32_t> used_{0};
};

inline void set_child(BvhNode& node, std::size_t i, const Box& box, BvhChild child) {
  for (std::size_t a = 0; a < 3; ++a) node.bounds[a][i] = box.min[a], node.bounds[3 + a][i] = box.max[a];
  node.child[i] = child;
}

/// A node's children: the largest range that can be split is split until there are four. Returns how many
/// there are; split(range) gives its two parts, or nothing where it is to stay whole.
template <class R, class SplitRange>
std::size_t split_into_four(std::array<R, 4>& children, const SplitRange& split) {
  std::size_t count = 1;
  while (count < 4) {
    std::size_t largest = count;
    for (std::size_t i = 0; i < count; ++i)
      if (!children[i].is_whole &&
          (largest == count || children[i].bounds.box.half_area() > children[largest].bounds.box.half_area()))
        largest = i;
    if (largest == count) return count;
    if (const std::optional<std::array<R, 2>> parts = split(children[largest]))
      children[largest] = (*parts)[0], children[count++] = (*parts)[1];
    else
      children[largest].is_whole = true;
  }
  return count;
}

/// A thread's memory for treelets.
struct TreeletScratch {
  std::vector<Ref> refs, moved;
  std::vector<BvhNode> nodes;
  std::vector<LeafRange> below;  ///< of the nodes
};

/// Builds over scratch.refs and brings them into the order of the leaves; the first one is the tree's primitive
/// `first`. `depth`: binary splits above.
BvhChild build_treelet(TreeletScratch& scratch, std::uint32_t first, int depth, NodeStore& store);

}  // namespace gnomon::raytrace::binned
