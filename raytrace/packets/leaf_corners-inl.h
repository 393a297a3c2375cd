// The corners of eight leaves' triangles, a leaf to a lane.

#if defined(GNOMON_RAYTRACE_PACKETS_LEAF_CORNERS_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_LEAF_CORNERS_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_LEAF_CORNERS_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_LEAF_CORNERS_INL_H_
#endif

#include <hwy/highway.h>

#include <span>

#include "raytrace/packets/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {

using Eight = hn::CappedTag<float, 8>;
using V8 = hn::Vec<Eight>;
constexpr Eight eight;

/// Triangles' corners as floats from the hierarchy's centre.
class LeafCorners {
 public:
  LeafCorners(const Bvh& bvh, std::span<const std::uint32_t> leaves) {
    using D = hn::CappedTag<double, 4>;
    constexpr D d;
    constexpr hn::Rebind<float, D> half;
    const Vec3& c = bvh.center;
    const double center[12] = {c.x, c.y, c.z, c.x, c.y, c.z, c.x, c.y, c.z};
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      LeafPrimitive scratch;
      const auto& v = bvh.primitive_at(leaves[i], scratch).v;
      for (std::size_t k = 0; k < 4; k += hn::Lanes(d)) {
        const auto put = [&](std::size_t from, float* to) {
          const auto p = hn::Sub(hn::LoadU(d, v.data() + from + k), hn::LoadU(d, center + from + k));
          hn::Store(hn::DemoteTo(half, p), half, to + 4 * i + k);
        };
        put(0, first_), put(4, next_);
      }
      last_[i] = static_cast<float>(v[8] - c.z);
    }
  }
  /// From lane i on: corner[k][axis] of the k-th corners.
  void get(std::size_t i, V8 (&corner)[3][3]) const {
    hn::LoadInterleaved4(eight, first_ + 4 * i, corner[0][0], corner[0][1], corner[0][2], corner[1][0]);
    hn::LoadInterleaved4(eight, next_ + 4 * i, corner[1][1], corner[1][2], corner[2][0], corner[2][1]);
    corner[2][2] = hn::Load(eight, last_ + i);
  }

 private:
  alignas(32) float first_[32] = {}, next_[32] = {}, last_[8] = {};
};

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
