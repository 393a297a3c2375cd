// From leaf positions to surface points: the double kernels of raytrace/shapes/intersect.h and
// raytrace/precision/ray_offset.h, operation for operation, several pixels at a time; compiled once per
// instruction set.
#pragma once

#include <array>

#include "raytrace/packets/quantised_tile.h"
#include "raytrace/packets/tile.h"
#include "scene/camera.h"

namespace gnomon::raytrace {

/// Where a tile's receivers go: in double, row by row `stride` apart; or quantised; or both.
struct ReceiverSinks {
  SurfacePoint* points = nullptr;
  std::size_t stride = 0;
  QuantisedTile* quantised = nullptr;  ///< these two together; finish() is left to the caller
  TileDraft* draft = nullptr;
};

/// Writes the receivers of a tile that lie on triangles. `axis`: the world axis along which the rays are
/// longest, for most of them. Returns per packet the bits of those that it left alone: no triangle hit for
/// sure, an edge function of zero, a ray whose largest component is not that axis or has exponent 1.
LaneMask store_receivers(const Bvh& bvh, const View& view, int x0, int y0, int axis, const TileHits& hits,
                         const ReceiverSinks& sinks);

}  // namespace gnomon::raytrace
