#include "raytrace/bvh/wide_tree.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <span>

#include "raytrace/bvh/wide_instances.h"
#include "scene/base/parallel.h"

namespace gnomon::raytrace {
namespace {

constexpr float inf = WideBox::inf;
constexpr std::uint32_t parallel_size = 4096;  // of fewer primitives one thread makes the parts,
constexpr int parallel_depth = 2;              // and the nodes below
constexpr float node_cost = 1.0f, leaf_cost = 1.0f, instance_cost = 4.0f;  // of a visit

/// Part of the default hierarchy: a range of leaf order small enough for a leaf, a kept instance, or a Pair.
struct Part {
  WideBox box;
  std::uint32_t pair = 0;              // its index, if it is one
  std::uint32_t first = 0, count = 0;  // count 0: a pair
  bool instance = false;               // of the number `first`
  bool is_leaf() const { return count > 0; }
};

/// Two parts, and what they cost at least when they become so many children of a wide node: [i - 1] for i.
struct Pair {
  std::array<Part, 2> parts;
  std::array<float, node_lanes> cost;
  std::array<std::uint8_t, node_lanes> left;  // how many of them the first part makes; 0: as with one fewer
};

WideBox wide_box_of(const BvhNode& node, std::size_t child) {
  WideBox box;
  for (std::size_t row = 0; row < 6; ++row) box.at[row] = node.bounds[row][child];
  return box;
}
bool is_empty(const BvhChild& child) {
  return child.is_leaf() && child.count() == 0 && !child.is_instance();
}

/// No fewer than the leaves and instances of the wide tree: a leaf of the default hierarchy is one, unless it has to be
/// halved.
std::size_t most_parts(const Bvh& bvh, bool has_shapes) {
  std::size_t parts = 0;
  for (const BvhNode& node : bvh.nodes)
    for (const BvhChild& child : node.child)
      if (child.is_leaf())
        parts += has_shapes || child.count() > leaf_corners / 3 ? std::max(child.count(), 1U) : 1U;
  return parts;
}

/// A leaf's corners, each once.
struct Corners {
  std::array<std::uint32_t, leaf_corners> number{};  // as LeafPrimitives has them
  std::uint32_t index[3][2] = {};                    // as in LeafTriangles
  std::uint32_t count = 0;

  /// The k-th corner of the leaf's i-th triangle; false: no room.
  bool put(std::uint32_t corner, std::size_t i, std::size_t k) {
    std::uint32_t equal = 0;  // bit j: to the j-th; without branches
    for (std::uint32_t j = 0; j < leaf_corners; ++j) equal |= number[j] == corner ? 1u << j : 0u;
    equal &= (1u << count) - 1;
    const std::uint32_t found = equal != 0 ? static_cast<std::uint32_t>(std::countr_zero(equal)) : count;
    if (found == leaf_corners) return false;
    if (found == count) number[count++] = corner;
    index[k][i % 2] |= (found + 1) << (4 * (i / 2));
    return true;
  }
};

/// The largest component of a triangle's edges.
double longest_edge(const LeafPrimitive& triangle) {
  double longest = 0.0;
  for (std::size_t i = 0; i < 9; ++i)
    longest = std::max(longest, std::abs(triangle.v[(i + 3) % 9] - triangle.v[i]));
  return longest;
}

// First the pairs, bottom up. Each gets its least cost as one to sixteen children (Ylitalo et al. 2017,
// "Efficient incoherent ray traversal on GPUs through compressed wide BVHs", section 3.1); then the nodes,
// top down. A thread takes the places of what it makes when it begins it.
class Collapse {
 public:
  Collapse(const Bvh& bvh, const World& world, WideTree& tree)
      : bvh_(bvh),
        world_(world),
        tree_(tree),
        has_shapes_(world.primitive_count() > world.triangle_count()),
        pairs_(most_parts(bvh, has_shapes_)) {
    WideBox all;
    for (std::size_t i = 0; i < 4; ++i)
      if (!is_empty(bvh.nodes[0].child[i])) all.grow(wide_box_of(bvh.nodes[0], i));
    const Part root = part_of(BvhChild::node(0), all);
    const std::size_t most = std::size_t{1} + used_pairs_.load();  // a node is a pair, or the only leaf's
    tree.nodes.resize(most), resize_leaves(most);
    collapse(root, nodes_++, 0);
    tree.nodes.resize(nodes_), resize_leaves(leaves_);
  }

