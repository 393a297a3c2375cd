// The inner loop of SSIM, many columns at a time, by whatever the processor has (Highway); every instruction
// set gives the same bits.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace gnomon::compare {

/// Weighted sums of one row: of x, y, x^2, y^2 and xy.
using MomentRows = std::array<std::vector<double>, 5>;

/// Along columns: sums[j][c] = the sum over k of weights[k] times moment j of (first[k][c], second[k][c]),
/// for c in [0, width). Afterwards along rows, in place: sums[j][c] = the sum over k of weights[k] sums[j][c
/// + k], for those c where all of it is there.
void window_moments(std::span<const float* const> first, std::span<const float* const> second,
                    std::span<const double> weights, int width, MomentRows& sums);

}  // namespace gnomon::compare
