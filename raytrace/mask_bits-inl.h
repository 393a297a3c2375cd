// A mask of lanes as the bits of a number, and back.

#if defined(GNOMON_RAYTRACE_MASK_BITS_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_MASK_BITS_INL_H_
#undef GNOMON_RAYTRACE_MASK_BITS_INL_H_
#else
#define GNOMON_RAYTRACE_MASK_BITS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <cstring>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Bit i: lane i of at most 16; the bits above are 0.
template <class D>
HWY_INLINE unsigned mask_bits(D d, hn::Mask<D> mask) {
  constexpr std::size_t lanes = hn::MaxLanes(d);
  static_assert(lanes <= 16);
  if constexpr (requires {
                  requires std::is_integral_v<decltype(mask.raw)>;
                }) {  // AVX-512's registers of masks
    auto raw = mask.raw;
    // GCC 12 may store such a register on the stack by an instruction that writes its 8 or 16 bits. It may then read 32
    // from there as the number that the mask was widened to. The upper bits are then whatever stood there before. A mask
    // that passes through a general register is widened in it. tests/tools/mask_spills.py looks for such places in a
    // program.
    __asm__("" : "+r"(raw));
    return raw & ((1u << lanes) - 1);
  } else {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    if constexpr (lanes <= 8) return bytes[0];
    std::uint16_t bits;
    std::memcpy(&bits, bytes, sizeof bits);
    return bits;
  }
}

template <class D>
HWY_INLINE hn::Mask<D> mask_from_bits(D d, unsigned bits) {
  std::uint8_t bytes[8] = {};
  std::memcpy(bytes, &bits, sizeof bits);
  return hn::LoadMaskBits(d, bytes);
}

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
