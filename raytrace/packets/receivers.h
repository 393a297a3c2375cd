// From leaf positions to surface points: the double kernels of raytrace/shapes/intersect.h and
// raytrace/precision/ray_offset.h, operation for operation, several pixels at a time; compiled once per
// instruction set.
#pragma once

#include "raytrace/packets/blocks.h"
#include "raytrace/packets/tile.h"
#include "raytrace/quantised_tile.h"
#include "scene/camera.h"

namespace gnomon::raytrace {

/// Where a tile's receivers go: in double, row by row `stride` apart; or quantised; or both.
struct ReceiverSinks {
  SurfacePoint* points = nullptr;
  std::size_t stride = 0;
  /// Points of a picture, which are read long after they were written, and after publish_receivers(): with non-temporal
  /// stores, and the packets that show nothing are written as well.
  bool non_temporal = false;
  QuantisedTile* quantised = nullptr;  ///< these two together; finish() is left to the caller
  TileDraft* draft = nullptr;
};

/// Writes the receivers of a tile that lie on triangles and planes. Returns per packet the bits of those that it left
/// alone. Such a ray hits no triangle and no plane for sure, or an edge function is zero. Or its largest component is
/// not that of most of the tile's or has exponent 1. `rect`: the tile in the picture that is seen.
LaneMask store_receivers(const Structures& s, const View& view, const TileRect& rect, const TileHits& hits,
                         const ReceiverSinks& sinks);

/// Bits per packet of the hits that are not on triangles, and of those whose triangle's plane is too ill to
/// say where the receiver lies.
struct DraftLeft {
  LaneMask others, ill;
};

/// Writes a tile's receivers from the planes of their triangles alone: right to 2^-38 of their distance.
DraftLeft draft_receivers(const Bvh& bvh, const View& view, int x0, int y0, const TileHits& hits,
                          QuantisedTile& tile, TileDraft& draft);

}  // namespace gnomon::raytrace
