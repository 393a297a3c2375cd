// How often a pass is timed, by one rule for both renderers, so that their times stand for the same care.
#pragma once

#include <limits>
#include <numeric>

#include "scene/timing.h"

namespace gnomon {

/// What both are timed by where nothing else is asked for: three runs, and no further one when those made took
/// this long together.
inline constexpr int usual_runs = 3;
inline constexpr double usual_enough_ms = 25.0;
inline constexpr double never_enough_ms = std::numeric_limits<double>::infinity();

/// Whether there is to be another run after those in `made`: the first always, `most` in all.
inline bool times_again(const Times& made, int most, double enough_ms) {
  const double spent = std::accumulate(made.runs.begin(), made.runs.end(), 0.0);
  return static_cast<int>(made.runs.size()) < most && (made.runs.empty() || spent < enough_ms);
}

}  // namespace gnomon
