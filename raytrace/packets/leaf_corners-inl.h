// The corners of sixteen leaves' triangles, a leaf to a lane.

#if defined(GNOMON_RAYTRACE_PACKETS_LEAF_CORNERS_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_LEAF_CORNERS_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_LEAF_CORNERS_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_LEAF_CORNERS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <span>

#include "raytrace/packets/lanes-inl.h"
#include "raytrace/packets/load_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {

/// Leaves whose corners are brought together.
constexpr std::size_t leaves_together = 16;

/// Up to leaves_together triangles' corners as floats that count from `origin`; where there are fewer, the last one's again.
class LeafCorners {
 public:
  LeafCorners(const Bvh& bvh, std::span<const std::uint32_t> leaves, const Vec3& origin) : origin_(origin) {
    for (std::size_t i = 0; i < leaves_together; ++i)
      at_[i] = bvh.corners_at(leaves[std::min(i, leaves.size() - 1)], placed_[i]);
  }
  /// From lane i on: corner[k][axis] of the k-th corners.
  void get(std::size_t i, V (&corner)[3][3]) const {
    for (std::size_t k = 0; k < 3; ++k)
      load_offsets(
          origin_, [&](std::size_t lane) { return at_[i + lane][k]; }, corner[k]);
  }

 private:
  Vec3 origin_;
  CornerPointers at_[leaves_together];
  PlacedCorners placed_[leaves_together];  ///< of kept instances' leaves
};

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
