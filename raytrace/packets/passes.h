// A frame's receivers, by tiles. What is stored is what the double kernels give, bit for bit: the floats only say
// which primitive is hit, and which rays must be asked again in double. A light's pass is in shadow_pass.h.
#pragma once

#include <span>
#include <stop_token>

#include "raytrace/huge_array.h"
#include "raytrace/packets/blocks.h"
#include "raytrace/packets/light_setup.h"
#include "raytrace/packets/tile.h"
#include "raytrace/quantised_tile.h"
#include "raytrace/tracer.h"
#include "scene/camera.h"
#include "scene/image.h"

namespace gnomon::raytrace {

/// Where a pass goes: of the whole picture, or of the rows from first_row on, which then are row 0 here. What is
/// empty is not asked for.
struct PrimarySinks {
  ImageSize size;     ///< of what is stored
  int first_row = 0;  ///< of the picture; a multiple of block_pixels
  std::span<TileHits>
      hits;  ///< by tile; ambiguous where floats cannot tell, but on triangles that doubles found
  Image<SurfacePoint>* receivers = nullptr;
  std::span<QuantisedTile> quantised;  ///< by tile
};

/// What the sinks hold of the picture, by blocks, over all threads. `eye`: edge_setup_of_eye(). Once a stop is requested no further
/// block is begun.
void primary_pass(const Tracer& tracer, const View& view, const EdgeSetup& eye, const PrimarySinks& sinks,
                  const std::stop_token& stop = {});

/// Where a tile's receivers are to be had in double: stored, or by tracing the pixel again.
struct ReceiverSource {
  const Tracer* tracer;
  const Image<SurfacePoint>* stored = nullptr;
  const View* view = nullptr;  ///< these two when none are stored
  const TileHits* hits = nullptr;
  int first_row = 0;  ///< as PrimarySinks has it
  SurfacePoint at(const TileRect& rect, std::size_t lane) const;
  /// Fills in the receivers asked for, many at a time, by their place in the tile: points[16 * y + x].
  void fill(const TileRect& rect, const LaneMask& asked, SurfacePoint* points) const;
};

// Receivers that a frame does not store, where only the picture is wanted. Each tile's are found again from
// the primitives that its pixels see, bit for bit as they were. They live no longer than the tile is worked
// on. They are 96 bytes a pixel: to clear these and to page them in takes longer than to find them twice.

struct UnstoredReceivers {
  HugeArray<TileHits> hits;  ///< by tile; empty: the receivers are stored
  int first_row = 0;         ///< as PrimarySinks has it

  bool apply() const { return hits.size() > 0; }
  ReceiverSource source(const Tracer& tracer, const View& view, std::size_t tile) const {
    return {.tracer = &tracer, .stored = nullptr, .view = &view, .hits = &hits[tile], .first_row = first_row};
  }
};

}  // namespace gnomon::raytrace
