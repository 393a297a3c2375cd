// From the climbed pixels of one light to everything that is said of it.
#pragma once

#include "compare/ladder.h"

namespace gnomon::compare {

struct MeasureOptions {
  int bias_curve_points = 129;
  bool perceptual = true;  ///< FLIP and SSIM, which cost more than all the rest; NaN when left out
};

/// `record` is the light's index in the frames' lists.
LightComparison measure_light(const LadderInput& input, std::size_t record, Climb climbed,
                              const MeasureOptions& options);

/// Counts, errors, budget and rung means from `rungs` and `labels` alone.
void measure_pixels(LightComparison& light);
/// FLIP and SSIM of the visibility pictures: white lit, black shadowed, white where nothing is compared.
void measure_perceptual(LightComparison& light);

}  // namespace gnomon::compare
