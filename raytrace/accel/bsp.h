// BSP tree with arbitrary planes (Fuchs, Kedem and Naylor 1980). For rays it is built by the surface-area
// heuristic over true polyhedral cells (Ize, Wald and Parker 2008, "Ray tracing with the BSP tree"). Planes
// tried: those of the triangles, those through their edges at right angles to them, and axis-parallel ones. A
// primitive that straddles a plane goes to both sides; one that lies in the plane goes below. Whoever comes
// as near to the plane as rounding can tell looks on both sides.
#pragma once

#include "raytrace/accel/crossing.h"

namespace gnomon::raytrace {

struct BspNode {
  std::array<double, 3> normal;        ///< unit
  double offset;                       ///< below: normal . p <= offset
  std::array<std::uint32_t, 2> child;  ///< below, above: a node, or leaf_flag | a leaf
  static constexpr std::uint32_t leaf_flag = 0x80000000u;
};

struct BspLeaf {
  std::uint32_t first, count;  ///< into items
};

struct BspTree {
  CellBox bounds;
  std::vector<BspNode> nodes;
  std::vector<BspLeaf> leaves;  ///< empty: no primitives
  std::vector<std::uint32_t> items;
  std::uint32_t root = BspNode::leaf_flag;
  double plane_slack = 0.0;  ///< how far rounding may move a corner against a plane
  static constexpr int max_depth = 64;

  std::uint64_t bytes() const {
    return nodes.size() * sizeof(BspNode) + leaves.size() * sizeof(BspLeaf) +
           items.size() * sizeof(std::uint32_t);
  }
};

BspTree build_bsp(const CellItems& items);

/// The ray as planes see it. The errors of its origin and its direction are put together. They make how far
/// any of its points up to `reach` may be from where it seems to be, per axis.
struct PlaneRay {
  std::array<double, 3> origin, direction, error;
  PlaneRay(const BoxRay& ray, double reach) {
    constexpr double direction_slack = 2.0 * FLT_EPSILON;  // of BoxRay::inverse, a rounded float
    for (std::size_t a = 0; a < 3; ++a) {
      const double near = ray.near_origin[a], far = ray.far_origin[a];
      origin[a] = 0.5 * (near + far);
      direction[a] = 1.0 / static_cast<double>(ray.inverse[a]);
      error[a] = std::abs(near - far) + reach * (std::abs(direction[a]) * direction_slack + FLT_MIN);
    }
  }
};

/// When the ray may come to the far side of a plane, when it has surely left the near side, and which is
/// near.
struct PlaneCrossing {
  double enter_far, leave_near;
  std::size_t near;
};

inline PlaneCrossing cross(const BspNode& node, const PlaneRay& ray, double slack) {
  double height = -node.offset, slope = 0.0, error = slack;
  for (std::size_t a = 0; a < 3; ++a) {
    height += node.normal[a] * ray.origin[a];
    slope += node.normal[a] * ray.direction[a];
    error += std::abs(node.normal[a]) * ray.error[a];
  }
  const std::size_t near = slope < 0.0 ? 1 : 0;
  if (slope < 0.0) height = -height, slope = -slope;
  if (slope > 0.0) return {(-height - error) / slope, (-height + error) / slope, near};
  return {height + error >= 0.0 ? -infinity : infinity, height - error <= 0.0 ? infinity : -infinity, near};
}

/// traverse() of raytrace/bvh/traverse.h; `visit` is given places in the order of CellItems.
template <class Stats, class Visit>
bool traverse(const BspTree& tree, BoxRay& ray, Stats& stats, const Visit& visit) {
  if (tree.leaves.empty()) return false;
  const RaySpan span = clip(ray, tree.bounds);
  if (span.empty()) return false;
  struct Entry {
    std::uint32_t node;
    double begin, end;
  };
  std::array<Entry, BspTree::max_depth + 1> stack;
  std::size_t size = 0;
  Mailbox mailbox;
  const PlaneRay line(
      ray, std::max(std::abs(static_cast<double>(span.begin)), std::abs(static_cast<double>(span.end))));
  Entry at{tree.root, span.begin, span.end};
  for (;;) {
    if ((at.node & BspNode::leaf_flag) != 0) {
      const BspLeaf& leaf = tree.leaves[at.node & ~BspNode::leaf_flag];
      if (visit_cell(std::span(tree.items).subspan(leaf.first, leaf.count), mailbox, stats, visit))
        return true;
      do {
        if (size == 0) return false;
        at = stack[--size];
      } while (at.begin > ray.t_max);
      continue;
    }
    stats.boxes(1);
    const BspNode& node = tree.nodes[at.node];
    const PlaneCrossing plane = cross(node, line, tree.plane_slack);
    const Entry far{node.child[1 - plane.near], std::max(at.begin, plane.enter_far), at.end};
    if (at.begin > plane.leave_near) {
      at = far;
    } else {
      if (plane.enter_far <= at.end) stack[size++] = far;
      at = {node.child[plane.near], at.begin, std::min(at.end, plane.leave_near)};
    }
  }
}

}  // namespace gnomon::raytrace
