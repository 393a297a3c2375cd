// What the page and the tuner say of one cell: its errors over all lights together, and what it cost.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/comparison.h"
#include "compare/result/figures.h"
#include "scene/base/time_difference.h"
#include "studies/sweep/journal.h"

namespace gnomon::studies {

struct CellSummary {
  std::size_t cell = 0;
  std::vector<std::pair<std::string, std::string>> axes;  ///< names as in "axes", values as text
  std::vector<std::string> no_effect;  ///< of those names: the technique does not read them
  std::string command, technique;
  const compare::Figure* asked =
      &compare::wrong_and_mean();             ///< what a still picture's errors are counted in
  compare::LightFigures figures;              ///< of all lights together
  std::vector<compare::LightFigures> lights;  ///< of each: thresholds are held against the worst
  std::string main_label;                     ///< of most of the error; empty when there is none
  double map_size = 0.0;                      ///< texels on a side
  std::uint64_t map_texels = 0, map_bytes = 0;
  /// Median times of the map and the shading passes, all lights; NaN when not timed.
  double raster_ms = 0.0;
  /// Median times of camera and shadow rays, all lights: what the truth costs.
  double rays_ms = 0.0;
  Times raster;                               ///< its runs: the i-th of every map and shading pass together
  std::optional<compare::ShadowCosts> costs;  ///< of all lights together
  double load = std::numeric_limits<double>::quiet_NaN();  ///< of the machine, the most of its runs
  double exact_shadow_ms = 0.0;
  /// Fewer runs have no spread, and a time without one is not held against another.
  bool tells_time() const { return std::isfinite(raster_ms) && raster.runs.size() >= subtracted_runs; }
  bool derived = false;  ///< the times are those of the drawing that it was made from
  /// In measure(): by default the share of wrong pixels or the mean error, whichever is more, which are equal of yes-or-no
  /// shadows. With films what they are about: flips per receiver and second.
  /// Of what the measure is about; infinite where that is not known, so that it comes last.
  double error() const { return compare::ranked(measure().of(figures)); }
  bool is_filmed() const { return figures.shimmer.has_value(); }
  const compare::Figure& measure() const { return is_filmed() ? *compare::find_measure("shimmer") : *asked; }
};

/// a takes less time than b by more than their runs leave open (time_difference.h).
bool clearly_faster(const CellSummary& a, const CellSummary& b);

/// They differ in the constant bias alone, and were worked out from one drawing, so that they have one time.
bool share_one_drawing(const std::vector<CellSummary>& cells);

/// From a line of sweep.jsonl and its line of sweep_times.jsonl. Errors are ErrorKind::bad_input.
Expected<CellSummary> summarise(std::string_view line, std::string_view times);
Expected<std::vector<CellSummary>> summarise(const SweepLines& sweep);

/// Indices of the cells worth having for error against time, cheapest first: those that are clearly faster
/// than every cell with a smaller error. Of cells with equal errors, the one with the fewest texels and then
/// the fewest bytes among those that none of them is clearly faster than. Cells whose time has no spread (tells_time) are on no front, nor are those of one drawing.
std::vector<std::size_t> pareto_front(const std::vector<CellSummary>& cells);

}  // namespace gnomon::studies
