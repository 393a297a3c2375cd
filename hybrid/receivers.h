// What a picture's pixels show, in double and as compact floats; and the ray tracer's receivers from the
// rasterizer's visibility buffer: the rasterizer says which primitive a pixel shows, and the pixel's ray is
// intersected with that one alone, by the very kernels of the tracer. Where both renderers see the same
// primitive, the point is the tracer's own, bit for bit. Where the ray just misses the primitive (the
// rasterizer's rounding at an outline), the tracer's nearest hit stands in.
#pragma once

#include "raytrace/huge_array.h"
#include "raytrace/packets/quantised_tile.h"
#include "raytrace/tracer.h"
#include "scene/camera.h"
#include "scene/image.h"

namespace gnomon::hybrid {

struct Receivers {
  Image<raytrace::SurfacePoint> points;                ///< primitive is no_id where nothing is seen
  raytrace::HugeArray<raytrace::QuantisedTile> tiles;  ///< the same, tile by tile of raytrace::TileGrid
  std::span<const raytrace::QuantisedTile> quantised() const { return {tiles.data(), tiles.size()}; }
};

/// Of points that come from elsewhere.
Receivers make_receivers(Image<raytrace::SurfacePoint> points);

struct ReceiverCounts {
  std::uint64_t traced = 0;  ///< pixels whose ray misses their primitive
};

class ReceiverFinder {
 public:
  /// The tracer must outlive the finder.
  explicit ReceiverFinder(const raytrace::Tracer& tracer);
  /// Row 0 of `primitive` is first_row of the view's picture. `receivers` keeps its memory between calls.
  ReceiverCounts find(const View& view, int first_row, const Image<std::uint32_t>& primitive,
                      Receivers& receivers) const;

 private:
  const raytrace::Tracer& tracer_;
  std::vector<std::uint32_t> leaf_of_;  ///< by primitive: as raytrace::TileHits has it
};

}  // namespace gnomon::hybrid
