// What one pass takes beyond another, and how well that is known. Whatever subtracts times, or asks which of two is the
// less, asks here, so that every view says the same.
#pragma once

#include "scene/base/timing.h"

namespace gnomon {

/// The milliseconds that a pass takes beyond another one, with the interval that their runs leave them. The interval
/// reaches from the lower to the upper quartile of the differences (of three from the least to the greatest), and as far
/// again to either side as the quartiles lie apart: of three runs that is Student's interval of 95 %. Fewer say nothing of
/// their spread: a difference of theirs is taken to be off by a quarter of the shorter pass (single_run_share).
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

/// Subtracts a part of a pass that was run in turn with it: the i-th run of the one beside the i-th of the other. A part
/// takes no more than the whole, so nothing of the interval lies below 0; where pairs do, it reaches up as far as these
/// reach down.
TimeDifference beyond_part(const Times& whole, const Times& part);

/// Whether `a` takes less time than `b` by more than their runs leave open; as fast are two of which neither does.
/// `in_turn`: their runs were made side by side, and are compared so; else every run of the one with every run of the other.
bool clearly_faster(const Times& a, const Times& b, bool in_turn);

}  // namespace gnomon
