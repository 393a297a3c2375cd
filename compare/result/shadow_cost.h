// What shadows cost apart from what the picture costs, on both sides and on the same footing: the map and its lookups against
// the tracer's structure and its rays. What has moved since the last frame says which of them a frame makes anew.
#pragma once

#include <array>

#include "compare/comparison.h"
#include "scene/base/time_difference.h"

namespace gnomon::compare {

/// What shading takes beyond the same shading without shadows. Not timed where RasterOptions::shadow_cost did not ask for
/// it.
TimeDifference shadow_lookups(const raster::LightRecord& drawn);
/// The exact shadow of a light whose structure stands, run by run (ms): all but LightTruth::light_structure.
Times standing_rays(const raytrace::LightTruth& truth);

/// What the costs of all situations are sums of.
struct ShadowParts {
  TimeDifference map, lookups, rays;
  TimeDifference tree;  ///< which all lights share
  /// What stands for the map: "map"; or "hybrid" or "few rays", which ask the tree, too.
  std::string_view by = "map";
  bool asks_tree() const { return by != "map"; }
  /// Adds another light's.
  ShadowParts& operator+=(const ShadowParts& other);
};
/// ShadowParts::by of a technique.
std::string_view shadow_side(raster::Technique technique);
ShadowParts shadow_parts(const Comparison& comparison, const LightComparison& light);
/// None where lookups or rays are not timed. Without a tree's time that of moving casters is not timed.
std::optional<ShadowCosts> shadow_costs(const ShadowParts& parts);

/// A row of what has moved, and what each side then makes.
struct ShadowSituation {
  std::string_view key;           ///< of figures and JSON: "casters_move"
  std::string_view words;         ///< "casters move"
  std::string_view made;          ///< "map drawn and looked up; tree built, rays"
  std::string_view made_of_rays;  ///< the same where few rays are in the map's place
  ShadowCosts::Sides ShadowCosts::*sides;
};
std::span<const ShadowSituation> shadow_situations();
/// "8.1 ms (5 to 12 ms) by the map, 23 ms by rays"
std::string sides_text(const ShadowCosts::Sides& sides, std::string_view by);
/// "casters move: 8.1 ms by the map, 64 ms by rays", for each situation.
std::vector<std::string> shadow_cost_lines(const ShadowCosts& costs, std::string_view by);

/// What a time on such a rasterizer is worth.
inline constexpr std::string_view software_note =
    "One side is a generic software rasterizer, the other is vectorised for this question; what holds on a "
    "GPU are texels, lookups, rays and boxes.";

/// Mesa's software rasterizers, by the name that OpenGL gives.
bool is_software(const raster::ContextInfo& context);

/// Counted over the compared pixels; none where the technique looks up no map or a shader of the user's own
/// does.
std::optional<std::uint64_t> count_lookups(const raster::RasterFrame& frame, const raster::LightRecord& drawn,
                                           const Image<Label>& labels);
/// Adds what rays of some thousand compared pixels meet, as far as they begin in a part of the picture. The pixels are spread
/// evenly over it. Given are the first of the part's pixels, and the pixels of the whole.
void add_ray_work(const raytrace::Tracer& tracer, const Light& light,
                  const Image<raytrace::SurfacePoint>& receivers, const Image<Label>& labels,
                  std::size_t first_pixel, std::size_t all_pixels, RayWork& sum);

}  // namespace gnomon::compare
