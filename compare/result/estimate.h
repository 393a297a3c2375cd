// What shadows would take on a machine that is not here: the counts of this one, by rates that a person measured or looked up.
// Such a time is called an estimate wherever it stands. It leaves out what is not counted: vertices, caches, waiting.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"

namespace gnomon::compare {

/// Reads a file of rates ("gnomon/rates/1", docs/rates.md).
Expected<Rates> read_rates(const std::string& file);

/// Milliseconds of a light's shadows on both sides; NaN where a count or its rate is not known.
struct EstimatedSides {
  double map = 0.0, rays = 0.0;
};
/// `map_is_drawn`: the light or the camera has moved, so that a map is drawn anew. Few rays and their denoiser stand for the map
/// of the technique that casts them.
EstimatedSides estimated_sides(const Comparison& comparison, const LightComparison& light, bool map_is_drawn);

/// "nothing moves: 0.013 ms by the map, 0.46 ms by rays", and what a light or camera that moves changes.
std::vector<std::string> estimate_lines(const Comparison& comparison, const LightComparison& light);

}  // namespace gnomon::compare