 private:
  void resize_leaves(std::size_t count) {
    tree_.plain ? tree_.plain_leaves.resize(count) : tree_.leaves.resize(count);
  }

  struct Pieces {
    std::array<Part, node_lanes> at;
    std::size_t count = 0;
  };

  /// Whether all below a child is few enough for a leaf; then the range of leaf order that it is.
  bool is_short(const BvhChild& child, std::uint32_t& first, std::uint32_t& end) const {
    if (is_empty(child)) return true;
    if (child.is_instance()) return false;
    if (!child.is_leaf()) {
      const BvhNode& node = bvh_.nodes[child.index()];
      return std::all_of(std::begin(node.child), std::end(node.child),
                         [&](const BvhChild& c) { return is_short(c, first, end); });
    }
    first = std::min(first, child.first());
    end = std::max(end, child.first() + child.count());
    return end - first <= leaf_lanes;
  }

  bool is_triangle(std::uint32_t leaf) const { return world_.is_triangle(bvh_.ids[leaf]); }

  bool are_alike(std::uint32_t first, std::uint32_t count) const {
    for (std::uint32_t i = 1; i < count; ++i)
      if (is_triangle(first + i) != is_triangle(first)) return false;
    return true;
  }
  /// False: more than a leaf has room for.
  bool corners_of(std::uint32_t first, std::uint32_t count, Corners& corners) const {
    for (std::uint32_t i = 0; i < count && is_triangle(first); ++i) {
      const std::array<std::uint32_t, 3> numbers = bvh_.primitives.corner_numbers(first + i);
      for (std::size_t k = 0; k < 3; ++k)
        if (!corners.put(numbers[k], i, k)) return false;
    }
    return true;
  }
  bool fits(std::uint32_t first, std::uint32_t count) const {
    if (count > leaf_lanes || (has_shapes_ && !are_alike(first, count))) return false;
    Corners corners;
    return count <= leaf_corners / 3 || corners_of(first, count, corners);
  }

  Part part_of(const BvhChild& child, const WideBox& box) {
    if (child.is_instance()) return {box, 0, child.instance(), 1, true};
    std::uint32_t first = std::numeric_limits<std::uint32_t>::max(), end = 0;
    if (is_short(child, first, end) && fits(first, end - first)) return {box, 0, first, end - first};
    if (child.is_leaf()) return halved(child.first(), child.count(), box);
    const BvhNode& node = bvh_.nodes[child.index()];
    std::array<Part, 4> parts;
    std::array<std::size_t, 4> used{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < 4; ++i)
      if (!is_empty(node.child[i])) used[count++] = i;
    const auto make = [&](std::size_t k) {
      parts[k] = part_of(node.child[used[k]], wide_box_of(node, used[k]));
    };
    if (bvh_.below[child.index()].count > parallel_size)
      parallel_for(count, make);
    else
      for (std::size_t k = 0; k < count; ++k) make(k);
    leave_if_given_up();
    return joined(parts, (1u << count) - 1);
  }

  /// Halves a leaf that has too many corners into parts, all with its box.
  Part halved(std::uint32_t first, std::uint32_t count, const WideBox& box) {
    if (fits(first, count)) return {box, 0, first, count};
    const std::uint32_t half = count / 2;
    return pair_of(halved(first, half, box), halved(first + half, count - half, box), box);
  }

  /// The parts of a set as one: in two halves with the least area.
  Part joined(const std::array<Part, 4>& parts, unsigned set) {
    if (std::has_single_bit(set)) return parts[static_cast<std::size_t>(std::countr_zero(set))];
    const auto around = [&](unsigned some) {
      WideBox box;
      for (; some != 0; some &= some - 1)
        box.grow(parts[static_cast<std::size_t>(std::countr_zero(some))].box);
      return box;
    };
    unsigned best = 0;
    float least = inf;
    for (unsigned half = (set - 1) & set; half > set / 2; half = (half - 1) & set) {
      const float area = around(half).half_area() + around(set & ~half).half_area();
      if (best == 0 || area < least) best = half, least = area;
    }
    return pair_of(joined(parts, best), joined(parts, set & ~best), around(set));
  }

