// The plane of (u, v) in cells, and for each cell the primitives that its rays may meet, nearest first: rays
// with a common origin or direction need no hierarchy then, each reads the list of its own cell until what is
// left lies behind it. Filled conservatively: whatever a ray of a cell does not surely miss is in its list.
// Cells cost one look at every primitive; where rays are few, the hierarchy is cheaper (cells_pay).
#pragma once

#include <limits>
#include <vector>

#include "raytrace/packets/seen.h"

namespace gnomon::raytrace {

/// One axis of the plane: `count` steps of equal width, some of them to a cell. A step holds the rays between
/// lo + i * width and hi + i * width: a pixel's centre alone, or a cell's whole width and a little more.
struct CellAxis {
  double lo = 0.0, hi = 0.0, width = 1.0;
  int count = 1, per_cell = 1;
  float origin = 0.0f, per_width = 1.0f;  ///< a ray's step is (u - origin) * per_width, rounded down
  int cells() const { return (count + per_cell - 1) / per_cell; }
};

/// Beyond these values of u or v there is nothing finite: rays there meet planes alone.
struct PlaneLimits {
  float u_min = -std::numeric_limits<float>::infinity(), u_max = -u_min;
  float v_min = u_min, v_max = u_max;
};

/// Where in its cell a primitive's bounds lie: u_min, u_max, v_min, v_max in 256ths, from the lowest byte on.
using PlaceInCell = std::uint32_t;

struct Cells {
  CellAxis u, v;
  PlaneLimits limits;                ///< a light's; what the cells leave out may lie beyond
  std::vector<std::uint32_t> first;  ///< of each cell, row by row; and the end
  /// The lists, in the order of falling `nearest`: the primitive is surely behind rays in this cell whose far
  /// is above it. Padded by packet_rays.
  HugeArray<float> nearest;
  HugeArray<std::uint32_t> leaf;
  HugeArray<PlaceInCell> box;
  HugeArray<SeenPrimitive> primitives;  ///< in leaf order; those in no list are not written

  int columns() const { return u.cells(); }
  int rows() const { return v.cells(); }
  std::size_t bytes() const {
    return first.size() * sizeof(first[0]) + nearest.bytes() + leaf.bytes() + box.bytes() +
           primitives.bytes();
  }
};

/// Whether cells are the cheaper way for so many rays.
bool cells_pay(const Structures& structures, std::size_t rays);

/// Fills the lists; false when too many primitives have no bounds in the plane for that to be worth while.
bool fill_cells(const Structures& structures, const Seen& seen, Cells& cells);

}  // namespace gnomon::raytrace
