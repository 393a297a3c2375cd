// Kd-tree: axis-parallel splits chosen by the surface-area heuristic (Wald and Havran 2006, "On building
// fast kd-trees for ray tracing, and on doing that in O(N log N)"; the O(N log^2 N) form, with bins for large
// nodes), or the textbook's: axes in turn, split at the median centroid. A primitive that straddles a split
// goes to both sides. Nodes of eight bytes as in PBR 3rd ed., section 4.4.1.
#pragma once

#include "raytrace/accel/crossing.h"

namespace gnomon::raytrace {

enum class KdSplit : std::uint8_t { surface_area, cyclic_median };

struct KdNode {
  float split;         ///< inner: the wall
  std::uint32_t bits;  ///< two low bits: the axis, or 3 for a leaf; the rest: the right child, or the count
  bool is_leaf() const { return (bits & 3u) == 3u; }
  std::size_t axis() const { return bits & 3u; }
  std::uint32_t right() const { return bits >> 2; }  ///< the left child follows its parent
  std::uint32_t count() const { return bits >> 2; }
  std::uint32_t first() const { return std::bit_cast<std::uint32_t>(split); }  ///< leaf: into items
};

struct KdTree {
  CellBox bounds;
  std::vector<KdNode> nodes;  ///< node 0 is the root; empty: no primitives
  std::vector<std::uint32_t> items;
  static constexpr int max_depth = 64;

  std::uint64_t bytes() const { return nodes.size() * sizeof(KdNode) + items.size() * sizeof(std::uint32_t); }
};

KdTree build_kdtree(const CellItems& items, KdSplit rule = KdSplit::surface_area);

/// traverse() of raytrace/bvh/traverse.h; `visit` is given places in the order of CellItems.
template <class Stats, class Visit>
bool traverse(const KdTree& tree, BoxRay& ray, Stats& stats, const Visit& visit) {
  if (tree.nodes.empty()) return false;
  struct Entry {
    std::uint32_t node;
    RaySpan span;
  };
  std::array<Entry, KdTree::max_depth + 1> stack;
  std::size_t size = 0;
  Mailbox mailbox;
  Entry at{0, clip(ray, tree.bounds)};
  if (at.span.empty()) return false;
  for (;;) {
    const KdNode node = tree.nodes[at.node];
    if (node.is_leaf()) {
      if (visit_cell(std::span(tree.items).subspan(node.first(), node.count()), mailbox, stats, visit))
        return true;
      do {
        if (size == 0) return false;
        at = stack[--size];
      } while (at.span.begin > ray.t_max);
      continue;
    }
    stats.boxes(1);
    const float enter_far = entry_bound(ray, node.axis(), node.split);
    const float leave_near = exit_bound(ray, node.axis(), node.split);
    const bool backwards = goes_backwards(ray, node.axis());
    const std::uint32_t near = backwards ? node.right() : at.node + 1;
    const std::uint32_t far = backwards ? at.node + 1 : node.right();
    if (at.span.begin > leave_near) {
      at = {far, {std::max(at.span.begin, enter_far), at.span.end}};
    } else {
      if (enter_far <= at.span.end) stack[size++] = {far, {std::max(at.span.begin, enter_far), at.span.end}};
      at = {near, {at.span.begin, std::min(at.span.end, leave_near)}};
    }
  }
}

}  // namespace gnomon::raytrace
