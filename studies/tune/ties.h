// What the spread of the times leaves open: families that the times cannot tell from the best, and settings
// that cost too much by no more than one time may be off.
#pragma once

#include "studies/tune/tune.h"

namespace gnomon::compare {

struct Ties {
  std::size_t chosen = 0;           ///< the family to prefer, an index
  std::vector<std::size_t> others;  ///< that tie with it
};

/// `best` is the one of `families` that comes first by error and least time, and has an answer whose times
/// were measured. Another ties with it where that is not clearly faster (time_difference.h): they are as fast; where the goal is a time, its error has to be the same as well. Of these the one is chosen that
/// renders no more texels, takes no more bytes and casts no more rays than `best`, and less of something:
/// that holds on any machine.
Ties ties_with(std::size_t best, const std::vector<FamilyResult>& families, const TuneGoal& goal);

/// Where the goal is a time: of every family the setting tried that errs least, where it errs less than the
/// answer of `winner` and its one time lies over the limit by no more than such a time may be off.
std::vector<JustOver> just_over_limit(std::size_t winner, const std::vector<FamilyResult>& families,
                                      const TuneGoal& goal);

}  // namespace gnomon::compare
