// How the wide tree's nodes and leaves are written: boxes in bytes that hold what they stand for, corners in
// sixteen bits (Ylitalo et al. 2017, "Efficient incoherent ray traversal on GPUs through compressed wide
// BVHs", section 3.2; Benthin et al. 2018, "Compressed-leaf bounding volume hierarchies", section 3).
#pragma once

#include <limits>
#include <span>

#include "raytrace/bvh/wide_tree.h"

namespace gnomon::raytrace {

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
