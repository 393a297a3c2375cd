// What shadows cost apart from what the picture costs, on both sides: the map and its lookups against the
// light's structure and its rays.
#pragma once

#include "compare/comparison.h"
#include "scene/base/time_difference.h"

namespace gnomon::compare {

/// What shading takes beyond the same shading without shadows. Not timed where RasterOptions::shadow_cost did not ask for
/// it.
TimeDifference shadow_lookups(const raster::LightRecord& drawn);
/// What a frame's shadows take in which something has moved: the map and its lookups.
TimeDifference map_and_lookups(const raster::LightRecord& drawn);
/// The exact shadow of a light whose structure stands, run by run (ms): all but LightTruth::light_structure.
Times standing_rays(const raytrace::LightTruth& truth);

inline constexpr std::string_view software_note =
    "a software rasterizer's times are not a GPU's; texels, lookups, rays and tests hold everywhere";

/// Mesa's software rasterizers, by the name that OpenGL gives.
bool is_software(const raster::ContextInfo& context);

/// Counted over the compared pixels; none where the technique looks up no map or a shader of the user's own
/// does.
std::optional<std::uint64_t> count_lookups(const raster::RasterFrame& frame, const raster::LightRecord& drawn,
                                           const Image<Label>& labels);
/// Adds what rays of some thousand compared pixels, spread evenly over the picture, meet, as far as they begin in a part of it: the first of its pixels, and the pixels of the whole.
void add_ray_work(const raytrace::Tracer& tracer, const Light& light,
                  const Image<raytrace::SurfacePoint>& receivers, const Image<Label>& labels,
                  std::size_t first_pixel, std::size_t all_pixels, RayWork& sum);

}  // namespace gnomon::compare
