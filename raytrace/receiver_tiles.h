// What other rooms have of the tracer's tiles (packets/ is the tracer's own): what a picture's pixels show, in double and as
// compact floats, and the hard shadows on it.
//
// The receivers may come from the rasterizer's visibility buffer. The rasterizer says which primitive a pixel shows. The
// pixel's ray is intersected with that one alone, by the very kernels of the tracer. Where both renderers see the same
// primitive, the point is the tracer's own, bit for bit. Where the ray just misses the primitive (the rasterizer's rounding
// at an outline), the tracer's nearest hit stands in.
#pragma once

#include "raytrace/huge_array.h"
#include "raytrace/quantised_tile.h"
#include "raytrace/tracer.h"
#include "scene/camera.h"
#include "scene/image.h"

namespace gnomon::raytrace {

struct Receivers {
  Image<SurfacePoint> points;      ///< primitive is no_id where nothing is seen
  HugeArray<QuantisedTile> tiles;  ///< the same, tile by tile of TileGrid
};

/// Makes receivers of points that come from elsewhere.
Receivers make_receivers(Image<SurfacePoint> points);

struct ReceiverCounts {
  std::uint64_t traced = 0;  ///< pixels whose ray misses their primitive
};

class ReceiverFinder {
 public:
  /// The tracer must outlive the finder.
  explicit ReceiverFinder(const Tracer& tracer);
  /// Row 0 of `primitive` is first_row of the view's picture. `receivers` keeps its memory between calls.
  ReceiverCounts find(const View& view, int first_row, const Image<std::uint32_t>& primitive,
                      Receivers& receivers) const;

 private:
  std::uint64_t find_tile(const View& view, int first_row, const TileRect& rect,
                          const Image<std::uint32_t>& primitives, Image<SurfacePoint>& receivers,
                          QuantisedTile& quantised) const;

  const Tracer& tracer_;
  std::vector<std::uint32_t> leaf_of_;  ///< by primitive, its place as TileHits has it; or nothing_hit
};

/// Whether the tracer takes many rays of a common origin or direction at a time: the world has a tree to traverse and
/// lengths that floats can hold.
bool packets_apply(const Tracer& tracer);

/// Fills `visibility` as Tracer::centre_visibility does, `shadowed` where the light cannot reach, and returns the number of
/// rays.
std::uint64_t trace_shadows(const Tracer& tracer, const Receivers& receivers, const Light& light,
                            Image<PointVisibility>& visibility);
/// The visibility of the asked receivers alone (by tile, bits per packet), which exist and which the light reaches; the
/// others' are left as they are.
void trace_shadows_of(const Tracer& tracer, const Receivers& receivers, const Light& light,
                      std::span<const LaneMask> asked, Image<PointVisibility>& visibility);

/// The whole tile: lit, or shadowed where the bit is set.
void store_visibility(const TileRect& rect, const LaneMask& dark, Image<PointVisibility>& visibility);

}  // namespace gnomon::raytrace
