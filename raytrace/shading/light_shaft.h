// Where nothing can stand between a point and a light with size, no ray needs to be cast.
#pragma once

#include "raytrace/kernels.h"

namespace gnomon::raytrace {

/// Fewer rays cost less than to find out.
inline constexpr int least_shaft_rays = 8;

/// Whether each ray that LightSamples makes surely goes above the point's horizon and intersects nothing.
/// False says nothing: the rays have to be cast.
bool surely_sees_whole_light(const Tracer& tracer, const SurfacePoint& from, const Light& light);

}  // namespace gnomon::raytrace
