// Every constant bias of one drawing at once. A pixel is drawn lit from the bias on that reaches its gap, and
// so is rung V5 from the double-precision gap on. Along ascending biases a pixel passes through at most three
// states, each with its own label. Adding up where states begin and end gives every number of every bias in
// one pass over the pixels, to the last bit those of a comparison of its own.
#pragma once

#include <span>
#include <vector>

#include "compare/ladder/ladder.h"

namespace gnomon::studies {

/// All rungs below V5 are 0 or 1, so that every sum over pixels is exact in any order: false for lights with
/// a size.
bool biases_add_up(const compare::LowerClimb& lower);

/// A pixel that is drawn wrong at the biases number `from` to `to` (excluded), counted from the smallest.
struct WrongSpan {
  std::uint32_t pixel = 0, from = 0, to = 0;
  compare::Label label = compare::Label::right;
  bool false_shadow = false;
};

/// The numbers of every bias, and what is wrong where.
struct BiasTable {
  std::vector<compare::LightComparison> lights;  ///< by bias as asked for, without images
  std::vector<std::size_t> place;                ///< the bias asked for is the place-th smallest
  std::vector<WrongSpan> spans;
};

/// What is said of the light at each bias (world units, in any order), without images. `drawn` is the
/// comparison of the drawing as it was made; `input` holds that drawing.
BiasTable compare_biases(const compare::LowerClimb& lower, const compare::LadderInput& input,
                         const compare::LightComparison& drawn, std::span<const double> biases,
                         int bias_curve_points);

}  // namespace gnomon::studies
