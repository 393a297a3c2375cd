// The figures of each cascade by itself: of its compared pixels alone.
#pragma once

#include <string>
#include <vector>

#include "compare/budget.h"
#include "compare/ladder.h"

namespace gnomon::compare {

/// Of the compared pixels that look up one cascade.
struct CascadeFigures {
  std::uint64_t compared = 0;
  ErrorStats error;
  std::array<BudgetStep, cause_count> budget{};
};

/// One cascade's pixels, part by part from the top.
struct CascadeSums {
  explicit CascadeSums(int of_face) : face(of_face) {}
  void add(const raster::LightRecord& record, const std::array<Image<float>, rung_count>& rungs,
           const Image<Label>& labels);
  int face;
  PixelSums sums{};
};

/// By light.
using CascadeTables = std::vector<std::vector<CascadeFigures>>;
/// The text of result.json (output_parts.h) of a comparison whose images do not hold all pixels.
std::string result_json(const Comparison& comparison, double report_ms, double total_ms,
                        const CascadeTables* cascades);

/// One for each cascade of a map of technique csm that was drawn here; else none.
std::vector<CascadeSums> sums_of_cascades(const raster::RasterFrame& drawn,
                                          const raster::LightRecord& record);
std::vector<CascadeFigures> figures_of(const std::vector<CascadeSums>& sums);
}  // namespace gnomon::compare
