// From hits on infinite planes to surface points: the double kernels of raytrace/shapes/intersect.h and
// raytrace/precision/ray_offset.h, operation for operation, several pixels at a time; compiled once per
// instruction set.
#pragma once

#include "raytrace/packets/receivers.h"

namespace gnomon::raytrace {

/// Writes the receivers of the asked pixels that see planes for sure. Returns the bits of those that it left alone.
LaneMask store_plane_receivers(const Structures& structures, const View& view, const TileRect& rect,
                               const TileHits& hits, const LaneMask& asked, const ReceiverSinks& sinks);

}  // namespace gnomon::raytrace
