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

/// How often a pass that is subtracted from another one, or another one from it, is run whatever its runs took: a
/// difference is known no better than its runs agree, and of fewer than three nobody can tell how well that is.
inline constexpr int subtracted_runs = 3;

/// Whether there is to be another run after those in `made`: `most` in all, and beyond the first `least` of them only
/// as long as all took less than `enough_ms` together.
inline bool times_again(const Times& made, int most, double enough_ms, int least = 1) {
  const double spent = std::accumulate(made.runs.begin(), made.runs.end(), 0.0);
  const int count = static_cast<int>(made.runs.size());
  return count < most && (count < least || spent < enough_ms);
}

}  // namespace gnomon
