// Which cells of a rectangle a primitive covers, several cells at a time; compiled once per instruction set.
#pragma once

#include <cstdint>
#include <vector>

#include "raytrace/packet/tile.h"

namespace gnomon::raytrace {

/// Bounds of the rays of every column (or row) of cells.
struct CellLines {
  std::vector<float> lo, hi;  ///< padded by packet_rays
};

struct CellRect {
  int x0, y0, x1, y1;  ///< inclusive
};

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

}  // namespace gnomon::raytrace
