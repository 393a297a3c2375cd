// The visibility ladder: every compared pixel climbed from the truth to what was drawn, one change at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "compare/comparison.h"
#include "compare/texel_groups.h"
#include "raytrace/sheets.h"

namespace gnomon::compare {

/// What one light's pixels are climbed with. All parts must outlive the ladder.
struct LadderInput {
  const World& world;
  const raytrace::Tracer& tracer;
  const raytrace::Topology& topology;
  const Light& light;
  const raster::RasterFrame& drawn;
  const raster::LightRecord& record;
  const raytrace::RayTracedFrame& traced;
  const raytrace::LightTruth& truth;
};

/// Marks each pixel background, silhouette, facing_away, uncertain, or right (= to be compared).
Image<Label> sort_pixels(const LadderInput& input);

/// Why a wrong pixel is wrong needs more than its rungs: the step, and what was found on the way.
struct Climb {
  std::array<Image<float>, rung_count> rungs;  ///< V0 … V6; 1 where not compared
  Image<Label> labels;
};

/// Climbs the compared pixels (label `right` on entry) and labels the wrong ones.
Climb climb(const LadderInput& input, Image<Label> sorted);

/// The step at which |V - V0| last rose above one half; requires a wrong pixel.
Cause deciding_step(const std::array<float, rung_count>& rungs);

}  // namespace gnomon::compare
