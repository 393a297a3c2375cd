#include "raytrace/accel/bsp.h"

#include <algorithm>
#include <memory>

#include "raytrace/accel/polytope.h"
#include "scene/base/parallel.h"

namespace gnomon::raytrace {
namespace {

constexpr double plane_cost = 3.0, test_cost = 4.0;  // relative: of a plane, of a primitive's test
constexpr std::size_t scored_items = 1024;           // larger nodes judge a plane by so many, evenly picked
constexpr std::size_t bsp_leaf_size = 3;
constexpr int walls_per_axis = 6;
constexpr std::size_t triangles_tried = 4;
constexpr std::size_t bsp_parallel_threshold = 1024;
constexpr int height_operations = 8;  // roundings of a corner's height over a plane

struct BspBuildNode {
  CutPlane plane{Vec3(0.0), 0.0};
  std::unique_ptr<BspBuildNode> below, above;  // none: leaf
  std::vector<std::uint32_t> items;
};

/// A triangle's corners, or a box as its middle, three times, with what it reaches around it.
struct Extent {
  std::array<Vec3, 3> points;
  Vec3 half;
};

struct Sides {
  bool below, above;
};

Vec3 corner_of(const std::array<float, 3>& p) {
  return {p[0], p[1], p[2]};
}

class BspBuilder {
 public:
  explicit BspBuilder(const CellItems& items) : items_(items) {
    const Vec3 reach =
        glm::max(glm::abs(corner_of(items.bounds().min)), glm::abs(corner_of(items.bounds().max)));
    slack_ = error_gamma(height_operations) * 4.0 * glm::dot(reach, Vec3(1.0));
    const double levels = std::log2(std::max(1.0, static_cast<double>(items.count())));
    max_depth_ = std::min(BspTree::max_depth, static_cast<int>(8.0 + 1.3 * levels));
  }

  double slack() const { return slack_; }

  std::unique_ptr<BspBuildNode> build() {
    std::vector<std::uint32_t> all(items_.count());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    return build(std::move(all), Polytope(items_.bounds()), 0, ReferenceBudget::for_items(items_.count()));
  }

 private:
  struct Choice {
    CutPlane plane{Vec3(0.0), 0.0};
    double cost;
  };

  std::unique_ptr<BspBuildNode> build(std::vector<std::uint32_t> items, const Polytope& cell, int depth,
                                      ReferenceBudget budget) {
    auto node = std::make_unique<BspBuildNode>();
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
    if (parent < bsp_parallel_threshold)
      build_below(), build_above();
    else
      parallel_invoke(build_below, build_above);
    return node;
  }

  /// A zero normal: better a leaf.
  Choice choose(std::span<const std::uint32_t> items, const Polytope& cell) const {
    if (items.size() <= bsp_leaf_size) return {.cost = infinity};
    std::vector<Extent> sample;
    const std::size_t step = (items.size() + scored_items - 1) / scored_items;
    for (std::size_t i = 0; i < items.size(); i += step) sample.push_back(extent(items[i]));
    Choice best{.cost = test_cost * static_cast<double>(sample.size())};
    CutBuffers buffers;
    const auto report = [&](const CutPlane& plane) {
      const double cost = cost_of(plane, sample, cell, best.cost, buffers);
      if (cost < best.cost) best = {plane, cost};
    };
    report_walls(sample, report);
    const std::size_t apart = std::max<std::size_t>(1, sample.size() / triangles_tried);
    for (std::size_t i = apart / 2; i < sample.size(); i += apart) report_triangle(sample[i], report);
    return best;
  }

  template <class Report>
  static void report_walls(std::span<const Extent> sample, const Report& report) {
    Vec3 lo(infinity), hi(-infinity);
    for (const Extent& e : sample)
      for (const Vec3& p : e.points) lo = glm::min(lo, p - e.half), hi = glm::max(hi, p + e.half);
    for (int a = 0; a < 3; ++a) {
      Vec3 normal(0.0);
      normal[a] = 1.0;
      for (int i = 0; i <= walls_per_axis; ++i)
        report({normal, lo[a] + (hi[a] - lo[a]) * i / walls_per_axis});
    }
  }

  template <class Report>
  static void report_triangle(const Extent& triangle, const Report& report) {
    const auto& p = triangle.points;
    const Vec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);  // zero for the point of another shape
    report_plane(normal, p[0], report);
    for (std::size_t k = 0; k < 3; ++k) report_plane(glm::cross(normal, p[(k + 1) % 3] - p[k]), p[k], report);
  }

  template <class Report>
  static void report_plane(const Vec3& normal, const Vec3& point, const Report& report) {
    const double length = glm::length(normal);
    if (!(length > 0.0) || !std::isfinite(length)) return;
    report(CutPlane{normal / length, glm::dot(normal / length, point)});
  }

  /// Infinite where a glance shows that it cannot be below `best`: the parts' areas add up to more than the
  /// cell's.
  double cost_of(const CutPlane& plane, std::span<const Extent> sample, const Polytope& cell, double best,
                 CutBuffers& buffers) const {
    double below = 0.0, above = 0.0;
    for (const Extent& e : sample) {
      const Sides sides = sides_of(e, plane);
      below += sides.below ? 1.0 : 0.0, above += sides.above ? 1.0 : 0.0;
    }
    if (plane_cost + test_cost * std::min(below, above) >= best) return infinity;
    const auto [area_below, area_above] = cell.areas_of_parts(plane, buffers);
    return plane_cost + test_cost * (below * area_below + above * area_above) / cell.area();
  }

  void partition(std::span<const std::uint32_t> items, const CutPlane& plane,
                 std::vector<std::uint32_t>& below, std::vector<std::uint32_t>& above) const {
    for (const std::uint32_t i : items) {
      const Sides sides = sides_of(extent(i), plane);
      if (sides.below) below.push_back(i);
      if (sides.above) above.push_back(i);
    }
  }

  Extent extent(std::uint32_t item) const {
    if (items_.is_triangle(item)) return {items_.corners(item), Vec3(0.0)};
    const Vec3 lo = corner_of(items_.box(item).min), hi = corner_of(items_.box(item).max);
    const Vec3 middle = 0.5 * (lo + hi);
    return {{middle, middle, middle}, 0.5 * (hi - lo)};
  }

  Sides sides_of(const Extent& e, const CutPlane& plane) const {
    const double a = plane.height(e.points[0]), b = plane.height(e.points[1]), c = plane.height(e.points[2]);
    const double half = glm::dot(glm::abs(plane.normal), e.half);
    const bool above = std::max({a, b, c}) + half > slack_;
    return {std::min({a, b, c}) - half < -slack_ || !above, above};
  }

  const CellItems& items_;
  double slack_;
  int max_depth_;
};

std::uint32_t flatten(const BspBuildNode& node, BspTree& tree) {
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
  BspBuilder builder(items);
  tree.plane_slack = builder.slack();
  tree.root = flatten(*builder.build(), tree);
  tree.nodes.shrink_to_fit(), tree.leaves.shrink_to_fit(), tree.items.shrink_to_fit();
  return tree;
}

}  // namespace gnomon::raytrace