  /// [i]: the least cost as i + 1 children.
  std::array<float, node_lanes> costs_of(const Part& part) const {
    if (!part.is_leaf()) return pairs_[part.pair].cost;
    std::array<float, node_lanes> costs;
    costs.fill((part.instance ? instance_cost : leaf_cost) * part.box.half_area());
    return costs;
  }

  Part pair_of(const Part& one, const Part& other, const WideBox& box) {
    const std::uint32_t first = std::min(one.first, other.first);
    const std::uint32_t end = std::max(one.first + one.count, other.first + other.count);
    const bool whole = one.is_leaf() && other.is_leaf() && !one.instance && !other.instance &&
                       end - first == one.count + other.count;
    if (whole && fits(first, end - first)) return {box, 0, first, end - first};
    const std::uint32_t index = used_pairs_++;
    Pair& pair = pairs_[index];
    pair.parts = {one, other};
    share_children(costs_of(one), costs_of(other), pair);
    pair.cost[0] = node_cost * box.half_area() + pair.cost[node_lanes - 1];
    for (std::size_t i = 1; i < node_lanes; ++i)
      if (pair.cost[i] > pair.cost[0]) pair.cost[i] = pair.cost[0], pair.left[i] = 0;
    return {box, index, 0, 0};
  }

  /// The cheapest way to share so many children among two parts, and not more than as with one child fewer. All numbers of
  /// children at once, in plain loops that compilers make vectors of.
  static void share_children(const std::array<float, node_lanes>& one,
                             const std::array<float, node_lanes>& other, Pair& pair) {
    std::array<float, 2 * node_lanes> shifted;  // no number of children below one
    std::fill_n(shifted.begin(), node_lanes, inf);
    std::copy(other.begin(), other.end(), shifted.begin() + node_lanes);
    std::array<float, node_lanes> least;
    std::array<std::uint32_t, node_lanes> left{};
    least.fill(inf);
    for (std::uint32_t k = 1; k < node_lanes; ++k)
      for (std::size_t i = 0; i < node_lanes; ++i) {
        const float cost = one[k - 1] + shifted[node_lanes + i - k];
        left[i] = cost < least[i] ? k : left[i];
        least[i] = std::min(least[i], cost);
      }
    pair.cost[1] = least[1], pair.left[1] = 1;
    for (std::size_t i = 2; i < node_lanes; ++i) {
      const bool better = least[i] < pair.cost[i - 1];
      pair.cost[i] = better ? least[i] : pair.cost[i - 1];
      pair.left[i] = static_cast<std::uint8_t>(better ? left[i] : 0);
    }
  }

  /// Appends what the part becomes as so many children.
  void split(const Part& part, std::size_t children, Pieces& pieces) const {
    if (!part.is_leaf()) {
      const Pair& pair = pairs_[part.pair];
      while (children > 1 && pair.left[children - 1] == 0) --children;
      if (children > 1) {
        const std::size_t left = pair.left[children - 1];
        split(pair.parts[0], left, pieces), split(pair.parts[1], children - left, pieces);
        return;
      }
    }
    pieces.at[pieces.count++] = part;
  }

  void collapse(const Part& from, std::uint32_t to, int depth) {
    Pieces pieces;
    split(from, node_lanes, pieces);
    WideNode& node = tree_.nodes[to];
    for (std::size_t i = 0; i < node_lanes; ++i) {
      const WideBox box = i < pieces.count ? pieces.at[i].box : WideBox{};
      for (std::size_t row = 0; row < 6; ++row) node.bounds[row][i] = box.at[row];
      node.child[i] = WideChild::leaf_flag;
    }
    set_order({pieces.at.data(), pieces.count}, node);
    const auto store_child = [&](std::size_t i) {
      const Part& piece = pieces.at[i];
      if (piece.instance) {
        node.child[i] = WideChild::leaf_flag | WideChild::instance_flag | piece.first;
        return;
      }
      const std::uint32_t place = piece.is_leaf() ? leaves_++ : nodes_++;
      node.child[i] = piece.is_leaf() ? WideChild::leaf_flag | place : place;
      if (piece.is_leaf())
        store_leaf(piece, place);
      else
        collapse(piece, place, depth + 1);
    };
    if (depth < parallel_depth)
      parallel_for(pieces.count, store_child);
    else
      for (std::size_t i = 0; i < pieces.count; ++i) store_child(i);
    leave_if_given_up();
  }

