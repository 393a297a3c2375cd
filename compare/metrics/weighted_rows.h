// The inner loop of separable filters: a weighted sum of rows of floats, many columns at a time, by whatever
// the processor has (Highway). Each sum is taken in the order of the rows, one rounded product after the
// other, so that every instruction set gives the same bits.
#pragma once

#include <span>

namespace gnomon::compare {

/// sums[x] += weights[0] * rows[0][x] + weights[1] * rows[1][x] + ..., for x in [0, width).
void add_weighted_rows(std::span<const float* const> rows, std::span<const float> weights, float* sums,
                       int width);

}  // namespace gnomon::compare
