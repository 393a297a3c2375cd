// What all packet kernels share: 16 floats at once, whatever the instruction set's width, and the linear
// functions that a primitive is to rays of a common origin or direction. Every test is made of value(), so
// that tests over intervals, whose rounding is monotone, never cull what a test of one ray would keep.

#if defined(GNOMON_RAYTRACE_PACKETS_LANES_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_LANES_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_LANES_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>

#include "raytrace/mask_bits-inl.h"
#include "raytrace/packets/edge_setup_rows.h"
#include "raytrace/packets/tile.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, packet_rays>;
using I = hn::RebindToUnsigned<F>;
using V = hn::Vec<F>;
using M = hn::Mask<F>;
constexpr F f;
constexpr I ids;
using Four = hn::CappedTag<float, 4>;
constexpr Four four;
constexpr float inf = std::numeric_limits<float>::infinity();

inline std::size_t lanes() {
  return hn::Lanes(f);
}
/// Vectors of a packet.
constexpr std::size_t packet_steps = packet_rays / hn::MaxLanes(f);
inline V all(float v) {
  return hn::Set(f, v);
}
inline unsigned bits_of(M mask) {
  return mask_bits(f, mask);
}
inline M mask_of(unsigned bits) {
  return mask_from_bits(f, bits);
}

/// The order of operations that everything here shares.
inline V value(V cu, V cv, V constant, V u, V v) {
  return hn::MulAdd(cu, u, hn::MulAdd(cv, v, constant));
}

inline float smallest(const float* values) {
  V least = hn::Load(f, values);
  for (std::size_t i = lanes(); i < packet_rays; i += lanes())
    least = hn::Min(least, hn::Load(f, values + i));
  return hn::GetLane(hn::MinOfLanes(f, least));
}
inline float largest(const float* values) {
  V most = hn::Load(f, values);
  for (std::size_t i = lanes(); i < packet_rays; i += lanes()) most = hn::Max(most, hn::Load(f, values + i));
  return hn::GetLane(hn::MaxOfLanes(f, most));
}

/// One of eight primitives by rows. A number is spread over the lanes where it is used: registers do not hold them all.
class LaneNumbers {
 public:
  LaneNumbers(const EdgeSetupRows& rows, std::size_t i) : first_(rows.out[0] + i) {}
  V least_edge(V u, V v) const {
    const auto edge = [&](std::size_t k) { return value(row(3 * k), row(3 * k + 1), row(3 * k + 2), u, v); };
    return hn::Min(edge(0), hn::Min(edge(1), edge(2)));
  }
  V reciprocal_depth(V u, V v) const { return value(row(9), row(10), row(11), u, v); }
  V edge_error() const { return row(12); }
  V depth_error() const { return row(13); }
  V depth_floor() const { return row(14); }

 private:
  V row(std::size_t k) const { return all(first_[k * EdgeSetupRows::together]); }
  const float* first_;
};

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
