// Light bleeding: what a filter of moments lets through deep inside a shadow, where no average of comparisons
// would.
#pragma once

#include "compare/ladder/ladder.h"

namespace gnomon::compare {

/// Of the pixels that are shadowed at V0 ... V5, with nothing lit within the filter's reach, and lighter at
/// V6 by half a step of an 8-bit picture or more. Zero but for vsm, esm, evsm and msm.
/// A picture comes in parts, each of whole rows, from the top.
class BleedingSum {
 public:
  void add(const LadderInput& input, const std::array<Image<float>, rung_count>& rungs,
           const Image<Label>& labels);
  BleedingStats stats() const;

 private:
  BleedingStats sums_;
  std::uint64_t compared_ = 0;
};

}  // namespace gnomon::compare
