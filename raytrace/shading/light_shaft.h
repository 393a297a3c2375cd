// Where nothing can stand between a point and a light with size, no ray needs to be cast.
#pragma once

#include "raytrace/kernels.h"

namespace gnomon::raytrace {

/// Fewer rays cost less than to find out.
inline constexpr int least_shaft_rays = 8;

/// Makes what shafts are traced through, where so many rays are asked at a point. Without it shafts say nothing, until
/// other rays have had it made: call this before a pass, so that its count of rays cast does not depend on them.
void prepare_light_shafts(const Tracer& tracer, int rays);

/// Whether each ray that LightSamples makes surely goes above the point's horizon and intersects nothing.
/// False says nothing: the rays have to be cast.
bool surely_sees_whole_light(const Tracer& tracer, const SurfacePoint& from, const Light& light);

}  // namespace gnomon::raytrace
