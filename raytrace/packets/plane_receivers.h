// From hits on infinite planes to surface points: the double kernels of raytrace/shapes/intersect.h and
// raytrace/precision/ray_offset.h, operation for operation, several pixels at a time; compiled once per
// instruction set.
#pragma once

#include "raytrace/packets/passes.h"

namespace gnomon::raytrace {

/// Writes the receivers of the asked pixels that see planes for sure, by place: points[16 * y + x]. Returns the bits of
/// those it wrote.
LaneMask find_plane_receivers(const Structures& structures, const View& view, const TileRect& rect,
                              const TileHits& hits, const LaneMask& asked, SurfacePoint* points);

}  // namespace gnomon::raytrace
