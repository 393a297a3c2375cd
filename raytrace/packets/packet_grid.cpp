#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packets/packet_grid.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "raytrace/packets/lanes-inl.h"
#include "raytrace/packets/packet_grid.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {

void place_kernel(const PacketAxis& axis, double slack, const float* min, const float* max,
                  PacketSpans& out) {
  constexpr hn::CappedTag<double, 8> d;
  constexpr hn::Rebind<float, decltype(d)> half;
  constexpr hn::Rebind<std::int32_t, decltype(d)> places;
  const auto set = [&](double v) { return hn::Set(d, v); };
  const auto per_width = set(1.0 / axis.width), per_packet = set(1.0 / PacketAxis::per_packet);
  for (std::size_t i = 0; i < PacketSpans::together; i += hn::Lanes(d)) {
    const auto low = hn::PromoteTo(d, hn::Load(half, min + i)),
               high = hn::PromoteTo(d, hn::Load(half, max + i));
    const auto store = [&](auto v, std::int32_t* to) { hn::Store(hn::DemoteTo(places, v), places, to + i); };
    const auto a = hn::Mul(hn::Sub(low, set(axis.first + slack)), per_width);
    const auto b = hn::Mul(hn::Sub(high, set(axis.first - slack)), per_width);
    const auto begin = hn::Min(hn::Max(hn::Ceil(a), set(0.0)), set(axis.pixels));
    const auto end = hn::Min(hn::Max(hn::Floor(b), set(-1.0)), set(axis.pixels - 1.0));
    const auto some = hn::Le(begin, end);
    // Pixels are whole numbers: half of one more keeps the quotient off the next packet.
    const auto packet = [&](auto pixel) { return hn::Floor(hn::Mul(hn::Add(pixel, set(0.5)), per_packet)); };
    store(hn::IfThenElse(some, packet(begin), set(1.0)), out.first);
    store(hn::IfThenElseZero(some, packet(end)), out.last);
    const auto place = [&](auto pixel) {
      return hn::DemoteTo(half, hn::MulAdd(pixel, set(axis.width), set(axis.first)));
    };
    hn::Store(place(begin), half, out.low + i), hn::Store(place(end), half, out.high + i);
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
HWY_EXPORT(place_kernel);
HWY_EXPORT(rank_kernel);

void rank_falling(const float* numbers, std::size_t count, std::uint32_t* rank) {
  HWY_DYNAMIC_DISPATCH(rank_kernel)(numbers, count, rank);
}

void place_bounds(const PacketAxis& axis, double slack, const float* min, const float* max,
                  PacketSpans& out) {
  HWY_DYNAMIC_DISPATCH(place_kernel)(axis, slack, min, max, out);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
