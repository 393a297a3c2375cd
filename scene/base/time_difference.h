// What one pass takes beyond another, and how well that is known. Whatever subtracts times, or asks which of two is the
// less, asks here, so that every view says the same.
#pragma once

#include <span>

#include "scene/base/timing.h"

namespace gnomon {

/// Milliseconds with the interval that the runs leave them: of what a pass takes beyond another one (beyond_part), or of a
/// pass itself (with_spread).
struct TimeDifference {
  Times
      pairs;  ///< run by run, as measured: below 0 where what else the machine did was more than the difference
  double low = 0.0, median = 0.0, high = 0.0;  ///< low <= median <= high
  bool told = false;  ///< the interval does not hold 0: the pass takes longer, beyond the spread of the runs

  bool timed() const { return !pairs.runs.empty(); }
  /// Adds another difference, such as another light's; a part that is not timed adds nothing.
  TimeDifference& operator+=(const TimeDifference& other);
  /// With what is known by itself, such as the map beside its lookups.
  TimeDifference& operator+=(double ms);
};

/// What a single time may be off by on a busy machine, as a share of it.
inline constexpr double single_run_share = 0.25;

/// A strip of a picture whose two passes were run in turn: the i-th run of the one beside the i-th of the other.
struct TimedStrip {
  Times whole, part;
};

/// Subtracts a part of a pass from it, strip by strip. What else the machine does can only add, so the difference is that of
/// the least times of each strip. Its interval reaches to either side by twice the standard error, which leaving out one run
/// after the other tells of each strip. (Efron and Tibshirani 1993, "An Introduction to the Bootstrap", section 11.2.) The
/// strips' variances add up. One run, and two of a picture in one strip, say nothing of their spread: they are taken to be
/// off by a quarter of the shorter pass (single_run_share). A part takes no
/// more than the whole, so nothing of the interval lies below 0; where the difference does, it reaches up as far as that
/// reaches down.
TimeDifference beyond_part(std::span<const TimedStrip> strips);
/// Does so for passes that were run in one piece.
TimeDifference beyond_part(const Times& whole, const Times& part);

/// Returns the median of a pass with an interval. That goes from the lower to the upper quartile of its runs, of three from the
/// least to the greatest, and as far again to either side. Of fewer than three runs it is a quarter to either side.
TimeDifference with_spread(const Times& pass);

/// Whether `a` takes less time than `b` by more than their runs leave open; as fast are two of which neither does.
/// `in_turn`: their runs were made side by side, and are compared so; else every run of the one with every run of the other.
bool clearly_faster(const Times& a, const Times& b, bool in_turn);

}  // namespace gnomon
