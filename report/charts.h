// The page's drawings as inline SVG: sharp in slides and print, coloured by the page's style sheet
// (page/src/report.css).
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"

namespace gnomon::compare {

/// Ticks at 1, 2 or 5 times a power of ten inside [min, max], about `wanted` of them; exact multiples.
std::vector<double> nice_ticks(double min, double max, int wanted);

/// What a step of the budget took away (to the left of zero) and what it added (to the right).
struct TwoSides {
  double darker = 0.0, lighter = 0.0;
};
/// One row of the budget, stretched to the width of its table cell: pale what the step did, in full colour
/// what is left of it in wrong pixels. `scale`: what reaches the cell's end.
std::string two_sided_bar(const TwoSides& done, const TwoSides& left, double scale);

/// A plain bar of `share` in [0, 1].
std::string share_bar(double share, std::string_view kind);

/// Wrong pixels against the constant bias: false shadow, missed shadow and their sum; the best bias, the bias
/// used, and the interval where a bias is right everywhere.
std::string bias_chart(const LightComparison& light, double used_bias, std::string_view id);

/// Viridis from far (left) to near (right).
std::string depth_scale(std::string_view id);

}  // namespace gnomon::compare
