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

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {

/// Leaves whose corners are brought together.
constexpr std::size_t leaves_together = 16;

/// Up to leaves_together triangles' corners as floats that count from `origin`; where there are fewer, the last one's again.
class LeafCorners {
 public:
  LeafCorners(const Bvh& bvh, std::span<const std::uint32_t> leaves, const Vec3& origin) {
    using D = hn::CappedTag<double, 4>;
    constexpr D d;
    constexpr hn::Rebind<float, D> half;
    alignas(32) const double from[4] = {origin.x, origin.y, origin.z, 0.0};
    for (std::size_t i = 0; i < leaves_together; ++i) {
      PlacedCorners scratch;
      const CornerPointers at = bvh.corners_at(leaves[std::min(i, leaves.size() - 1)], scratch);
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t a = 0; a < 4; a += hn::Lanes(d)) {
          const auto p = hn::Sub(hn::LoadU(d, at[k] + a), hn::Load(d, from + a));
          hn::Store(hn::DemoteTo(half, p), half, corner_[k] + 4 * i + a);
        }
    }
  }
  /// From lane i on: corner[k][axis] of the k-th corners.
  void get(std::size_t i, V (&corner)[3][3]) const {
    V nothing;
    for (std::size_t k = 0; k < 3; ++k)
      hn::LoadInterleaved4(f, corner_[k] + 4 * i, corner[k][0], corner[k][1], corner[k][2], nothing);
  }

 private:
  alignas(64) float corner_[3][4 * leaves_together];
};

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
