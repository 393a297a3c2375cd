// Parts of a picture, for pictures whose numbers would not all fit into memory at one time.
#pragma once

#include "raytrace/frame.h"
#include "scene/picture_rows.h"

namespace gnomon::raytrace {

/// Those rows of the picture that trace_frame makes with these options, to the last bit; row 0 of the frame's
/// images is rows.first, options.size stays that of the whole. What the frame counts are the rows' rays, but
/// for RayCounts::interior, which each band asks for anew.
RayTracedFrame trace_band(const Tracer& tracer, const EffectPlan& plan, const Camera& camera,
                          std::span<const std::uint32_t> lights, const RaytraceOptions& options,
                          const PictureRows& rows);

/// Counts and times of the band after those of the bands before it, whose images stay as they are.
void add_costs(const RayTracedFrame& band, RayTracedFrame& sum);

}  // namespace gnomon::raytrace
