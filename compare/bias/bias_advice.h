// What another bias would do, in plain words: the verdict's second half.
#pragma once

#include <string>

#include "compare/comparison.h"

namespace gnomon::compare {

/// Sentences; empty where there is nothing to say.
struct BiasAdvice {
  std::string best{};  ///< "Try --slope-bias 1: 0.08 % wrong."
  std::string none{};  ///< "No other bias does clearly better.": in place of it
  std::string
      more{};  ///< what does as well, what a constant alone would leave, and why none is right everywhere
};
/// `drawn`: the options that the light was drawn with; `measure`: what is advised by, one that counts_biases. Where gaps do not
/// tell all, it says only why none is right everywhere.
BiasAdvice bias_advice(const LightComparison& light, const raster::MapOptions& drawn, const Figure& measure);

/// Whether gaps tell what another bias leaves in this measure: they count the wrong pixels, whose share is the mean error
/// where nothing is partly lit.
bool counts_biases(const LightFigures& light, const Figure& measure);

/// Tells whether gaps alone tell all that is asked of another bias: nothing is partly lit, so that the share of wrong pixels is
/// the mean error, too.
bool gaps_tell(const LightFigures& light, const Figure& measure);

/// Is the bias that the verdict names if it is to be advised, and the share of wrong pixels that gaps tell of it.
struct LikelyBias {
  raster::Bias bias;
  double wrong_fraction = 0.0;
};
/// Needs the bias curve.
LikelyBias likeliest_bias(const LightComparison& light, const raster::MapOptions& drawn);

/// "none wrong", "7 pixels wrong", "0.8 % wrong": a share of a light's compared pixels; where the mean error was asked
/// for "mean error 0.8 %".
std::string left_text(double fraction, const LightComparison& light, const Figure& measure);

/// Returns how many of a light's compared pixels a share of them is; two that are off by exactly one half are one.
std::uint64_t wrong_pixels(double fraction, const LightComparison& light);

/// "No constant bias beside the slope bias of 1 fits all: 213 lit pixels stay dark below 2 texels, and …": of a best bias
/// that is not feasible. `texel_world`: what a bias in texels is a multiple of; `drawn`: the bias drawn with.
std::string contradiction(const BestBias& best, double texel_world, const raster::Bias& drawn);
/// Whether that sentence names both a least bias of lit pixels and a largest one of shadowed pixels.
bool names_both_bounds(const BestBias& best);

}  // namespace gnomon::compare
