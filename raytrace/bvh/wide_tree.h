// The hierarchy as single rays traverse it: nodes of sixteen children and leaves of up to sixteen triangles
// in float. It is collapsed from the default hierarchy (Wald et al. 2008, "Getting rid of packets") when
// enough single rays have come to pay for it. The floats only say which triangles a ray surely misses; the
// doubles decide. Sixteen, for a step down the tree waits for the step before: fewer are faster than narrow
// ones.
#pragma once

#include <array>
#include <atomic>
#include <cstring>
#include <limits>
#include <memory>
#include <span>

#include "raytrace/bvh/bvh.h"

namespace gnomon::raytrace {

inline constexpr std::size_t node_lanes = 16, leaf_lanes = 16, leaf_corners = 15;

/// A node's index, a leaf's with the top bit set, or a kept instance's with the next one set as well.
struct WideChild {
  std::uint32_t bits;
  static constexpr std::uint32_t leaf_flag = 0x80000000u, instance_flag = 0x40000000u;
  static constexpr std::uint32_t index_mask = instance_flag - 1;
  bool is_leaf() const { return (bits & leaf_flag) != 0; }  ///< or an instance
  bool is_instance() const { return (bits & instance_flag) != 0; }
  std::uint32_t index() const { return bits & index_mask; }
};

/// bounds as in BvhNode. order[k]: the children as rays of octant k (bit a: backwards along axis a) visit them;
/// those of the opposite octant, 7 - k, the other way round.
struct alignas(64) WideNode {
  float bounds[6][node_lanes];
  std::uint32_t child[node_lanes];
  std::uint8_t order[4][node_lanes];
};

/// The triangles of a leaf share their corners, numbered from 1. Triangle i has the number of its k-th in the
/// four bits from 4 (i / 2) on of index[k][i % 2], from where a vector unpacks all at once.
struct LeafTriangles {
  std::uint32_t index[3][2];
  std::uint32_t range;  ///< position in leaf order, 27 bits; count - 1, 4 bits; whether all are shapes
  std::uint32_t first() const { return range & BvhChild::first_mask; }
  std::uint32_t last() const { return range >> 27 & 15u; }
  unsigned lanes() const { return (2u << last()) - 1; }
  bool shapes() const { return (range >> 31) != 0; }  ///< of which the corners say nothing
};

/// Corners in sixteen bits: anchor + corner * step, to the nearest. Anchor, step and size are floats of which
/// only the upper halves are stored; the lower half of each is what stands before it, whatever that is, and
/// the corners are made to fit. Two lines of memory, so that what a ray reads here and there stays in the
/// caches.
struct alignas(64) WideLeaf {
  LeafTriangles triangles;
  std::uint16_t half[5];  ///< of anchor (from the tree's centre), step, size_13
  std::int16_t corner[3][leaf_corners];

