#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packets/bin_cover.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <bit>

#include "raytrace/packets/bin_cover.h"
#include "raytrace/packets/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {

/// The most of a linear function over a row of bins: its part in v is the same for all.
struct RowFunction {
  float u, in_v;
  const float* most_u;
  RowFunction(const float (&n)[3], const BinLines& columns, float v_lo, float v_hi)
      : u(n[0]), most_u(n[0] > 0.0f ? columns.hi.data() : columns.lo.data()) {
    const auto one = hn::CappedTag<float, 1>();
    in_v = hn::GetLane(
        hn::MulAdd(hn::Set(one, n[1]), hn::Set(one, n[1] > 0.0f ? v_hi : v_lo), hn::Set(one, n[2])));
  }
  V at(std::size_t x) const { return hn::MulAdd(all(u), hn::LoadU(f, most_u + x), all(in_v)); }
};

std::size_t cover_kernel(const PrimitiveEdges& p, std::uint32_t leaf, float nearest, const BinLines& columns,
                         const BinLines& rows, const BinRect& rect, CoveredBin* out) {
  const std::size_t stride = columns.lo.size() - packet_rays;
  const auto x0 = static_cast<std::size_t>(rect.x0), end = static_cast<std::size_t>(rect.x1) + 1;
  const float u_size = std::max(std::abs(columns.lo[x0]), std::abs(columns.hi[end - 1]));
  const bool by_depth = !(p.depth_floor > -1e30f) && p.depth_error < inf;
  std::size_t count = 0;
  for (auto y = static_cast<std::size_t>(rect.y0); y <= static_cast<std::size_t>(rect.y1); ++y) {
    const float lo = rows.lo[y], hi = rows.hi[y];
    const RowFunction edge[3] = {
        {p.edge[0], columns, lo, hi}, {p.edge[1], columns, lo, hi}, {p.edge[2], columns, lo, hi}};
    const RowFunction depth(p.reciprocal_depth, columns, lo, hi);
    const float v_size = std::max(std::abs(lo), std::abs(hi));
    constexpr float rounding = 0x1p-18f;
    const float slack =
        p.depth_error * (1.0f + rounding) +
        rounding * (std::abs(p.reciprocal_depth[0]) * u_size + std::abs(p.reciprocal_depth[1]) * v_size +
                    std::abs(p.reciprocal_depth[2]));
    for (std::size_t x = x0; x < end; x += lanes()) {
      const V least = hn::Min(edge[0].at(x), hn::Min(edge[1].at(x), edge[2].at(x)));
      unsigned covered = bits_of(hn::Not(hn::Lt(least, all(-p.edge_error))));
      if (end - x < lanes()) covered &= (1u << (end - x)) - 1;
      if (covered == 0) continue;
      V near = all(nearest);
      if (by_depth) near = hn::Min(near, hn::Add(depth.at(x), all(slack)));
      alignas(64) float key[packet_rays];
      hn::Store(near, f, key);
      for (; covered != 0; covered &= covered - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(covered));
        out[count++] = {static_cast<std::uint32_t>(y * stride + x + i), leaf, key[i], 0};
      }
    }
  }
  return count;
}

void place_kernel(const BinAxis& axis, double slack, const float* min, const float* max, BinSpans& out) {
  constexpr hn::CappedTag<double, 8> d;
  constexpr hn::Rebind<float, decltype(d)> half;
  constexpr hn::Rebind<std::int32_t, decltype(d)> places;
  const auto set = [&](double v) { return hn::Set(d, v); };
  const double per_fine = 256.0 / (axis.width * axis.per_bin);
  const double start = 0.5 * (axis.lo + axis.hi - axis.width * (axis.per_bin == 1 ? 1.0 : 0.0));
  const auto per_width = set(1.0 / axis.width), per_bin = set(1.0 / axis.per_bin),
             far = set(256.0 * (axis.bins() + 1));
  for (std::size_t i = 0; i < 8; i += hn::Lanes(d)) {
    const auto low = hn::PromoteTo(d, hn::Load(half, min + i)),
               high = hn::PromoteTo(d, hn::Load(half, max + i));
    const auto store = [&](auto v, std::int32_t* to) { hn::Store(hn::DemoteTo(places, v), places, to + i); };
    const auto a = hn::Mul(hn::Sub(low, set(axis.hi + slack)), per_width);
    const auto b = hn::Mul(hn::Sub(high, set(axis.lo - slack)), per_width);
    const auto begin = hn::Min(hn::Max(hn::Ceil(a), set(0.0)), set(axis.count));
    const auto end = hn::Min(hn::Max(hn::Floor(b), set(-1.0)), set(axis.count - 1.0));
    const auto some = hn::Le(begin, end);
    // Steps are whole numbers: half of one more keeps the quotient off the next bin.
    const auto bin = [&](auto step) { return hn::Floor(hn::Mul(hn::Add(step, set(0.5)), per_bin)); };
    store(hn::IfThenElse(some, bin(begin), set(1.0)), out.first);
    store(hn::IfThenElseZero(some, bin(end)), out.last);
    const auto fine = [&](auto v) {
      return hn::Min(hn::Max(hn::Mul(hn::Sub(v, set(start)), set(per_fine)), hn::Neg(far)), far);
    };
    store(hn::Sub(hn::Floor(fine(low)), set(1.0)), out.low),
        store(hn::Add(hn::Ceil(fine(high)), set(1.0)), out.high);
  }
}

void rank_kernel(const float* numbers, std::size_t count, std::uint32_t* rank) {
  const auto one = hn::Set(ids, 1u);
  for (std::size_t first = 0; first < count; first += lanes()) {
    const V these = hn::LoadU(f, numbers + first);
    const auto these_places = hn::Iota(ids, static_cast<std::uint32_t>(first));
    auto before = hn::Zero(ids);
    const auto add = [&](M some) {
      before = hn::Add(before, hn::IfThenElseZero(hn::RebindMask(ids, some), one));
    };
    const std::size_t end = std::min(first + lanes(), count);
    for (std::size_t i = 0; i < first; ++i) add(hn::Ge(all(numbers[i]), these));
    for (std::size_t i = first; i < end; ++i) {
      const auto ahead = hn::RebindMask(f, hn::Lt(hn::Set(ids, static_cast<std::uint32_t>(i)), these_places));
      add(hn::Or(hn::Gt(all(numbers[i]), these), hn::And(hn::Eq(all(numbers[i]), these), ahead)));
    }
    for (std::size_t i = end; i < count; ++i) add(hn::Gt(all(numbers[i]), these));
    hn::StoreU(before, ids, rank + first);
  }
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(cover_kernel);
HWY_EXPORT(place_kernel);
HWY_EXPORT(rank_kernel);

void rank_falling(const float* numbers, std::size_t count, std::uint32_t* rank) {
  HWY_DYNAMIC_DISPATCH(rank_kernel)(numbers, count, rank);
}

void place_eight(const BinAxis& axis, double slack, const float* min, const float* max, BinSpans& out) {
  HWY_DYNAMIC_DISPATCH(place_kernel)(axis, slack, min, max, out);
}

std::size_t cover_bins(const PrimitiveEdges& primitive, std::uint32_t leaf, float nearest,
                       const BinLines& columns, const BinLines& rows, const BinRect& rect, CoveredBin* out) {
  return HWY_DYNAMIC_DISPATCH(cover_kernel)(primitive, leaf, nearest, columns, rows, rect, out);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
