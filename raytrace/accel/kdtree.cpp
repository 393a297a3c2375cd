#include "raytrace/accel/kdtree.h"

#include <algorithm>
#include <memory>

#include "scene/base/parallel.h"

namespace gnomon::raytrace {
namespace {

constexpr double traversal_cost = 1.0, intersection_cost = 4.0;  // of a step down and a primitive's test
constexpr double empty_side_bonus = 0.8;                         // Wald and Havran, section 3.3
constexpr std::size_t swept_exactly = 1024;  // larger nodes try `bin_count` evenly spaced walls
constexpr std::size_t bin_count = 64;
constexpr std::size_t textbook_leaf = 5;
constexpr std::size_t textbook_growth =
    3;  // halves: a median that makes more than 3/2 of its items tells too little apart
constexpr std::size_t kd_parallel_threshold = 4096;

struct Reference {
  CellBox box;  // the part inside the cell
  std::uint32_t item;
};

struct KdBuildNode {
  int axis = -1;  // -1: leaf
  float split = 0.0f;
  std::unique_ptr<KdBuildNode> left, right;
  std::vector<std::uint32_t> items;
};

struct PlaneSplit {
  int axis = -1;
  float at = 0.0f;
  double cost = infinity;
};

double cost_of(const CellBox& cell, std::size_t axis, float at, std::size_t left, std::size_t right) {
  CellBox below = cell, above = cell;
  below.max[axis] = above.min[axis] = at;
  const double chance = intersection_cost / cell.half_area();
  const double cost = traversal_cost + chance * (below.half_area() * static_cast<double>(left) +
                                                 above.half_area() * static_cast<double>(right));
  return left == 0 || right == 0 ? empty_side_bonus * cost : cost;
}

bool is_inside(const CellBox& cell, std::size_t axis, float at) {
  return at > cell.min[axis] && at < cell.max[axis];
}

/// Every box' wall is tried: the counts change nowhere else.
void sweep(std::span<const Reference> refs, const CellBox& cell, std::size_t axis, PlaneSplit& best) {
  std::vector<float> begins, ends;
  for (const Reference& r : refs) begins.push_back(r.box.min[axis]), ends.push_back(r.box.max[axis]);
  std::sort(begins.begin(), begins.end());
  std::sort(ends.begin(), ends.end());
  std::size_t begun = 0, ended = 0;  // begins < at, ends <= at
  const auto report = [&](float at) {
    if (!is_inside(cell, axis, at)) return;
    while (begun < begins.size() && begins[begun] < at) ++begun;
    while (ended < ends.size() && ends[ended] <= at) ++ended;
    const double cost = cost_of(cell, axis, at, begun, refs.size() - ended);
    if (cost < best.cost) best = {static_cast<int>(axis), at, cost};
  };
  for (std::size_t b = 0, e = 0; b < begins.size() || e < ends.size();)
    report(e == ends.size() || (b < begins.size() && begins[b] <= ends[e]) ? begins[b++] : ends[e++]);
}

void try_bins(std::span<const Reference> refs, const CellBox& cell, std::size_t axis, PlaneSplit& best) {
  std::array<std::size_t, bin_count> begins{}, ends{};
  const double scale = bin_count / cell.extent(axis);
  const auto bin = [&](float at) {
    const double b = (static_cast<double>(at) - static_cast<double>(cell.min[axis])) * scale;
    return static_cast<std::size_t>(std::clamp(b, 0.0, static_cast<double>(bin_count - 1)));
  };
  for (const Reference& r : refs) ++begins[bin(r.box.min[axis])], ++ends[bin(r.box.max[axis])];
  std::size_t left = 0, right = refs.size();
  for (std::size_t b = 1; b < bin_count; ++b) {
    left += begins[b - 1], right -= ends[b - 1];
    const auto at = static_cast<float>(static_cast<double>(cell.min[axis]) + static_cast<double>(b) / scale);
    if (!is_inside(cell, axis, at)) continue;
    const double cost = cost_of(cell, axis, at, left, right);
    if (cost < best.cost) best = {static_cast<int>(axis), at, cost};
  }
}

class KdBuilder {
 public:
  KdBuilder(const CellItems& items, KdSplit rule) : items_(items), rule_(rule) {
    const double levels = std::log2(std::max(1.0, static_cast<double>(items.count())));
    max_depth_ = std::min(KdTree::max_depth, static_cast<int>(8.0 + 1.3 * levels));  // PBR 3rd ed., 4.4.1
  }

  std::unique_ptr<KdBuildNode> build() {
    std::vector<Reference> refs(items_.count());
    for (std::uint32_t i = 0; i < refs.size(); ++i) refs[i] = {{items_.box(i).min, items_.box(i).max}, i};
    return build(std::move(refs), items_.bounds(), 0, ReferenceBudget::for_items(items_.count()));
  }

