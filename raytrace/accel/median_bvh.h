// The textbook's bounding-volume hierarchy: a binary tree, cut at the median object along the longest axis of
// the box, with leaves of about five. Sources: Shirley, Ashikhmin and Marschner, "Fundamentals of computer
// graphics", section 12.3.2; Kay and Kajiya 1986. raytrace/bvh/bvh.h is the one to use; this one shows what
// the surface-area heuristic and the wide nodes are worth.
#pragma once

#include "raytrace/accel/crossing.h"

namespace gnomon::raytrace {

struct MedianNode {
  CellBox box;
  std::uint32_t first;  ///< leaf: into items; inner: the right child (the left one follows its parent)
  std::uint32_t count;  ///< of a leaf; 0: inner
};

struct MedianBvh {
  std::vector<MedianNode> nodes;  ///< node 0 is the root; empty: no primitives
  std::vector<std::uint32_t> items;
  static constexpr int max_depth = 34;  ///< the median halves 32-bit counts

  std::uint64_t bytes() const {
    return nodes.size() * sizeof(MedianNode) + items.size() * sizeof(std::uint32_t);
  }
};

MedianBvh build_median_bvh(const CellItems& items);

/// traverse() of raytrace/bvh/traverse.h; `visit` is given places in the order of CellItems.
template <class Stats, class Visit>
bool traverse(const MedianBvh& bvh, BoxRay& ray, Stats& stats, const Visit& visit) {
  if (bvh.nodes.empty()) return false;
  struct Entry {
    std::uint32_t node;
    float begin;
  };
  std::array<Entry, MedianBvh::max_depth + 2> stack;
  std::size_t size = 0;
  const auto push = [&](std::uint32_t node) {
    stats.boxes(1);
    const RaySpan span = clip(ray, bvh.nodes[node].box);
    if (!span.empty()) stack[size++] = {node, span.begin};
  };
  push(0);
  while (size > 0) {
    const Entry at = stack[--size];
    if (at.begin > ray.t_max) continue;
    const MedianNode& node = bvh.nodes[at.node];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      stats.primitive();
      if (visit(bvh.items[i])) return true;
    }
    if (node.count > 0) continue;
    const std::size_t base = size;
    push(node.first), push(at.node + 1);
    if (size == base + 2 && stack[base].begin < stack[base + 1].begin)
      std::swap(stack[base], stack[base + 1]);
  }
  return false;
}

}  // namespace gnomon::raytrace
