// What the closed forms say of a map before any shadow is tested: the bias that each receiver would need, and
// how large texels are on the screen.
//
// Acne: on a receiver that is as flat as its tangent plane, h_u |dz/du| + h_v |dz/dv| (h half a texel) is the
// least constant bias without acne (DESIGN.md section 3).
//
// Aliasing: m is the side of a texel in pixels, as seen on the receiver: above 1 the map is too coarse there
// (Lloyd, Tuft, Yoon, Manocha 2006, "Warping and Partitioning for Low Error Shadow Maps", section 3: m =
// perspective part times projection part). Here both are taken over areas, so that they hold whatever way
// texels and pixels are turned:
//   perspective  sqrt(area of a texel / area of a pixel), both square to their own rays at the receiver
//   projection   sqrt(cosine to the eye / cosine to the light)
// and the measured m is 1 / sqrt(texels per pixel), from the map positions of neighbouring pixels.
#pragma once

#include <array>

#include "compare/ladder.h"

namespace gnomon::compare {

/// Theory of one light over its compared pixels.
TheoryStats predict(const LadderInput& input, const Image<Label>& labels);

}  // namespace gnomon::compare
