// The hierarchy as single rays walk it: nodes of sixteen children and leaves of up to sixteen triangles in
// float, folded from the default hierarchy (Wald et al. 2008, "Getting rid of packets") when enough single
// rays have come to pay for it. The floats only say which triangles a ray surely misses; the doubles decide.
// Sixteen, for a step down the tree waits for the step before: fewer are faster than narrow ones.
#pragma once

#include <atomic>
#include <memory>

#include "raytrace/bvh.h"

namespace gnomon::raytrace {

inline constexpr std::size_t node_lanes = 16, leaf_lanes = 16, leaf_corners = 16;

/// A node's index, or a leaf's with the top bit set.
struct WideChild {
  std::uint32_t bits;
  static constexpr std::uint32_t leaf_flag = 0x80000000u;
  bool is_leaf() const { return (bits & leaf_flag) != 0; }
  std::uint32_t index() const { return bits & ~leaf_flag; }
};

/// bounds as in BvhNode. order: lane i has in bits 4k..4k+3 the child that rays of octant k (bit a: backwards
/// along axis a) visit as the i-th from the end.
struct alignas(64) WideNode {
  float bounds[6][node_lanes];
  std::uint32_t child[node_lanes];
  std::uint32_t order[node_lanes];
};

/// Triangles that share their corners: these by axis, counted from `anchor`, and of each triangle four bits
/// for each of its three. Four lines of memory, so that what a ray reads here and there stays in the caches.
struct alignas(64) WideLeaf {
  float corner[3][leaf_corners];
  std::uint16_t index[leaf_lanes];
  float anchor[3];       ///< from the tree's centre
  float extent;          ///< no corner's coordinate is above this
  float size_13;         ///< 13 L: no component of an edge is above L, and L is not below 2^-16 of `reach`
  std::uint32_t first;   ///< position in leaf order of the first
  std::uint16_t lanes;   ///< bit i: a triangle
  std::uint16_t shapes;  ///< bit i: a shape, of which these floats say nothing
};

struct WideTree {
  HugeVector<WideNode> nodes;  ///< node 0 is the root
  HugeVector<WideLeaf> leaves;
  const Bvh* origin = nullptr;                 ///< what was folded; it must outlive the tree
  alignas(32) std::array<double, 4> center{};  ///< all floats count from here; the last is 0
  bool plain =
      false;          ///< leaves' corners are the world's, rounded: for the textbook's test (Precision::fast)
  float reach = 0.0;  ///< no coordinate of a box is above this
  std::uint64_t bytes() const { return nodes.size() * sizeof(WideNode) + leaves.size() * sizeof(WideLeaf); }
};

/// Nothing where the floats' bounds would not hold: no tree, or a scene larger than 2^30 or smaller than
/// 2^-26.
std::unique_ptr<const WideTree> fold_wide(const Bvh& bvh, const World& world, bool plain = false);

/// Folds the tree when so many rays have asked for it that it pays. Any number of threads may ask.
class WideOnDemand {
 public:
  explicit WideOnDemand(bool plain = false) : plain_(plain) {}
  ~WideOnDemand() { delete ready_.load(); }
  /// Null until it is there; counts the ray.
  const WideTree* for_ray(const Bvh& bvh, const World& world) {
    const WideTree* tree = ready_.load(std::memory_order_acquire);
    return tree != nullptr ? tree : count_ray(bvh, world);
  }
  /// Folds now, unless it has been or is being done.
  void fold(const Bvh& bvh, const World& world);
  std::uint64_t bytes() const;

 private:
  const WideTree* count_ray(const Bvh& bvh, const World& world);
  bool plain_;
  std::atomic<const WideTree*> ready_{nullptr};
  std::atomic<std::uint64_t> rays_{0};
  std::atomic<bool> begun_{false};
};

}  // namespace gnomon::raytrace
