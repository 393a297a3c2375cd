// The page's drawings as inline SVG: sharp in slides and print, coloured by the page's style sheet
// (page/src/report.css).
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"

namespace gnomon::compare {

/// Ticks at 1, 2 or 5 times a power of ten inside [min, max], about `wanted` of them; exact multiples.
std::vector<double> nice_ticks(double min, double max, int wanted);

/// One row of the budget's waterfall: a bar from `from` to `to` on the scale [min, max], with the zero line.
/// Stretches to the width of its table cell. `kind` is "minus", "plus" or "sum".
std::string waterfall_bar(double from, double to, double min, double max, std::string_view kind);

/// A plain bar of `share` in [0, 1].
std::string share_bar(double share, std::string_view kind);

/// Wrong pixels against the constant bias: false shadow, missed shadow and their sum; the best bias, the bias
/// used, and the interval where a bias is right everywhere.
std::string bias_chart(const LightComparison& light, double used_bias, std::string_view id);

/// Viridis from far (left) to near (right).
std::string depth_scale(std::string_view id);

}  // namespace gnomon::compare