 private:
  std::unique_ptr<KdBuildNode> build(std::vector<Reference> refs, const CellBox& cell, int depth,
                                     ReferenceBudget budget) {
    auto node = std::make_unique<KdBuildNode>();
    const PlaneSplit split = depth < max_depth_ ? choose(refs, cell, depth) : PlaneSplit{};
    if (split.axis < 0) return leaf(std::move(node), refs);
    const auto axis = static_cast<std::size_t>(split.axis);
    CellBox below = cell, above = cell;
    below.max[axis] = above.min[axis] = split.at;
    std::vector<Reference> left, right;
    partition(refs, axis, below, above, left, right);
    const std::uint64_t parent = refs.size(), children = left.size() + right.size();
    const bool useless = rule_ == KdSplit::surface_area ? left.size() == parent && right.size() == parent
                                                        : 2 * children > textbook_growth * parent;
    if (useless || !budget.affords(parent, children)) return leaf(std::move(node), refs);
    node->axis = split.axis, node->split = split.at;
    refs = {};
    const ReferenceBudget left_budget = budget.share(parent, children, left.size());
    const ReferenceBudget right_budget = budget.share(parent, children, right.size());
    const auto build_left = [&] { node->left = build(std::move(left), below, depth + 1, left_budget); };
    const auto build_right = [&] { node->right = build(std::move(right), above, depth + 1, right_budget); };
    if (parent < kd_parallel_threshold)
      build_left(), build_right();
    else
      parallel_invoke(build_left, build_right);
    return node;
  }

  static std::unique_ptr<KdBuildNode> leaf(std::unique_ptr<KdBuildNode> node,
                                           const std::vector<Reference>& refs) {
    for (const Reference& r : refs) node->items.push_back(r.item);
    return node;
  }

  PlaneSplit choose(std::span<const Reference> refs, const CellBox& cell, int depth) const {
    if (rule_ == KdSplit::cyclic_median) return median(refs, cell, depth);
    PlaneSplit best;
    best.cost = intersection_cost * static_cast<double>(refs.size());
    for (std::size_t axis = 0; axis < 3; ++axis)
      refs.size() <= swept_exactly ? sweep(refs, cell, axis, best) : try_bins(refs, cell, axis, best);
    return best;
  }

  /// The axis whose turn it is, or the next one on which the median centroid lies inside the cell.
  PlaneSplit median(std::span<const Reference> refs, const CellBox& cell, int depth) const {
    if (refs.size() <= textbook_leaf) return {};
    for (int turn = depth; turn < depth + 3; ++turn) {
      const auto axis = static_cast<std::size_t>(turn % 3);
      std::vector<float> centroids;
      for (const Reference& r : refs) {
        const BoxRef& box = items_.box(r.item);
        centroids.push_back(0.5f * box.min[axis] + 0.5f * box.max[axis]);
      }
      const auto middle = centroids.begin() + static_cast<std::ptrdiff_t>(centroids.size() / 2);
      std::nth_element(centroids.begin(), middle, centroids.end());
      if (is_inside(cell, axis, *middle)) return {static_cast<int>(axis), *middle, 0.0};
    }
    return {};
  }

  /// Boxes are rounded outwards, strictly, so a primitive that only touches the wall is never cut off by <.
  void partition(std::span<const Reference> refs, std::size_t axis, const CellBox& below,
                 const CellBox& above, std::vector<Reference>& left, std::vector<Reference>& right) const {
    const float at = below.max[axis];
    for (const Reference& r : refs) {
      const bool only_left = r.box.max[axis] <= at, only_right = !only_left && r.box.min[axis] >= at;
      Reference part = r;
      if (!only_right && (only_left || items_.may_overlap(r.item, below))) {
        part.box.max[axis] = std::min(r.box.max[axis], at);
        left.push_back(part);
      }
      part = r;
      if (!only_left && (only_right || items_.may_overlap(r.item, above))) {
        part.box.min[axis] = std::max(r.box.min[axis], at);
        right.push_back(part);
      }
    }
  }

  const CellItems& items_;
  KdSplit rule_;
  int max_depth_;
};

void flatten(const KdBuildNode& node, KdTree& tree) {
  const std::size_t index = tree.nodes.size();
  if (node.axis < 0) {
    tree.nodes.push_back({std::bit_cast<float>(static_cast<std::uint32_t>(tree.items.size())),
                          (static_cast<std::uint32_t>(node.items.size()) << 2) | 3u});
    tree.items.insert(tree.items.end(), node.items.begin(), node.items.end());
    return;
  }
  tree.nodes.push_back({node.split, 0});
  flatten(*node.left, tree);
  tree.nodes[index].bits =
      (static_cast<std::uint32_t>(tree.nodes.size()) << 2) | static_cast<std::uint32_t>(node.axis);
  flatten(*node.right, tree);
}

}  // namespace

KdTree build_kdtree(const CellItems& items, KdSplit rule) {
  KdTree tree;
  if (items.count() == 0) return tree;
  tree.bounds = items.bounds();
  flatten(*KdBuilder(items, rule).build(), tree);
  tree.nodes.shrink_to_fit(), tree.items.shrink_to_fit();
  return tree;
}

}  // namespace gnomon::raytrace
