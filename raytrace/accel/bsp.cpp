#include "raytrace/accel/bsp.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <memory>

#include "raytrace/accel/polytope.h"

namespace gnomon::raytrace {
namespace {

constexpr double traversal_cost = 2.0, intersection_cost = 4.0;  // of a plane and of a primitive's test
constexpr std::size_t scored_items = 1024;  // larger nodes judge a plane by so many, evenly picked
constexpr int walls_per_axis = 8;
constexpr std::size_t triangles_tried = 4;
constexpr std::size_t parallel_threshold = 1024;
constexpr int height_operations = 8;  // roundings of a corner's height over a plane

struct BuildNode {
  CutPlane plane{Vec3(0.0), 0.0};
  std::unique_ptr<BuildNode> below, above;  // none: leaf
  std::vector<std::uint32_t> items;
};

struct Heights {
  double min, max;
};

Vec3 corner_of(const std::array<float, 3>& p) {
  return {p[0], p[1], p[2]};
}

class Builder {
 public:
  explicit Builder(const CellItems& items) : items_(items) {
    const Vec3 reach =
        glm::max(glm::abs(corner_of(items.bounds().min)), glm::abs(corner_of(items.bounds().max)));
    slack_ = error_gamma(height_operations) * 4.0 * glm::dot(reach, Vec3(1.0));
    const double levels = std::log2(std::max(1.0, static_cast<double>(items.count())));
    max_depth_ = std::min(BspTree::max_depth, static_cast<int>(8.0 + 1.3 * levels));
  }

  double slack() const { return slack_; }

  std::unique_ptr<BuildNode> build() {
    std::vector<std::uint32_t> all(items_.count());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    return build(std::move(all), Polytope(items_.bounds()), 0, ReferenceBudget::for_items(items_.count()));
  }

 private:
  struct Choice {
    CutPlane plane{Vec3(0.0), 0.0};
    double cost;
  };

  std::unique_ptr<BuildNode> build(std::vector<std::uint32_t> items, const Polytope& cell, int depth,
                                   ReferenceBudget budget) {
    auto node = std::make_unique<BuildNode>();
    const Choice best = depth < max_depth_ ? choose(items, cell) : Choice{.cost = infinity};
    std::vector<std::uint32_t> below, above;
    if (best.plane.normal != Vec3(0.0)) partition(items, best.plane, below, above);
    const std::uint64_t parent = items.size(), children = below.size() + above.size();
    const bool useless = children == 0 || (below.size() == parent && above.size() == parent);
    if (useless || !budget.affords(parent, children)) {
      node->items = std::move(items);
      return node;
    }
    node->plane = best.plane;
    items = {};
    const ReferenceBudget below_budget = budget.share(parent, children, below.size());
    const ReferenceBudget above_budget = budget.share(parent, children, above.size());
    const auto build_below = [&] {
      node->below = build(std::move(below), cell.cut(best.plane), depth + 1, below_budget);
    };
    const auto build_above = [&] {
      node->above = build(std::move(above), cell.cut({-best.plane.normal, -best.plane.offset}), depth + 1,
                          above_budget);
    };
    if (parent < parallel_threshold)
      build_below(), build_above();
    else
      tbb::parallel_invoke(build_below, build_above);
    return node;
  }

  /// A zero normal: better a leaf.
  Choice choose(std::span<const std::uint32_t> items, const Polytope& cell) const {
    std::vector<std::uint32_t> sample;
    const std::size_t step = (items.size() + scored_items - 1) / scored_items;
    for (std::size_t i = 0; i < items.size(); i += std::max<std::size_t>(1, step)) sample.push_back(items[i]);
    Choice best{.cost = intersection_cost * static_cast<double>(sample.size())};
    if (sample.size() < 2) return best;
    const auto offer = [&](const CutPlane& plane) {
      const double cost = cost_of(plane, sample, cell);
      if (cost < best.cost) best = {plane, cost};
    };
    offer_walls(sample, offer);
    const std::size_t apart = std::max<std::size_t>(1, sample.size() / triangles_tried);
    for (std::size_t i = apart / 2; i < sample.size(); i += apart) offer_triangle(sample[i], offer);
    return best;
  }

