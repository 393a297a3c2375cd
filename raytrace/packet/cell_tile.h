// A tile's rays by cells instead of the hierarchy: the answers of raytrace/packet/tile.h, each ray from the
// list of its own cell.
#pragma once

#include "raytrace/packet/cells.h"
#include "raytrace/packet/tile.h"

namespace gnomon::raytrace {

/// Packet (i, j) of the tile has cell (column + i, row + j); those beyond the last are left alone.
void closest_in_cells(const Cells& cells, const Seen& seen, const TileRays& rays, int column, int row,
                      TileHits& hits);

/// Rays whose (u, v) lie outside the cells are unsure, and `doubts` is silent about them: `outside` says
/// which.
void shadows_in_cells(const Cells& cells, const Seen& seen, const TileRays& rays, TileShadows& shadows,
                      std::array<std::uint16_t, tile_packets>& outside);

}  // namespace gnomon::raytrace
