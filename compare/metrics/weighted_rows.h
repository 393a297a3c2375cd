// The inner loop of separable filters: a weighted sum of rows of floats, many columns at a time, by whatever
// the processor has (Highway). Each sum is taken in the order of the rows, one rounded product after the
// other, so that every instruction set gives the same bits.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace gnomon::compare {

/// sums[x] += weights[0] * rows[0][x] + weights[1] * rows[1][x] + ..., for x in [0, width).
void add_weighted_rows(std::span<const float* const> rows, std::span<const float> weights, float* sums,
                       int width);

// The inner loop of SSIM, many columns at a time, by whatever the processor has (Highway); every instruction
// set gives the same bits.

/// Weighted sums of one row: of x, y, x^2, y^2 and xy.
using MomentRows = std::array<std::vector<double>, 5>;

/// Along columns: sums[j][c] = the sum over k of weights[k] times moment j of (first[k][c], second[k][c]),
/// for c in [0, width). Afterwards along rows, in place: sums[j][c] = the sum over k of weights[k] sums[j][c
/// + k], for those c where all of it is there.
void window_moments(std::span<const float* const> first, std::span<const float* const> second,
                    std::span<const double> weights, int width, MomentRows& sums);

}  // namespace gnomon::compare
