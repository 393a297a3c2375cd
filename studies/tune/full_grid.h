// The tuner against a full grid: every family at every size, at every constant bias where a drawing tells
// them all, else at the biases given. What the tuner answers should cost no more than the grid's cheapest
// setting that meets the same goal.
#pragma once

#include "studies/tune/tune.h"

namespace gnomon::studies {

/// A setting of the grid that meets the goal.
struct GridPoint {
  std::size_t family = 0;
  Attempt attempt;
};

struct GridCheck {
  std::uint64_t cells = 0;  ///< family x size, and x bias where each needs its own drawing
  std::uint64_t grid_drawings = 0, tune_drawings = 0;
  std::size_t good_cells = 0;  ///< that meet the goal
  TuneResult tuned;
  std::optional<GridPoint>
      best;  ///< the cheapest, where the goal is a time the one that errs least; empty: none meets it
  /// By TuneOptions::cost; else the least times of drawings made in turn: the tuner's answer, the grid's best
  /// (which may be that answer).
  double tuned_cost = 0.0, best_cost = 0.0;
  double ratio() const { return best_cost > 0.0 ? tuned_cost / best_cost : 0.0; }
};

/// Checks against either goal. `rounds` >= 1 drawings in turn of the tuner's answer and the grid's cheapest
/// settings.
Expected<GridCheck> check_against_grid(Engine& engine, const compare::Setting& base,
                                       const TuneOptions& options, const std::vector<raster::Bias>& biases,
                                       int rounds, const TuneProgress& progress = {});

}  // namespace gnomon::studies
