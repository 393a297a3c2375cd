// Shadow maps of moments in double precision. A texel holds averages of functions of the stored number x. The receiver's light is
// made of a bound of how much of what was averaged lies before it. The formulas are the papers'; the shaders' twin is
// shaders/technique.
#pragma once

#include <array>

#include "raster/options.h"
#include "scene/math.h"

namespace gnomon::judge {

using Averages = std::array<double, 4>;

/// What averages a texel holds, and how light is made of them: by the technique's own formula.
struct MomentFormula {
  raster::Technique technique = raster::Technique::vsm;  ///< vsm, esm, evsm or msm
  /// Its exponents (evsm: a negative one of 0, where none is stored), bleeding and bias.
  raster::FilterOptions filter{};
  double minimum_variance = 0.0;  ///< of x, of evsm of 2 x - 1
  double own_share = 1.0;         ///< the least share that a texel's own number has of its average

  /// Returns the light in [0, 1] that the technique makes of a texel's averages for a receiver at x.
  double light(const Averages& averages, double x) const;
  /// Returns the mean of x that a texel's averages tell.
  double mean(const Averages& averages) const;
  /// Returns the numbers between which one lies that has `own_share` of what was averaged.
  Interval own_numbers(const Averages& averages) const;
};

/// Returns the most that may lie at or beyond x of numbers with this mean and this mean square (Donnelly and Lauritzen 2006,
/// equation 5). Their variance counts as `least_variance` at least, and as four roundings of floats.
double chebyshev(double mean, double square, double x, double least_variance = 0.0);

/// Returns the least that lies before x of numbers whose first four powers have these means. The three points of support are
/// solved for directly (Peters and Klein 2015, section 3.2), the weights by Cramer's rule. Not a number where all are one number.
double least_share_before(const Averages& means, double x);

}  // namespace gnomon::judge
