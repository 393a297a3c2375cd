// The few rays of one frame: which share of each pixel's arrives at the light, and how wide a penumbra what they met would cast.
#pragma once

#include "raster/options.h"
#include "rays/guides.h"
#include "raytrace/tracer.h"

namespace gnomon::rays {

/// Which frame's rays are cast, and how.
struct RaysWanted {
  raster::RayOptions options;
  std::uint64_t seed = 0;
  std::uint32_t light = 0;      ///< index in Scene::lights; it has a size
  std::uint32_t frame = 0;      ///< 0: the first that the history holds
  std::uint32_t first_row = 0;  ///< of the receivers in the camera's picture
};

/// What the rays of one frame found; images of the receivers' size.
struct LightRays {
  Image<float> share;  ///< of the pixel's rays that arrived; 1 where none is asked for
  /// Half the width of the penumbra at the pixel that the nearest blocker met would cast (penumbra_half_width), world units; 0
  /// where no ray was blocked.
  Image<float> half_width;
  /// Which pixel's rays these are: the pixel's own, or of one ray for 2 x 2 pixels that of the pixel that was asked.
  Image<std::uint32_t> source;
  std::uint64_t rays = 0;  ///< cast
};

/// A sample below the receiver's own horizon is no ray, and not seen. Any unmasked surface that casts shadows blocks, as for
/// raytrace::light_visibility.
LightRays cast_rays(const raytrace::Tracer& tracer, const RaysWanted& wanted, const Guides& guides,
                    const Image<raytrace::SurfacePoint>& receivers);

/// Half the width that the light's penumbra has at a receiver behind a blocker, by similar triangles, world units. `reach`:
/// from the receiver to the light, infinite for a sun; `blocker`: from the receiver to what the ray met.
double penumbra_half_width(const Light& light, double reach, double blocker);

/// Boxes and primitives tested for those rays, one by one through the tree, on about 1,024 pixels spread over the picture.
raytrace::WorkCounts count_work(const raytrace::Tracer& tracer, const RaysWanted& wanted,
                                const Guides& guides, const Image<raytrace::SurfacePoint>& receivers,
                                std::uint64_t& rays);

}  // namespace gnomon::rays
