#include "raytrace/wide/tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <span>

namespace gnomon::raytrace {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr int parallel_depth = 4;  // nodes below it are folded by one thread

/// A child to be: a leaf, or an inner node that may yet be opened.
struct Piece {
  std::array<float, 6> box;  // as a column of BvhNode::bounds
  std::uint32_t node = 0;
  std::uint32_t first = 0, count = 0;  // of a leaf

  bool is_leaf() const { return count > 0; }
  float half_area() const {
    const float x = box[3] - box[0], y = box[4] - box[1], z = box[5] - box[2];
    return x * y + y * z + z * x;
  }
};

struct Pieces {
  std::array<Piece, wide_lanes> at;
  std::size_t count = 0;
  std::span<const Piece> all() const { return {at.data(), count}; }
};

bool is_empty(const BvhChild& child) {
  return child.is_leaf() && child.count() == 0;
}
std::size_t child_count(const BvhNode& node) {
  return static_cast<std::size_t>(4 - std::count_if(std::begin(node.child), std::end(node.child), is_empty));
}

// Top down; a thread takes the places of a node's children when it begins them.
class Folding {
 public:
  Folding(const Bvh& bvh, const World& world, WideTree& tree) : bvh_(bvh), world_(world), tree_(tree) {
    tree.nodes.resize(bvh.nodes.size());  // without values: pages that are not reached cost nothing
    tree.leaves.resize(bvh.primitives.size());
    fold(0, nodes_++, 0);
    tree.nodes.resize(nodes_), tree.leaves.resize(leaves_);
  }

 private:
  /// Whether all below a child is few enough for a leaf; then the range of leaf order that it is.
  bool is_short(const BvhChild& child, std::uint32_t& first, std::uint32_t& end) const {
    if (is_empty(child)) return true;
    if (!child.is_leaf()) {
      const BvhNode& node = bvh_.nodes[child.index()];
      return std::all_of(std::begin(node.child), std::end(node.child),
                         [&](const BvhChild& c) { return is_short(c, first, end); });
    }
    first = std::min(first, child.first());
    end = std::max(end, child.first() + child.count());
    return end - first <= wide_lanes;
  }

  void append(const BvhNode& node, Pieces& pieces) const {
    for (std::size_t i = 0; i < 4; ++i) {
      if (is_empty(node.child[i])) continue;
      Piece& piece = pieces.at[pieces.count++];
      for (std::size_t row = 0; row < 6; ++row) piece.box[row] = node.bounds[row][i];
      std::uint32_t first = std::numeric_limits<std::uint32_t>::max(), end = 0;
      const bool leaf = is_short(node.child[i], first, end);
      piece.node = node.child[i].index();
      piece.first = first, piece.count = leaf ? end - first : 0;
    }
  }

  /// The largest is opened as long as its children find room.
  Pieces pieces_of(std::uint32_t index) const {
    Pieces pieces;
    append(bvh_.nodes[index], pieces);
    const auto fits = [&](const Piece& piece) {
      return !piece.is_leaf() && pieces.count - 1 + child_count(bvh_.nodes[piece.node]) <= wide_lanes;
    };
    for (;;) {
      std::size_t best = pieces.count;
      for (std::size_t i = 0; i < pieces.count; ++i)
        if (fits(pieces.at[i]) &&
            (best == pieces.count || pieces.at[i].half_area() > pieces.at[best].half_area()))
          best = i;
      if (best == pieces.count) return pieces;
      const std::uint32_t opened = pieces.at[best].node;
      pieces.at[best] = pieces.at[--pieces.count];
      append(bvh_.nodes[opened], pieces);
    }
  }

  void fold(std::uint32_t from, std::uint32_t to, int depth) {
    const Pieces pieces = pieces_of(from);
    WideNode& node = tree_.nodes[to];
    for (std::size_t i = 0; i < wide_lanes; ++i) {
      const bool used = i < pieces.count;
      for (std::size_t row = 0; row < 6; ++row)
        node.bounds[row][i] = used ? pieces.at[i].box[row] : row < 3 ? inf : -inf;
      node.child[i] = WideChild::leaf_flag;
    }
    put_order(pieces.all(), node);
    const auto put_child = [&](std::size_t i) {
      const Piece& piece = pieces.at[i];
      const std::uint32_t place = piece.is_leaf() ? leaves_++ : nodes_++;
      node.child[i] = piece.is_leaf() ? WideChild::leaf_flag | place : place;
      if (piece.is_leaf())
        put_leaf(piece, tree_.leaves[place]);
      else
        fold(piece.node, place, depth + 1);
    };
    if (depth < parallel_depth)
      tbb::parallel_for(std::size_t{0}, pieces.count, put_child);
    else
      for (std::size_t i = 0; i < pieces.count; ++i) put_child(i);
  }

