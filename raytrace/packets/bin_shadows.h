// A tile's shadow rays by bins instead of the hierarchy: the answers of raytrace/packets/tile.h, each ray
// from the list of its own bin.
#pragma once

#include "raytrace/packets/light_bins.h"
#include "raytrace/packets/tile.h"

namespace gnomon::raytrace {

/// Rays whose (u, v) lie outside the bins are ambiguous, and `ambiguous_hits` is silent about them: `outside` says
/// which.
void shadows_in_bins(const LightBins& bins, const EdgeSetup& setup, const TileRays& rays,
                     TileShadows& shadows, LaneMask& outside);

}  // namespace gnomon::raytrace
