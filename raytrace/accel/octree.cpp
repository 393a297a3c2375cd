#include "raytrace/accel/octree.h"

#include <algorithm>
#include <memory>

#include "scene/base/parallel.h"

namespace gnomon::raytrace {
namespace {

constexpr std::size_t octree_leaf_size = 8;
constexpr std::size_t octree_parallel_threshold = 4096;

struct OctreeBuildNode {
  std::array<float, 3> middle{};
  std::array<std::unique_ptr<OctreeBuildNode>, 8> children;  // none: leaf
  std::vector<std::uint32_t> items;
  bool is_leaf() const { return children[0] == nullptr; }
};

CellBox child_cell(const CellBox& cell, const std::array<float, 3>& middle, std::size_t child) {
  CellBox out = cell;
  for (std::size_t a = 0; a < 3; ++a) ((child >> a & 1u) != 0 ? out.min : out.max)[a] = middle[a];
  return out;
}

class OctreeBuilder {
 public:
  explicit OctreeBuilder(const CellItems& items) : items_(items) {
    // Deep enough for a cell per primitive if they fill the space evenly, and four halvings for uneven ones.
    const double levels = std::log2(std::max(1.0, static_cast<double>(items.count()))) / 3.0;
    max_depth_ = std::min(Octree::max_depth, static_cast<int>(levels) + 8);
  }

  std::unique_ptr<OctreeBuildNode> build() {
    std::vector<std::uint32_t> all(items_.count());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    return build(std::move(all), items_.bounds(), 0, ReferenceBudget::for_items(items_.count()));
  }

 private:
  std::unique_ptr<OctreeBuildNode> build(std::vector<std::uint32_t> items, const CellBox& cell, int depth,
                                         ReferenceBudget budget) {
    auto node = std::make_unique<OctreeBuildNode>();
    std::array<std::vector<std::uint32_t>, 8> parts;
    if (depth >= max_depth_ || !split(items, cell, node->middle, parts)) {
      node->items = std::move(items);
      return node;
    }
    std::uint64_t children = 0;
    for (const auto& part : parts) children += part.size();
    const std::uint64_t parent = items.size();
    if (children >= 8 * parent || !budget.affords(parent, children)) {  // nothing told apart, or too dear
      node->items = std::move(items);
      return node;
    }
    items = {};
    const auto build_child = [&](std::size_t i) {
      const ReferenceBudget share = budget.share(parent, children, parts[i].size());
      node->children[i] = build(std::move(parts[i]), child_cell(cell, node->middle, i), depth + 1, share);
    };
    if (parent < octree_parallel_threshold)
      for (std::size_t i = 0; i < 8; ++i) build_child(i);
    else
      parallel_for(std::size_t{8}, build_child);
    return node;
  }

  /// False for a cell that needs no split, or that floats cannot halve.
  bool split(std::span<const std::uint32_t> items, const CellBox& cell, std::array<float, 3>& middle,
             std::array<std::vector<std::uint32_t>, 8>& parts) const {
    if (items.size() <= octree_leaf_size) return false;
    for (std::size_t a = 0; a < 3; ++a) {
      middle[a] = 0.5f * cell.min[a] + 0.5f * cell.max[a];
      if (!(middle[a] > cell.min[a] && middle[a] < cell.max[a])) return false;
    }
    for (std::size_t i = 0; i < 8; ++i) {
      const CellBox child = child_cell(cell, middle, i);
      for (const std::uint32_t item : items)
        if (items_.may_overlap(item, child)) parts[i].push_back(item);
    }
    return true;
  }

  const CellItems& items_;
  int max_depth_;
};

void flatten(const OctreeBuildNode& node, std::size_t index, Octree& tree) {
  if (node.is_leaf()) {
    tree.nodes[index] = {
        {}, static_cast<std::uint32_t>(tree.items.size()), static_cast<std::uint32_t>(node.items.size())};
    tree.items.insert(tree.items.end(), node.items.begin(), node.items.end());
    return;
  }
  const std::size_t first = tree.nodes.size();
  tree.nodes[index] = {node.middle, static_cast<std::uint32_t>(first), OctreeNode::inner};
  tree.nodes.resize(first + 8);
  for (std::size_t i = 0; i < 8; ++i) flatten(*node.children[i], first + i, tree);
}

}  // namespace

Octree build_octree(const CellItems& items) {
  Octree tree;
  if (items.count() == 0) return tree;
  tree.bounds = items.bounds();
  tree.nodes.resize(1);
  flatten(*OctreeBuilder(items).build(), 0, tree);
  tree.nodes.shrink_to_fit(), tree.items.shrink_to_fit();
  return tree;
}

}  // namespace gnomon::raytrace
