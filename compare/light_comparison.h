// From the climbed pixels of one light to everything that is said of it.
#pragma once

#include "compare/ladder.h"

namespace gnomon::compare {

/// What hangs on the map and on which pixels are compared, but not on how the map is looked up.
struct MapMeasures {
  std::array<double, 3> texel_world{};
  TheoryStats theory;
};
MapMeasures measure_map(const LadderInput& input, const Image<Label>& labels);

struct MeasureOptions {
  int bias_curve_points = 129;
  /// FLIP and SSIM, which cost more than all the rest (NaN when left out), the maps of displacement, and the
  /// kinds of bias.
  bool perceptual = true;
  const MapMeasures* map = nullptr;  ///< of the same map and the same compared pixels; null: made anew
};

/// `record` is the light's index in the frames' lists.
LightComparison measure_light(const LadderInput& input, std::size_t record, Climb climbed,
                              const MeasureOptions& options);

/// Counts, errors, budget and rung means from `rungs` and `labels` alone.
void measure_pixels(LightComparison& light);
/// The figures of a drawing without climbing it: what `measure` needs, the others that cost more left NaN.
ErrorFigures measure_figures(const LadderInput& input, ErrorMeasure measure);
/// FLIP and SSIM of the visibility pictures: white lit, black shadowed, white where nothing is compared.
void measure_perceptual(LightComparison& light);

}  // namespace gnomon::compare
