// What a picture will cost in rays, effect by effect, before it is made: the same picture on a coarse grid of
// pixels, its counts scaled up. The error is that of sampling areas on the grid: a few percent of each count,
// more where a pixel costs so many samples that the grid is made coarser.
#pragma once

#include "raytrace/frame.h"

namespace gnomon::raytrace {

struct Forecast {
  RayCounts rays;
  ImageSize grid;      ///< that was traced
  bool exact = false;  ///< the grid is the picture itself
};

/// Forecasts the picture that trace_frame makes with these options and all lights; options.records is not followed.
Forecast forecast_rays(const Tracer& tracer, const EffectPlan& plan, const Camera& camera,
                       const RaytraceOptions& options);

/// Counts the rays to a light's centre that packets leave to single rays (raytrace/packets/tile_state-inl.h).
struct SingleRayForecast {
  std::uint32_t light = 0;             ///< index in Scene::lights
  std::uint64_t rays = 0, single = 0;  ///< in the rows that were traced
  double share() const { return rays == 0 ? 0.0 : static_cast<double>(single) / static_cast<double>(rays); }
};
struct SingleRayForecasts {
  std::vector<SingleRayForecast> lights;
  int rows = 0;  ///< of the picture's pixels, that were traced; all of them where it is small
};

/// Forecasts from some rows of the picture's own blocks. How many leaves a tile meets for each of its rays depends on
/// how dense its pixels are. So a coarse grid would not tell. `lights`: those whose centres are asked for.
SingleRayForecasts forecast_single_rays(const Tracer& tracer, const EffectPlan& plan, const Camera& camera,
                                        std::span<const std::uint32_t> lights,
                                        const RaytraceOptions& options);

}  // namespace gnomon::raytrace
