// Which bins of a rectangle a primitive covers, several bins at a time; compiled once per instruction set.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "raytrace/packets/light_bins.h"
#include "raytrace/packets/tile.h"

namespace gnomon::raytrace {

/// Bounds of the rays of every column (or row) of bins.
struct BinLines {
  std::vector<float> lo, hi;  ///< padded by packet_rays
};

struct BinRect {
  int x0, y0, x1, y1;  ///< inclusive
};

/// Along one axis: which bins eight primitives' bounds may touch (first > last: none), and where the bounds
/// lie in 256ths of a bin, one of them added on either side for rounding.
struct alignas(32) BinSpans {
  std::int32_t first[8], last[8], low[8], high[8];
  /// The lowest byte where in this bin primitive i begins, the next one where it ends.
  std::uint32_t in(std::size_t i, int bin) const {
    const auto a = static_cast<std::uint32_t>(std::clamp(low[i] - 256 * bin, 0, 255));
    const auto b = static_cast<std::uint32_t>(std::clamp(high[i] - 256 * bin, 0, 255));
    return a | b << 8;
  }
};

/// `slack`: what lines and bounds may be wrong by. `min`, `max`: eight each.
void place_eight(const BinAxis& axis, double slack, const float* min, const float* max, BinSpans& out);

struct CoveredBin {
  std::uint32_t bin, leaf;
  float nearest;
  std::uint32_t box;  ///< left to the caller
};

/// Writes the bins of the rectangle that are not surely missed, with `nearest` lowered to what the primitive
/// reaches in the bin, and returns their number. `out`: room for all of them and 16 more.
std::size_t cover_bins(const PrimitiveEdges& primitive, std::uint32_t leaf, float nearest,
                       const BinLines& columns, const BinLines& rows, const BinRect& rect, CoveredBin* out);

/// How many of `count` numbers come before each when the greatest come first, and of equals the first. Both
/// are padded by packet_rays.
void rank_falling(const float* numbers, std::size_t count, std::uint32_t* rank);

}  // namespace gnomon::raytrace
