// The verdict in plain words: how many pixels are wrong, or how far off partly lit ones are, mostly why, and
// what another bias or another map size would leave.
#pragma once

#include <string>

#include "compare/comparison.h"

namespace gnomon::compare {

/// What is said of one light, in plain sentences.
struct Verdict {
  std::string error;        ///< how many pixels are wrong, and mostly why
  std::string advice{};     ///< what would help, and what that would leave; may be empty
  std::string uncertain{};  ///< how many pixels are; the first sentence of `detail`
  std::string detail{};     ///< what is uncertain, and why no constant bias does better; may be empty
  /// The error and the advice.
  std::string headline() const;
  std::string whole() const;
};
Verdict verdict_on(const Comparison& comparison, const LightComparison& light);

}  // namespace gnomon::compare
