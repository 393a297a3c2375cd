// TexelBounds in eight bytes: what receivers look up lies all over the map, so its size is its price. The
// bounds keep 12 bits of mantissa, rounded towards ambiguity; the slopes keep two, and are rounded before the
// bounds are made (round_slope), so that nothing is lost by them.
#pragma once

#include <bit>

#include "hybrid/texel_bounds.h"

namespace gnomon::hybrid {

/// The upper 21 bits are those of a float, a bound; the lower eleven are the first of a slope's float.
struct PackedBounds {
  static constexpr int slope_bits = 11, slope_shift = 32 - slope_bits;
  static constexpr std::uint32_t slope_mask = (1u << slope_bits) - 1;
  std::uint32_t lit_above_slope_u, dark_below_slope_v;
};

/// The nearest number that a slope may be.
inline float round_slope(float slope) {
  constexpr std::uint32_t half = 1u << (PackedBounds::slope_shift - 1);
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(slope) + half) & ~(2 * half - 1));
}

/// Not below the value; the lower bits are clear.
inline std::uint32_t packed_above(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const bool away_from_zero = bits >> 31 == 0;
  return (away_from_zero ? bits + PackedBounds::slope_mask : bits) & ~PackedBounds::slope_mask;
}

/// Packs bounds and rounds their slopes.
inline PackedBounds pack(const TexelBounds& b) {
  const auto slope = [](float s) { return std::bit_cast<std::uint32_t>(s) >> PackedBounds::slope_shift; };
  constexpr std::uint32_t sign = 1u << 31;
  return {packed_above(b.lit_above) | slope(b.slope_u),
          (packed_above(-b.dark_below) ^ sign) | slope(b.slope_v)};
}

inline TexelBounds unpack(const PackedBounds& b) {
  const auto bound = [](std::uint32_t bits) {
    return std::bit_cast<float>(bits & ~PackedBounds::slope_mask);
  };
  const auto slope = [](std::uint32_t bits) {
    return std::bit_cast<float>(bits << PackedBounds::slope_shift);
  };
  return {bound(b.lit_above_slope_u), bound(b.dark_below_slope_v), slope(b.lit_above_slope_u),
          slope(b.dark_below_slope_v)};
}

}  // namespace gnomon::hybrid
