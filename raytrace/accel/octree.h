// Octree: a cell is cut in half along all three axes at once until it holds few primitives (Glassner 1984,
// "Space subdivision for fast ray tracing"). A primitive goes to every child that it may reach into. The
// traversal takes the children in the order in which the ray enters them; children that the ray enters at the
// same time, through their common edge or corner, are all visited.
#pragma once

#include "raytrace/accel/crossing.h"

namespace gnomon::raytrace {

struct OctreeNode {
  std::array<float, 3> middle;  ///< inner: where the cell is cut
  std::uint32_t first;          ///< inner: the first of eight children, x fastest; leaf: into items
  std::uint32_t count;          ///< leaf: of items
  static constexpr std::uint32_t inner = 0xffffffffu;
  bool is_leaf() const { return count != inner; }
};

struct Octree {
  CellBox bounds;
  std::vector<OctreeNode> nodes;  ///< node 0 is the root; empty: no primitives
  std::vector<std::uint32_t> items;
  static constexpr int max_depth = 20;

  std::uint64_t bytes() const {
    return nodes.size() * sizeof(OctreeNode) + items.size() * sizeof(std::uint32_t);
  }
};

Octree build_octree(const CellItems& items);

/// traverse() of raytrace/bvh/traverse.h; `visit` is given places in the order of CellItems.
template <class Stats, class Visit>
bool traverse(const Octree& tree, BoxRay& ray, Stats& stats, const Visit& visit) {
  if (tree.nodes.empty()) return false;
  struct Entry {
    std::uint32_t node;
    RaySpan span;
  };
  std::array<Entry, 7 * Octree::max_depth + 8> stack;
  std::size_t size = 0;
  Mailbox mailbox;
  stack[size++] = {0, clip(ray, tree.bounds)};
  if (stack[0].span.empty()) return false;
  std::uint32_t backwards = 0;
  for (std::size_t a = 0; a < 3; ++a) backwards |= goes_backwards(ray, a) ? 1u << a : 0u;
  while (size > 0) {
    const Entry at = stack[--size];
    if (at.span.begin > ray.t_max) continue;
    const OctreeNode& node = tree.nodes[at.node];
    if (node.is_leaf()) {
      if (visit_cell(std::span(tree.items).subspan(node.first, node.count), mailbox, stats, visit))
        return true;
      continue;
    }
    std::array<float, 3> enter_far, leave_near;
    for (std::size_t a = 0; a < 3; ++a) {
      enter_far[a] = entry_bound(ray, a, node.middle[a]);
      leave_near[a] = exit_bound(ray, a, node.middle[a]);
    }
    stats.boxes(8);
    const std::size_t base = size;
    for (std::uint32_t far = 0; far < 8; ++far) {  // bit a: the far half along axis a
      RaySpan span = at.span;
      for (std::size_t a = 0; a < 3; ++a) {
        if ((far >> a & 1u) != 0)
          span.begin = std::max(span.begin, enter_far[a]);
        else
          span.end = std::min(span.end, leave_near[a]);
      }
      if (span.empty()) continue;
      const OctreeNode& child = tree.nodes[node.first + (far ^ backwards)];
      if (child.count == 0) continue;
      // Farthest at the bottom; insertion keeps the order of equal ones.
      std::size_t place = size++;
      for (; place > base && stack[place - 1].span.begin < span.begin; --place)
        stack[place] = stack[place - 1];
      stack[place] = {node.first + (far ^ backwards), span};
    }
  }
  return false;
}

}  // namespace gnomon::raytrace
