// The primary and hard-shadow passes of a frame by tiles. What they store is what the double kernels give,
// bit for bit: the floats only say which primitive is hit, and which rays must be asked again in double.
#pragma once

#include <span>
#include <stop_token>

#include "raytrace/packets/sight.h"
#include "raytrace/packets/tile.h"
#include "raytrace/tracer.h"
#include "scene/camera.h"
#include "scene/image.h"

namespace gnomon::raytrace {

/// A tile's rectangle of pixels: at most 16 x 16.
struct TileRect {
  int x0, y0, x1, y1;
};

/// Where a whole picture's pass goes; what is empty is not asked for.
struct PrimarySinks {
  std::span<TileHits>
      hits;  ///< by tile; ambiguous where floats cannot tell, but on triangles that doubles found
  Image<SurfacePoint>* receivers = nullptr;
  std::span<QuantisedTile> quantised;  ///< by tile
};

/// The whole picture by blocks, over all threads. `eye`: edge_setup_of_eye(). Once a stop is requested no further
/// block is begun.
void primary_pass(const Tracer& tracer, const View& view, const EdgeSetup& eye, const PrimarySinks& sinks,
                  const std::stop_token& stop = {});

/// Where a tile's receivers are to be had in double: stored, or by tracing the pixel again.
struct ReceiverSource {
  const Tracer& tracer;
  const Image<SurfacePoint>* stored = nullptr;
  const View* view = nullptr;  ///< these two when none are stored
  const TileHits* hits = nullptr;
  SurfacePoint at(const TileRect& rect, std::size_t lane) const;
  /// Those asked for, many at a time, by their place in the tile: points[16 * y + x].
  void fill(const TileRect& rect, const LaneMask& asked, SurfacePoint* points) const;
};

/// Fills the verdicts of the tile's receivers as Tracer::light_verdict does, `shadowed` where the light
/// cannot reach, and returns the number of rays. Without a quantised tile the receivers must be stored.
std::uint64_t shadow_tile(const ReceiverSource& receivers, const Light& light, const Sight& sight,
                          const TileRect& rect, const QuantisedTile* quantised, Image<Verdict>& verdicts);

/// The whole tile: lit, or shadowed where the bit is set.
void store_verdicts(const TileRect& rect, const LaneMask& dark, Image<Verdict>& verdicts);

/// Fills the verdicts of the asked receivers alone, which exist and which the light reaches; the others' are
/// left as they are. The receivers must be stored, and `quantised` may be nullptr. Without a sight of the
/// light (packets do not apply) each ray is traced by itself.
void shadow_lanes(const ReceiverSource& receivers, const Light& light, const Sight* sight,
                  const TileRect& rect, const QuantisedTile* quantised, const LaneMask& asked,
                  Image<Verdict>& verdicts);

/// By primitive, its place as TileHits has it; nothing_hit for those that cannot be hit.
std::vector<std::uint32_t> hit_places(const Tracer& tracer);

/// Fills the tile's receivers from the primitives that its pixels are known to show (no_id: none), as
/// primary_pass does where it finds the same ones. `leaf_of`: hit_places(). Returns the
/// number of pixels whose ray misses their primitive; these get the nearest hit.
std::uint64_t known_tile(const Tracer& tracer, const View& view, std::span<const std::uint32_t> leaf_of,
                         const TileRect& rect, const Image<std::uint32_t>& primitives,
                         Image<SurfacePoint>& receivers, QuantisedTile& quantised);

}  // namespace gnomon::raytrace
