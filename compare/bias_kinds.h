// Which kind of bias suits a drawing: constant, slope, normal offset, receiver plane and adaptive, each tried
// on the map as it was drawn with the double-precision twin of the hard test (biased_test.h), and each at the
// smallest setting that is hardly wrong more often than its best.
#pragma once

#include "compare/bias_curve.h"
#include "compare/ladder.h"

namespace gnomon::compare {

/// Settings that are hardly worse than the best: by at most one compared pixel in 100,000, or one wrong pixel
/// in fifty.
struct BiasRange {
  float from = 0.0f, to = 0.0f;  ///< the first such settings: from <= setting < to
};
/// `gaps` may be those of any setting that lights more pixels the larger it is.
BiasRange smallest_good_range(const GapLists& gaps);

/// The number with the fewest digits in [from, to), not far above from.
double short_number_in(double from, double to);

/// The best first. Empty where other biases do not follow from the drawing (biases_follow_from_gaps).
std::vector<BiasKind> compare_bias_kinds(const LadderInput& in, const Image<float>& truth,
                                         const Image<Label>& labels);

}  // namespace gnomon::compare
