// The figures of each cascade by itself: of its compared pixels alone.
#pragma once

#include <vector>

#include "compare/ladder/budget.h"
#include "compare/ladder/ladder.h"

namespace gnomon::compare {

/// One cascade's pixels, part by part from the top.
struct CascadeSums {
  explicit CascadeSums(int of_face) : face(of_face) {}
  void add(const raster::LightRecord& record, const std::array<Image<float>, rung_count>& rungs,
           const Image<Label>& labels);
  int face;
  PixelSums sums{};
};

/// One for each cascade of a map of technique csm that was drawn here; else none.
std::vector<CascadeSums> sums_of_cascades(const raster::RasterFrame& drawn,
                                          const raster::LightRecord& record);
std::vector<CascadeFigures> cascade_figures(const std::vector<CascadeSums>& sums);
}  // namespace gnomon::compare
