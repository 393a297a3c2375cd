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

#include <cstring>
#include <limits>

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
constexpr float inf = std::numeric_limits<float>::infinity();

inline std::size_t lanes() {
  return hn::Lanes(f);
}
inline V all(float v) {
  return hn::Set(f, v);
}
inline unsigned bits_of(M mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(f, mask, bytes);
  std::uint32_t bits = 0;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
}
inline M mask_of(unsigned bits) {
  std::uint8_t bytes[8] = {};
  std::memcpy(bytes, &bits, sizeof bits);
  return hn::LoadMaskBits(f, bytes);
}

/// A function of d = (u, v, 1).
struct Linear {
  float u, v, constant;
};
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

/// One primitive's functions.
struct Functions {
  Linear edge[3], reciprocal_depth;
  explicit Functions(const PrimitiveEdges& p)
      : edge{of(p.edge[0]), of(p.edge[1]), of(p.edge[2])}, reciprocal_depth(of(p.reciprocal_depth)) {}
  static Linear of(const float (&n)[3]) { return {n[0], n[1], n[2]}; }
};

/// Rays against one primitive: the least edge function and the reciprocal depth.
class RayTest {
 public:
  explicit RayTest(const Functions& of)
      : e0u_(all(of.edge[0].u)),
        e0v_(all(of.edge[0].v)),
        e0c_(all(of.edge[0].constant)),
        e1u_(all(of.edge[1].u)),
        e1v_(all(of.edge[1].v)),
        e1c_(all(of.edge[1].constant)),
        e2u_(all(of.edge[2].u)),
        e2v_(all(of.edge[2].v)),
        e2c_(all(of.edge[2].constant)),
        mu_(all(of.reciprocal_depth.u)),
        mv_(all(of.reciprocal_depth.v)),
        mc_(all(of.reciprocal_depth.constant)) {}
  V least_edge(V u, V v) const {
    return hn::Min(value(e0u_, e0v_, e0c_, u, v),
                   hn::Min(value(e1u_, e1v_, e1c_, u, v), value(e2u_, e2v_, e2c_, u, v)));
  }
  V reciprocal_depth(V u, V v) const { return value(mu_, mv_, mc_, u, v); }

 private:
  V e0u_, e0v_, e0c_, e1u_, e1v_, e1c_, e2u_, e2v_, e2c_, mu_, mv_, mc_;
};

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
