// Writes a tile's receivers as they are found, several pixels at a time: in double, quantised, or both.

#if defined(GNOMON_RAYTRACE_PACKETS_RECEIVER_WRITER_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_RECEIVER_WRITER_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_RECEIVER_WRITER_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_RECEIVER_WRITER_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

#include "raytrace/packets/double_lanes-inl.h"
#include "raytrace/packets/receivers.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE::doubles {

/// SurfacePoint, as many as there are lanes.
struct Points {
  V3 position, error, normal;
  V b1, b2;
  hn::Vec<Ids> ids;
};

/// The doubles of a SurfacePoint, in the order of its members: three times four.
constexpr std::size_t point_doubles = 12;
static_assert(offsetof(SurfacePoint, position) == 0 && offsetof(SurfacePoint, position_error) == 24 &&
              offsetof(SurfacePoint, normal) == 48 && offsetof(SurfacePoint, primitive) == 72 &&
              offsetof(SurfacePoint, barycentric) == 80 &&
              sizeof(SurfacePoint) == point_doubles * sizeof(double) && alignof(SurfacePoint) == 32 &&
              std::endian::native == std::endian::little);

class ReceiverWriter {
 public:
  explicit ReceiverWriter(const ReceiverSinks& sinks) : sinks_(sinks) {
    for (int a = 0; a < 3; ++a) low_[a] = all(infinity), high_[a] = all(-infinity);
  }

  /// The points of lanes from `lane` of the tile on, of which the `sound` ones are written; others may have been already.
  void put(const Points& p, unsigned sound, std::size_t lane) {
    if (sinks_.quantised != nullptr) draft(p, sound, lane);
    if (sinks_.points != nullptr) store(p, sound, lane);
  }

  /// A packet that shows nothing.
  void store_nothing(std::size_t packet) const {
    static constexpr SurfacePoint nothing{};
    const auto* from = reinterpret_cast<const double*>(&nothing);
    for (std::size_t i = 0; i < packet_rays; ++i) {
      auto* to = reinterpret_cast<double*>(place_of(packet * packet_rays + i));
      for (std::size_t j = 0; j < point_doubles; j += hn::Lanes(four))
        hn::Stream(hn::Load(four, from + j), four, to + j);
    }
  }

  void finish() const {
    if (sinks_.quantised == nullptr) return;
    Aabb& bounds = sinks_.draft->bounds;
    for (int a = 0; a < 3; ++a) {
      bounds.min[a] = std::min(bounds.min[a], hn::GetLane(hn::MinOfLanes(d, low_[a])));
      bounds.max[a] = std::max(bounds.max[a], hn::GetLane(hn::MaxOfLanes(d, high_[a])));
    }
  }

 private:
  static constexpr hn::CappedTag<double, 4> four{};
  /// Pixels of a packet's row that are written together.
  static constexpr std::size_t row_pixels = std::min<std::size_t>(4, hn::MaxLanes(d));

  SurfacePoint* place_of(std::size_t lane) const {
    const TilePixel pixel = tile_pixel(lane);
    return sinks_.points + static_cast<std::size_t>(pixel.y) * sinks_.stride + pixel.x;
  }

  void store(const Points& p, unsigned sound, std::size_t lane) const {
    constexpr hn::RebindToUnsigned<D> u64;
    const V id = hn::BitCast(d, hn::PromoteTo(u64, p.ids));
    alignas(64) double part[3][4 * 8];
    hn::StoreInterleaved4(p.position.x, p.position.y, p.position.z, p.error.x, d, part[0]);
    hn::StoreInterleaved4(p.error.y, p.error.z, p.normal.x, p.normal.y, d, part[1]);
    hn::StoreInterleaved4(p.normal.z, id, p.b1, p.b2, d, part[2]);
    constexpr unsigned whole = (1u << row_pixels) - 1;
    for (std::size_t i = 0; i < hn::Lanes(d); i += row_pixels) {
      SurfacePoint* row = place_of(lane + i);
      unsigned left = sound >> i & whole;
      if (left == whole && sinks_.non_temporal) {
        for (std::size_t k = 0; k < row_pixels; ++k)
          copy(part, i + k, row + k, [](auto v, auto tag, double* to) { hn::Stream(v, tag, to); });
        continue;
      }
      for (; left != 0; left &= left - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(left));
        copy(part, i + k, row + k, [](auto v, auto tag, double* to) { hn::Store(v, tag, to); });
      }
    }
  }
  template <class Store>
  static void copy(const double (&part)[3][4 * 8], std::size_t i, SurfacePoint* point, const Store& store) {
    auto* to = reinterpret_cast<double*>(point);
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t j = 0; j < 4; j += hn::Lanes(four))
        store(hn::Load(four, part[k] + 4 * i + j), four, to + 4 * k + j);
  }

  void draft(const Points& p, unsigned sound, std::size_t lane) {
    constexpr hn::Rebind<float, D> half;
    TileDraft& draft = *sinks_.draft;
    const M here = mask_of(sound);
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(sound)};
    const auto here_of_units = hn::LoadMaskBits(Units(), bytes);
    const auto store_along = [&](std::size_t axis, V position, V normal) {
      blend_into(d, draft.position[axis] + lane, here, position);
      blend_into(Units(), draft.normal[axis] + lane, here_of_units, in_units(hn::DemoteTo(half, normal)));
      low_[axis] = hn::Min(low_[axis], hn::IfThenElse(here, position, low_[axis]));
      high_[axis] = hn::Max(high_[axis], hn::IfThenElse(here, position, high_[axis]));
    };
    store_along(0, p.position.x, p.normal.x);
    store_along(1, p.position.y, p.normal.y);
    store_along(2, p.position.z, p.normal.z);
    blend_into(Ids(), draft.source + lane, hn::LoadMaskBits(Ids(), bytes), p.ids);
    sinks_.quantised->present[lane / packet_rays] |=
        static_cast<std::uint16_t>(sound << (lane % packet_rays));
  }
  /// A masked store takes longer on some processors than all that is done here.
  template <class Tag, class Mask, class Vector, class T>
  static void blend_into(Tag tag, T* to, Mask here, Vector values) {
    hn::Store(hn::IfThenElse(here, values, hn::Load(tag, to)), tag, to);
  }

  const ReceiverSinks& sinks_;
  V low_[3], high_[3];
};

}  // namespace gnomon::raytrace::HWY_NAMESPACE::doubles
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