  /// Nearest first by the boxes' middles along the octant's diagonal; the opposite octant's is the reverse.
  static void put_order(std::span<const Piece> pieces, WideNode& node) {
    std::fill(std::begin(node.order), std::end(node.order), 0u);
    for (unsigned octant = 0; octant < 4; ++octant) {
      std::array<std::pair<float, std::uint32_t>, wide_lanes> far;
      for (std::uint32_t i = 0; i < wide_lanes; ++i) {
        far[i] = {inf, i};
        if (i >= pieces.size()) continue;
        const auto& box = pieces[i].box;
        float sum = 0.0f;
        for (std::size_t a = 0; a < 3; ++a) {
          const float middle = box[a] + box[3 + a];
          sum += (octant >> a & 1u) != 0 ? -middle : middle;
        }
        far[i].first = sum;
      }
      std::sort(far.begin(), far.end());
      for (std::size_t i = 0; i < wide_lanes; ++i) {
        node.order[wide_lanes - 1 - i] |= far[i].second << (3 * octant);
        node.order[i] |= far[i].second << (3 * (7 - octant));
      }
    }
  }

  void put_leaf(const Piece& piece, WideLeaf& leaf) const {
    leaf.first = piece.first;
    leaf.lanes = (1u << piece.count) - 1;
    double size = 0x1p-16 * static_cast<double>(tree_.reach);
    for (std::uint32_t i = 0; i < wide_lanes; ++i) {
      std::array<double, 9> numbers;
      numbers.fill(std::numeric_limits<double>::quiet_NaN());
      if (i < piece.count && world_.is_triangle(bvh_.ids[piece.first + i])) {
        const auto& v = bvh_.primitives[piece.first + i].v;
        for (std::size_t k = 0; k < 9; ++k) {
          const std::size_t a = k % 3;
          numbers[k] = k < 3 ? v[k] - tree_.center[a] : v[k] - v[a];
          if (k >= 3) size = std::max(size, std::abs(numbers[k]));
        }
      }
      for (std::size_t k = 0; k < 9; ++k) leaf.rows[k][i] = static_cast<float>(numbers[k]);
    }
    leaf.size = float_above(size);
  }

  const Bvh& bvh_;
  const World& world_;
  WideTree& tree_;
  std::atomic<std::uint32_t> nodes_{0}, leaves_{0};
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

std::unique_ptr<const WideTree> fold_wide(const Bvh& bvh, const World& world) {
  if (bvh.nodes.empty()) return nullptr;
  auto tree = std::make_unique<WideTree>();
  tree->center = {bvh.center.x, bvh.center.y, bvh.center.z, 0.0};
  tree->reach = reach_of(bvh.nodes[0]);
  if (!(tree->reach >= 0x1p-30f && tree->reach <= 0x1p30f)) return nullptr;
  const Folding fold(bvh, world, *tree);
  return tree;
}

void WideOnDemand::fold(const Bvh& bvh, const World& world) {
  if (!begun_.exchange(true)) ready_.store(fold_wide(bvh, world).release(), std::memory_order_release);
}

std::uint64_t WideOnDemand::bytes() const {
  const WideTree* tree = ready_.load(std::memory_order_acquire);
  return tree != nullptr ? tree->bytes() : 0;
}

// Each thread counts by itself and tells now and then. Folding costs about as much time as half a ray saves,
// for each primitive.
const WideTree* WideOnDemand::count_ray(const Bvh& bvh, const World& world) {
  constexpr unsigned told_at_once = 256, least = 4096;
  thread_local unsigned untold = 0;
  if (++untold < told_at_once) return nullptr;
  untold = 0;
  if ((rays_ += told_at_once) >= least + bvh.primitives.size() / 2) fold(bvh, world);
  return ready_.load(std::memory_order_acquire);
}

}  // namespace gnomon::raytrace
