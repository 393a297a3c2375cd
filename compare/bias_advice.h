// What another bias would do, in plain words: the verdict's second half.
#pragma once

#include <string>

#include "compare/comparison.h"

namespace gnomon::compare {

/// " A slope bias of 1 (--slope-bias 1) would leave 0.08 %. …", each sentence with a space before it. Empty
/// where there is nothing to say.
std::string bias_advice(const LightComparison& light);

/// " No constant bias can be right everywhere: 213 lit pixels need 0.031 (2 texels) or more, …": of a light
/// whose best bias is not feasible.
std::string contradiction(const LightComparison& light);

}  // namespace gnomon::compare