  /// Nearest first by the boxes' middles along the octant's diagonal, and of equals the first. Ranks are counted, in plain
  /// loops that compilers make vectors of.
  static void set_order(std::span<const Part> pieces, WideNode& node) {
    for (unsigned octant = 0; octant < 4; ++octant) {
      std::array<float, node_lanes> far;
      far.fill(inf);
      for (std::size_t i = 0; i < pieces.size(); ++i) {
        const auto& box = pieces[i].box.at;
        far[i] = 0.0f;
        for (std::size_t a = 0; a < 3; ++a) {
          const float middle = box[a] + box[3 + a];
          far[i] += (octant >> a & 1u) != 0 ? -middle : middle;
        }
      }
      std::array<std::uint32_t, node_lanes> rank{};
      for (std::uint32_t j = 0; j < node_lanes; ++j)
        for (std::uint32_t i = 0; i < node_lanes; ++i)
          rank[i] += (far[j] < far[i] || (far[j] == far[i] && j < i)) ? 1u : 0u;
      for (std::uint8_t i = 0; i < node_lanes; ++i) node.order[octant][rank[i]] = i;
    }
  }

  void store_leaf(const Part& piece, std::uint32_t place) {
    Corners corners;
    corners_of(piece.first, piece.count, corners);
    LeafTriangles triangles;
    std::copy(&corners.index[0][0], &corners.index[0][0] + 6, &triangles.index[0][0]);
    triangles.range = piece.first | (piece.count - 1) << 27 | (is_triangle(piece.first) ? 0u : 1u << 31);
    if (tree_.plain) {
      tree_.plain_leaves[place].triangles = triangles;
      store_plain_corners(corners, tree_.plain_leaves[place]);
    } else {
      tree_.leaves[place].triangles = triangles;
      store_corners(piece, corners, tree_.leaves[place]);
    }
  }

  void store_plain_corners(const Corners& corners, PlainLeaf& leaf) const {
    for (int a = 0; a < 3; ++a)
      for (std::size_t i = 0; i <= leaf_corners; ++i)
        leaf.corner[static_cast<std::size_t>(a)][i] =
            i > 0 && i <= corners.count ? static_cast<float>(bvh_.primitives.corner(corners.number[i - 1])[a])
                                        : 0.0f;
  }

  void store_corners(const Part& piece, const Corners& corners, WideLeaf& leaf) const {
    std::array<std::array<double, 3>, leaf_corners> from_center;
    double longest = 0.0;
    for (std::size_t i = 0; i < corners.count; ++i) {
      const Vec3& corner = bvh_.primitives.corner(corners.number[i]);
      from_center[i] = {corner.x - tree_.center[0], corner.y - tree_.center[1], corner.z - tree_.center[2]};
    }
    for (std::uint32_t i = 0; i < piece.count && !leaf.triangles.shapes(); ++i)
      longest = std::max(longest, longest_edge(bvh_.primitives[piece.first + i]));
    pack_corners(piece.box, {from_center.data(), corners.count}, longest, tree_.reach, leaf);
  }

  const Bvh& bvh_;
  const World& world_;
  WideTree& tree_;
  bool has_shapes_;
  HugeArray<Pair> pairs_;
  std::atomic<std::uint32_t> used_pairs_{0}, nodes_{0}, leaves_{0};
};

/// The largest coordinate of the boxes at the root.
float reach_of(const BvhNode& root) {
  float reach = 0.0f;
  for (std::size_t i = 0; i < 4; ++i)
    if (!is_empty(root.child[i]))
      for (const auto& row : root.bounds) reach = std::max(reach, std::abs(row[i]));
  return reach;
}

}  // namespace

std::unique_ptr<const WideTree> collapse_bvh(const Bvh& bvh, const World& world, bool plain) {
  if (bvh.nodes.empty() || (plain && !bvh.instances.empty())) return nullptr;
  auto tree = std::make_unique<WideTree>();
  tree->origin = &bvh, tree->plain = plain;
  tree->center = {bvh.center.x, bvh.center.y, bvh.center.z, 0.0}, tree->reach = reach_of(bvh.nodes[0]);
  if (!(tree->reach >= 0x1p-26f && tree->reach <= 0x1p30f)) return nullptr;
  add_wide_instances(world, *tree);
  const Collapse collapse(bvh, world, *tree);
  return tree;
}

}  // namespace gnomon::raytrace