  template <class Offer>
  void offer_walls(std::span<const std::uint32_t> sample, const Offer& offer) const {
    Vec3 lo(infinity), hi(-infinity);
    for (const std::uint32_t i : sample)
      lo = glm::min(lo, corner_of(items_.box(i).min)), hi = glm::max(hi, corner_of(items_.box(i).max));
    for (int a = 0; a < 3; ++a) {
      Vec3 normal(0.0);
      normal[a] = 1.0;
      for (int i = 0; i <= walls_per_axis; ++i) offer({normal, lo[a] + (hi[a] - lo[a]) * i / walls_per_axis});
    }
  }

  template <class Offer>
  void offer_triangle(std::uint32_t item, const Offer& offer) const {
    if (!items_.is_triangle(item)) return;
    const auto corners = items_.corners(item);
    const Vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    offer_plane(normal, corners[0], offer);
    for (std::size_t k = 0; k < 3; ++k)
      offer_plane(glm::cross(normal, corners[(k + 1) % 3] - corners[k]), corners[k], offer);
  }

  template <class Offer>
  static void offer_plane(const Vec3& normal, const Vec3& point, const Offer& offer) {
    const double length = glm::length(normal);
    if (!(length > 0.0) || !std::isfinite(length)) return;
    offer(CutPlane{normal / length, glm::dot(normal / length, point)});
  }

  double cost_of(const CutPlane& plane, std::span<const std::uint32_t> sample, const Polytope& cell) const {
    double below = 0.0, above = 0.0;
    for (const std::uint32_t i : sample) {
      const Heights h = heights(i, plane);
      if (h.max > slack_) ++above;
      if (h.min < -slack_ || h.max <= slack_) ++below;
    }
    const auto [area_below, area_above] = cell.areas_of_parts(plane);
    return traversal_cost + intersection_cost * (below * area_below + above * area_above) / cell.area();
  }

  void partition(std::span<const std::uint32_t> items, const CutPlane& plane,
                 std::vector<std::uint32_t>& below, std::vector<std::uint32_t>& above) const {
    for (const std::uint32_t i : items) {
      const Heights h = heights(i, plane);
      if (h.max > slack_) above.push_back(i);
      if (h.min < -slack_ || h.max <= slack_) below.push_back(i);
    }
  }

  Heights heights(std::uint32_t item, const CutPlane& plane) const {
    if (items_.is_triangle(item)) {
      const auto corners = items_.corners(item);
      const double a = plane.height(corners[0]), b = plane.height(corners[1]), c = plane.height(corners[2]);
      return {std::min({a, b, c}), std::max({a, b, c})};
    }
    const Vec3 lo = corner_of(items_.box(item).min), hi = corner_of(items_.box(item).max);
    const double middle = plane.height(0.5 * (lo + hi)),
                 half = glm::dot(glm::abs(plane.normal), 0.5 * (hi - lo));
    return {middle - half, middle + half};
  }

  const CellItems& items_;
  double slack_;
  int max_depth_;
};

std::uint32_t flatten(const BuildNode& node, BspTree& tree) {
  if (node.below == nullptr) {
    tree.leaves.push_back(
        {static_cast<std::uint32_t>(tree.items.size()), static_cast<std::uint32_t>(node.items.size())});
    tree.items.insert(tree.items.end(), node.items.begin(), node.items.end());
    return BspNode::leaf_flag | static_cast<std::uint32_t>(tree.leaves.size() - 1);
  }
  const std::size_t index = tree.nodes.size();
  const Vec3& n = node.plane.normal;
  tree.nodes.push_back({{n.x, n.y, n.z}, node.plane.offset, {0, 0}});
  const std::uint32_t below = flatten(*node.below, tree), above = flatten(*node.above, tree);
  tree.nodes[index].child = {below, above};
  return static_cast<std::uint32_t>(index);
}

}  // namespace

BspTree build_bsp(const CellItems& items) {
  BspTree tree;
  if (items.count() == 0) return tree;
  tree.bounds = items.bounds();
  Builder builder(items);
  tree.plane_slack = builder.slack();
  tree.root = flatten(*builder.build(), tree);
  tree.nodes.shrink_to_fit(), tree.leaves.shrink_to_fit(), tree.items.shrink_to_fit();
  return tree;
}

}  // namespace gnomon::raytrace
