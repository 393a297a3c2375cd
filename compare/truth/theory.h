// What the closed forms say of a map before any shadow is tested: the bias that each receiver would need, and
// how large texels are on the screen.
//
// Acne: let a receiver be as flat as its tangent plane, and h be half a texel. Then h_u |dz/du| + h_v |dz/dv|
// is the least constant bias without acne (docs/design.md, section 3).
//
// Aliasing: m is the side of a texel in pixels, as seen on the receiver. Above 1 the map is too coarse there.
// The source is Lloyd, Tuft, Yoon, Manocha 2006, "Warping and Partitioning for Low Error Shadow Maps",
// section 3: m = perspective part times projection part. Here both are taken over areas, so that they hold
// whatever way texels and pixels are turned:
//   perspective  sqrt(area of a texel / area of a pixel), both square to their own rays at the receiver
//   projection   sqrt(cosine to the eye / cosine to the light)
// and the measured m is 1 / sqrt(texels per pixel), from the map positions of neighbouring pixels.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "compare/ladder/ladder.h"
#include "scene/image.h"

namespace gnomon::compare {

/// What TheoryStats is made of: of each compared pixel the acne-free bias, perspective, projection, their
/// product (aliasing) and the measured aliasing, in that order; infinite where there is none.
using TheoryValues = std::array<std::vector<double>, 5>;
/// Returns the values for those rows of the images; the row below them must be there. picture_height: of the whole picture.
TheoryValues theory_values(const LadderInput& input, const Image<Label>& labels, const PictureRows& rows,
                           int picture_height);
Distribution& distribution_of(TheoryStats& stats, std::size_t value);
/// The median, the 90th and 99th percentile and the largest of the finite values, which this puts into another
/// order.
Distribution distribution(std::span<double> values);

}  // namespace gnomon::compare
