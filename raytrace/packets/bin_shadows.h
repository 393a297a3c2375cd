// A tile's shadow rays by cells instead of the hierarchy: the answers of raytrace/packets/tile.h, each ray
// from the list of its own cell.
#pragma once

#include "raytrace/packets/light_bins.h"
#include "raytrace/packets/tile.h"

namespace gnomon::raytrace {

/// Rays whose (u, v) lie outside the cells are unsure, and `doubts` is silent about them: `outside` says
/// which.
void shadows_in_cells(const Cells& cells, const Seen& seen, const TileRays& rays, TileShadows& shadows,
                      LaneMask& outside);

}  // namespace gnomon::raytrace
