// A vector of rays against a triangle's alpha mask (triangle_mask.h).

#if defined(GNOMON_RAYTRACE_PACKETS_MASK_LANES_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_MASK_LANES_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_MASK_LANES_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_MASK_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "raytrace/packets/lanes-inl.h"
#include "raytrace/packets/triangle_mask.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {

/// Bits of rays; of neither kind: not known.
struct MaskBits {
  unsigned opaque = 0, holes = 0;
};

/// `asked`: bits of the rays to be looked up, which are surely inside the triangle.
inline MaskBits look_up(const TriangleMask& mask, V u, V v, unsigned asked) {
  MaskBits bits;
  if (mask.cells == nullptr) return bits;
  constexpr hn::RebindToSigned<F> whole;
  const V du = hn::Sub(u, all(mask.u)), dv = hn::Sub(v, all(mask.v));
  const auto linear = [&](const float(&n)[3]) { return value(all(n[0]), all(n[1]), all(n[2]), du, dv); };
  const V per_w = hn::Div(all(1.0f), linear(mask.w));
  alignas(64) std::int32_t x[packet_rays], y[packet_rays];
  hn::Store(hn::ConvertTo(whole, hn::Floor(hn::Mul(linear(mask.x), per_w))), whole, x);
  hn::Store(hn::ConvertTo(whole, hn::Floor(hn::Mul(linear(mask.y), per_w))), whole, y);
  for (; asked != 0; asked &= asked - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(asked));
    const MaskKind kind = mask.cells->at(x[i], y[i]);
    bits.opaque |= static_cast<unsigned>(kind == MaskKind::opaque) << i;
    bits.holes |= static_cast<unsigned>(kind == MaskKind::hole) << i;
  }
  return bits;
}

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
