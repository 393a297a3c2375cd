// One render tells of every bias. A hard test shadows a receiver iff its gap exceeds the bias. So the sorted
// gaps of the truly lit and the truly shadowed pixels give the exact error of every constant bias.
#pragma once

#include <vector>

#include "compare/comparison.h"

namespace gnomon::compare {

/// Gaps of the compared pixels, sorted ascending, by what the truth says of them; under a light with size a
/// pixel counts as lit that sees more than half of it. One that sees exactly half is as near to right as to wrong at any
/// bias, and in neither list.
struct GapLists {
  std::vector<float> lit, shadowed;
  /// Lit pixels that are dark because their texel lies elsewhere: a bias that lights them has lifted the shadow off its caster.
  /// They count, but no bias is the best one for their sake. Empty where nothing is advised from the lists.
  std::vector<float> lit_by_lifting{};
  std::uint64_t lit_left_out = 0;  ///< lit pixels whose gap is not above 0, where they are not in the list
  std::uint64_t ties = 0;          ///< pixels of which half the light is seen
  std::uint64_t count() const {
    return lit_left_out + lit.size() + lit_by_lifting.size() + shadowed.size() + ties;
  }
  /// Returns the share of wrong pixels where so many of the lists are wrong; ties count one half.
  double wrong_fraction(std::uint64_t wrong) const;

  /// Exact counts at a constant bias (rounded to float, as the shader has it), and the share with its ties.
  BiasCurvePoint at(double bias) const;
  double wrong_fraction_at(double bias) const { return at(bias).wrong_fraction; }
};

/// Compared pixels of which exactly half the light is seen.
std::uint64_t count_ties(const Image<float>& truth, const Image<Label>& labels);
/// The gaps of the compared pixels that are lit, or shadowed, in the order of the pixels.
std::vector<float> gaps_where(const raster::LightRecord& record, const Image<float>& truth,
                              const Image<Label>& labels, bool lit);
GapLists sort_gaps(const raster::LightRecord& record, const Image<float>& truth, const Image<Label>& labels);

/// The bias >= 0 with the fewest wrong pixels. It lies in the first interval between neighbouring gaps where
/// the least is reached: a tenth above its start, or at its middle where that comes first.
BestBias find_best_bias(const GapLists& gaps);

/// `points` biases from 0 to four texels, or further where the current or the best bias lies beyond; both are
/// among them.
std::vector<BiasCurvePoint> draw_bias_curve(const GapLists& gaps, double texel_world, double current,
                                            double best, int points);

/// A frame drawn with these options shadows a pixel iff its gap exceeds the constant bias: every other
/// constant bias follows from it.
bool biases_follow_from_gaps(const raster::MapOptions& map);
/// Tells whether the biases of what was drawn follow from gaps: not where a shader of the user's own decided, or a map that
/// is not known.
bool biases_follow_from_gaps(const raster::RasterFrame& drawn);

/// The map's bias with another constant, in the unit that draws it: texels of `texel_world` where the
/// constant scales (raster::scales_bias), else world units.
raster::Bias with_constant(const raster::MapOptions& map, double constant_world, double texel_world);
/// Rounded to three significant digits, as advice is printed and asked for.
double rounded_to_three(double number);
/// Its constant with three digits.
raster::Bias with_three_digits(raster::Bias bias);

/// Turns a record into that of another constant bias. `primitive`: what each pixel shows.
void rebias(const Image<std::uint32_t>& primitive, double constant_world, raster::LightRecord& record);

}  // namespace gnomon::compare
