// The verdict in plain words: how many pixels are wrong, or how far off partly lit ones are, mostly why, and
// what another bias would leave.
#pragma once

#include <string>

#include "compare/comparison.h"

namespace gnomon::compare {

/// What is said of one light, in plain sentences.
struct Verdict {
  std::string headline;  ///< how many pixels are wrong, mostly why, and what the best bias would leave
  std::string detail;    ///< what is uncertain, and why no constant bias does better; may be empty
  std::string whole() const;
};
Verdict verdict_on(const Comparison& comparison, const LightComparison& light);

}  // namespace gnomon::compare
