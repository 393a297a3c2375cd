// What may lie between a point and a box. These are the leaves of the wide tree that a shaft of segments
// passes (Haines and Wallace 1994, "Shaft culling for efficient ray-traced radiosity").
#pragma once

#include <array>
#include <span>

#include "raytrace/bvh/wide_tree.h"

namespace gnomon::raytrace {

/// The points origin + t d for t in [0, 1], or [0, infinity) if endless, and every d within [low, high].
struct Shaft {
  Vec3 origin, low, high;
  bool endless = false;
};

/// Holds the leaves whose boxes the shaft may intersect; no other primitive of the tree lies in it, not by 2^-22 of the
/// tree's size and of the origin's distance from its centre. For a kept instance the leaves are the mesh's, in the mesh's
/// space.
class ShaftLeaves {
 public:
  static constexpr std::size_t most = 24;
  std::span<const LeafRange> ranges() const { return {range_.data(), count_}; }
  /// Returns false where there is no room.
  bool add(LeafRange range) {
    if (count_ == most) return false;
    range_[count_++] = range;
    return true;
  }

 private:
  std::array<LeafRange, most> range_;
  std::size_t count_ = 0;
};

/// Returns false where there are too many leaves, or the shaft is out of the floats' range, the world's or an instance's.
bool leaves_in_shaft(const WideTree& tree, const Shaft& shaft, ShaftLeaves& found);

}  // namespace gnomon::raytrace
