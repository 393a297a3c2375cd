// Which cells of a rectangle a primitive covers, several cells at a time; compiled once per instruction set.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "raytrace/packets/light_bins.h"
#include "raytrace/packets/tile.h"

namespace gnomon::raytrace {

/// Bounds of the rays of every column (or row) of cells.
struct CellLines {
  std::vector<float> lo, hi;  ///< padded by packet_rays
};

struct CellRect {
  int x0, y0, x1, y1;  ///< inclusive
};

/// Along one axis: which cells eight primitives' bounds may touch (first > last: none), and where the bounds
/// lie in 256ths of a cell, one of them added on either side for rounding.
struct alignas(32) CellPlaces {
  std::int32_t first[8], last[8], low[8], high[8];
  /// The lowest byte where in this cell primitive i begins, the next one where it ends.
  std::uint32_t in(std::size_t i, int cell) const {
    const auto a = static_cast<std::uint32_t>(std::clamp(low[i] - 256 * cell, 0, 255));
    const auto b = static_cast<std::uint32_t>(std::clamp(high[i] - 256 * cell, 0, 255));
    return a | b << 8;
  }
};

/// `slack`: what lines and bounds may be wrong by. `min`, `max`: eight each.
void place_eight(const CellAxis& axis, double slack, const float* min, const float* max, CellPlaces& out);

struct CoveredCell {
  std::uint32_t cell, leaf;
  float nearest;
  std::uint32_t box;  ///< left to the caller
};

/// Writes the cells of the rectangle that are not surely missed, with `nearest` lowered to what the primitive
/// reaches in the cell, and returns their number. `out`: room for all of them and 16 more.
std::size_t cover_cells(const SeenPrimitive& primitive, std::uint32_t leaf, float nearest,
                        const CellLines& columns, const CellLines& rows, const CellRect& rect,
                        CoveredCell* out);

/// How many of `count` numbers come before each when the greatest come first, and of equals the first. Both
/// are padded by packet_rays.
void rank_falling(const float* numbers, std::size_t count, std::uint32_t* rank);

}  // namespace gnomon::raytrace
