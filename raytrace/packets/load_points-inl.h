// Points of three doubles from as many places as a vector has lanes, by coordinates. They meet in registers: by way of
// memory they would be read in other parts than they have just been written in, for which a processor waits.

#if defined(GNOMON_RAYTRACE_PACKETS_LOAD_POINTS_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_LOAD_POINTS_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_LOAD_POINTS_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_LOAD_POINTS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "scene/math.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using PointTag = hn::CappedTag<double, 8>;
using OffsetTag = hn::CappedTag<float, 16>;

#if HWY_TARGET == HWY_SCALAR

template <class From>
HWY_INLINE void load_points(const From& from, hn::Vec<PointTag> (&point)[3]) {
  for (std::size_t a = 0; a < 3; ++a) point[a] = hn::Set(PointTag(), from(0)[a]);
}
template <class From>
HWY_INLINE void load_offsets(const Vec3& origin, const From& from, hn::Vec<OffsetTag> (&offset)[3]) {
  for (int a = 0; a < 3; ++a) offset[a] = hn::Set(OffsetTag(), static_cast<float>(from(0)[a] - origin[a]));
}

#else

/// from(lane): where a point's numbers are; a fourth may be read behind them.
template <class From>
HWY_INLINE void load_points(const From& from, hn::Vec<PointTag> (&point)[3]) {
  constexpr PointTag d;
#if HWY_MAX_BYTES == 16
  const auto first = hn::LoadU(d, from(0)), second = hn::LoadU(d, from(1));
  point[0] = hn::InterleaveLower(d, first, second), point[1] = hn::InterleaveUpper(d, first, second);
  point[2] = hn::InterleaveLower(d, hn::LoadU(d, from(0) + 2), hn::LoadU(d, from(1) + 2));
#else
  const auto row = [&](std::size_t lane) {  // of this one, and of that four behind it where there are eight
#if HWY_MAX_BYTES == 32
    return hn::LoadU(d, from(lane));
#else
    constexpr hn::Half<PointTag> half;
    return hn::Combine(d, hn::LoadU(half, from(lane + 4)), hn::LoadU(half, from(lane)));
#endif
  };
  const auto row0 = row(0), row1 = row(1), row2 = row(2), row3 = row(3);
  const auto xz0 = hn::InterleaveLower(d, row0, row1), xz2 = hn::InterleaveLower(d, row2, row3);
  const auto y0 = hn::InterleaveUpper(d, row0, row1), y2 = hn::InterleaveUpper(d, row2, row3);
  point[0] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(xz2), xz0);
  point[1] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(y2), y0);
  point[2] = hn::OddEvenBlocks(xz2, hn::SwapAdjacentBlocks(xz0));
#endif
}

/// Loads points as floats that count from `origin`.
template <class From>
HWY_INLINE void load_offsets(const Vec3& origin, const From& from, hn::Vec<OffsetTag> (&offset)[3]) {
  constexpr OffsetTag f;
  alignas(32) const double origins[4] = {origin.x, origin.y, origin.z, 0.0};
  constexpr hn::CappedTag<double, 4> four;
#if HWY_MAX_BYTES == 16
  const auto row = [&](std::size_t lane) {
    constexpr hn::Half<OffsetTag> half;
    const auto part = [&](std::size_t a) {
      return hn::DemoteTo(half, hn::Sub(hn::LoadU(four, from(lane) + a), hn::Load(four, origins + a)));
    };
    return hn::Combine(f, part(2), part(0));
  };
#elif HWY_MAX_BYTES == 32
  const auto row = [&](std::size_t lane) {  // of this one and of that four behind it
    constexpr hn::Half<OffsetTag> half;
    const auto part = [&](std::size_t at) {
      return hn::DemoteTo(half, hn::Sub(hn::LoadU(four, from(at)), hn::Load(four, origins)));
    };
    return hn::Combine(f, part(lane + 4), part(lane));
  };
#else
  const auto row = [&](std::size_t lane) {  // of this one and of those four, eight and twelve behind it
    constexpr PointTag d;
    constexpr hn::Half<OffsetTag> half;
    const auto subtrahend = hn::Combine(d, hn::Load(four, origins), hn::Load(four, origins));
    const auto part = [&](std::size_t at) {
      const auto points = hn::Combine(d, hn::LoadU(four, from(at + 4)), hn::LoadU(four, from(at)));
      return hn::DemoteTo(half, hn::Sub(points, subtrahend));
    };
    return hn::Combine(f, part(lane + 8), part(lane));
  };
#endif
  const auto row0 = row(0), row1 = row(1), row2 = row(2), row3 = row(3);
  const auto xy0 = hn::InterleaveLower(f, row0, row2), xy1 = hn::InterleaveLower(f, row1, row3);
  const auto z0 = hn::InterleaveUpper(f, row0, row2), z1 = hn::InterleaveUpper(f, row1, row3);
  offset[0] = hn::InterleaveLower(f, xy0, xy1), offset[1] = hn::InterleaveUpper(f, xy0, xy1);
  offset[2] = hn::InterleaveLower(f, z0, z1);
}

#endif

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
