// From leaf positions to surface points: the double kernels of raytrace/intersect.h and
// raytrace/ray_offset.h, operation for operation, several pixels at a time; compiled once per instruction
// set.
#pragma once

#include <array>

#include "raytrace/packet/tile.h"
#include "scene/camera.h"

namespace gnomon::raytrace {

/// Writes the receivers of a whole tile that lie on triangles, row by row `stride` apart. Returns per packet
/// the bits of those that it left alone: no triangle hit for sure, an edge function of zero, a ray whose
/// largest component is not rays.axis or has exponent 1.
std::array<std::uint16_t, tile_packets> store_receivers(const Bvh& bvh, const View& view, int x0, int y0,
                                                        const TileRays& rays, const TileHits& hits,
                                                        SurfacePoint* receivers, std::size_t stride);

}  // namespace gnomon::raytrace
