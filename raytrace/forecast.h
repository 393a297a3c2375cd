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

/// Of the picture that trace_frame makes with these options and all lights; options.records is not followed.
Forecast forecast_rays(const Tracer& tracer, const EffectPlan& plan, const Camera& camera,
                       const RaytraceOptions& options);

}  // namespace gnomon::raytrace