  float value(std::size_t i) const {
    float value;
    std::memcpy(&value, reinterpret_cast<const char*>(half + i) - sizeof(std::uint16_t), sizeof value);
    return value;
  }
  float anchor(std::size_t axis) const { return value(axis); }
  float step() const { return value(3); }
  /// 13 L: no component of an edge is above L, and L is not below 2^-16 of `reach`.
  float size_13() const { return value(4); }
};
static_assert(sizeof(WideLeaf) == 128);

/// The world's corners, rounded: for the textbook's test (Precision::fast). corner[a][0] is unused.
struct alignas(64) PlainLeaf {
  float corner[3][leaf_corners + 1];
  LeafTriangles triangles;
};

struct WideTree;

/// What brings rays into the space of a kept instance's mesh (raytrace/bvh/wide_instances.h).
struct WideInstance {
  Mat3 object_from_world;  ///< but for the translation
  Vec3 translation;        ///< of the instance, in the world
  double inverse_norm;  ///< by how much object_from_world makes vectors longer at most, in the maximum norm
  /// How far off a ray's origin is there, beyond what the size of its coordinates makes of it.
  double error;
  const WideTree* mesh;                      ///< in object space; null: the bounds would not hold
  std::uint32_t first_leaf, first_triangle;  ///< as in BvhInstance
};

struct WideTree {
  HugeVector<WideNode> nodes;  ///< node 0 is the root, in the world above all instances, too
  HugeVector<WideLeaf> leaves;
  HugeVector<PlainLeaf> plain_leaves;          ///< instead of these, where `plain`
  const Bvh* origin = nullptr;                 ///< what was collapsed; it must outlive the tree
  alignas(32) std::array<double, 4> center{};  ///< all floats count from here; the last is 0
  bool plain = false;
  float reach = 0.0;                                   ///< no coordinate of a box is above this
  std::vector<std::unique_ptr<const WideTree>> trees;  ///< as Bvh::trees, in object space
  std::vector<WideInstance> instances;                 ///< as Bvh::instances
  std::uint64_t bytes() const {
    std::uint64_t sum = instances.size() * sizeof(WideInstance);
    for (const auto& tree : trees) sum += tree != nullptr ? tree->bytes() : 0;
    return sum + nodes.size() * sizeof(WideNode) + leaves.size() * sizeof(WideLeaf) +
           plain_leaves.size() * sizeof(PlainLeaf);
  }
};

/// Nothing where the floats' bounds would not hold: no tree, or a scene larger than 2^30 or smaller than
/// 2^-26; nor `plain` with kept instances, for the textbook's floats are the world's.
std::unique_ptr<const WideTree> collapse_bvh(const Bvh& bvh, const World& world, bool plain = false);

/// Collapses the tree when so many rays have asked for it that it pays. Any number of threads may ask. There is
/// none where memory does not suffice for it.
class WideOnDemand {
 public:
  explicit WideOnDemand(bool plain = false) : plain_(plain) {}
  ~WideOnDemand() { delete ready_.load(); }
  /// Null until it is there; counts the ray.
  const WideTree* for_ray(const Bvh& bvh, const World& world) {
    const WideTree* tree = ready_.load(std::memory_order_acquire);
    return tree != nullptr ? tree : count_ray(bvh, world);
  }
  /// Collapses now, unless it has been or is being done.
  void collapse(const Bvh& bvh, const World& world);
  std::uint64_t bytes() const;
  /// What collapsing took; 0: it has not been done.
  double collapse_ms() const { return collapse_ms_; }

 private:
  const WideTree* count_ray(const Bvh& bvh, const World& world);
  /// Threads count apart, so that they do not wait for one another; two may share a count.
  struct alignas(64) RayCount {
    std::atomic<std::uint32_t> rays{0};
  };

  bool plain_;
  std::atomic<const WideTree*> ready_{nullptr};
  std::array<RayCount, 16> counts_;
  std::atomic<std::uint64_t> rays_{0};  ///< of them what has been told
  std::atomic<bool> begun_{false};
  std::atomic<double> collapse_ms_{0.0};
};

// How the wide tree's nodes and leaves are written: boxes in bytes that hold what they stand for, corners in
// sixteen bits. Sources: Ylitalo et al. 2017, "Efficient incoherent ray traversal on GPUs through compressed
// wide BVHs", section 3.2; Benthin et al. 2018, "Compressed-leaf bounding volume hierarchies", section 3.

struct WideBox {
  static constexpr float inf = std::numeric_limits<float>::infinity();
  std::array<float, 6> at{inf, inf, inf, -inf, -inf, -inf};  // as a column of BvhNode::bounds
  void grow(const WideBox& b) {
    for (std::size_t a = 0; a < 3; ++a)
      at[a] = std::min(at[a], b.at[a]), at[3 + a] = std::max(at[3 + a], b.at[3 + a]);
  }
  float half_area() const {
    const float x = at[3] - at[0], y = at[4] - at[1], z = at[5] - at[2];
    return x * y + y * z + z * x;
  }
};

/// Corners counted from the tree's centre, each within a last place of the box; L as in WideLeaf.
void pack_corners(const WideBox& box, std::span<const std::array<double, 3>> corners, double longest_edge,
                  float reach, WideLeaf& leaf);

}  // namespace gnomon::raytrace
