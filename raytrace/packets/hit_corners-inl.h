// The triangles that several pixels show.

#if defined(GNOMON_RAYTRACE_PACKETS_HIT_CORNERS_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_HIT_CORNERS_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_HIT_CORNERS_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_HIT_CORNERS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstdint>

#include "raytrace/packets/double_lanes-inl.h"
#include "raytrace/packets/load_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE::doubles {

/// Returns the lanes that show a triangle.
inline unsigned on_triangles(const Bvh& bvh, const std::uint32_t* leaf) {
  constexpr Ids ids;
  return mask_bits(ids, hn::Lt(hn::LoadU(ids, leaf), hn::Set(ids, bvh.leaf_count())));
}

/// The corners of as many pixels' triangles as there are lanes; often these are one and the same.
class HitCorners {
 public:
  V3 corner[3] = {all(Vec3(0.0)), all(Vec3(0.0)), all(Vec3(0.0))};

  /// Returns the ids of the primitives; of lanes that show none any.
  hn::Vec<Ids> ids() const { return hn::Load(Ids(), ids_); }

  /// `known`, not 0: the lanes that show a triangle; the others get one of those. False: nothing has changed.
  bool load(const Bvh& bvh, const std::uint32_t* leaf, unsigned known) {
    constexpr Ids tag;
    const auto first = leaf[std::countr_zero(known)];
    const bool same = hn::AllTrue(tag, hn::Eq(hn::LoadU(tag, leaf), hn::Set(tag, first)));
    if (same && first == only_) return false;
    only_ = same ? first : nothing_hit;
    PlacedCorners scratch;
    const CornerPointers one = bvh.corners_at(first, scratch);
    hn::Store(hn::Set(tag, bvh.id_at(first)), tag, ids_);
    if (same)
      for (std::size_t k = 0; k < 3; ++k) corner[k] = {all(one[k][0]), all(one[k][1]), all(one[k][2])};
    else
      load_each(bvh, leaf, known, one);
    return true;
  }

 private:
  void load_each(const Bvh& bvh, const std::uint32_t* leaf, unsigned known, const CornerPointers& other) {
    PlacedCorners scratch[hn::MaxLanes(d)];
    CornerPointers at[hn::MaxLanes(d)];
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
      at[i] = other;
      if ((known >> i & 1) != 0) at[i] = bvh.corners_at(leaf[i], scratch[i]), ids_[i] = bvh.id_at(leaf[i]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      V point[3];
      load_points([&](std::size_t i) { return at[i][k]; }, point);
      corner[k] = {point[0], point[1], point[2]};
    }
  }

  std::uint32_t only_ = nothing_hit;  ///< what all lanes show
  alignas(32) std::uint32_t ids_[8] = {};
};

/// A packet's triangles on their way to the cache; where all are one they are there.
inline void prefetch(const Bvh& bvh, const std::uint32_t* leaf) {
  if (leaf[0] == leaf[packet_rays - 1]) return;
  const std::uint32_t count = bvh.leaf_count();
  for (std::size_t i = 0; i < packet_rays; ++i) {
    if (leaf[i] < count) bvh.prefetch(leaf[i]);
  }
}

}  // namespace gnomon::raytrace::HWY_NAMESPACE::doubles
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
