// Which surface a texel of a depth map stores. A map holds depths alone, whoever drew it; the surface is the one that
// the light ray through the texel's centre meets at that depth.
#pragma once

#include "compare/ladder/ladder.h"

namespace gnomon::compare {

struct StoredSurface {
  std::uint32_t primitive = no_id;
  double t = infinity;      ///< where the centre's ray (columns.h, caster_ray) meets it
  double depth = infinity;  ///< of that, along the map's forward axis
};

/// Returns one of the surfaces on the centre's ray that culling leaves. It is the first whose depth is the stored one up to
/// the map's rounding, else the one whose depth lies nearest to it. For an edge's rounded corners may leave the surface
/// beside the ray. Of a map of midpoints it is the first of all. It returns none where the texel is empty, or the ray meets
/// nothing. What another renderer culls is not known: its map may store any side.
StoredSurface stored_surface(const raytrace::Tracer& tracer, const raster::LightRecord& record,
                             const raster::MapOptions& options, raytrace::TexelKey key);
inline StoredSurface stored_surface(const LadderInput& in, raytrace::TexelKey key) {
  return stored_surface(in.tracer, in.record(), in.drawn.options.map, key);
}

}  // namespace gnomon::compare
