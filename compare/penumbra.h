// How wide the soft shadows of a light with size are, in truth and as drawn.
#pragma once

#include "compare/ladder.h"

namespace gnomon::compare {

/// At every pair of neighbouring pixels of one object between which the truth crosses one half, walks in the
/// picture straight across the edge as it lies on the receiver (the truth's gradient over a 7x7 window) both
/// ways, on the drawn shadow from its own crossing nearest to there: the penumbra is the way from a tenth to
/// nine tenths visible, the umbra the way below a tenth beyond it, both in world units on the receiver.
/// Visibility and receivers are taken between pixel centres, so that a width is not rounded to whole pixels;
/// of an edge that is sharper than a pixel it is still 0.8 pixel. `labels`: labels_climbed().
PenumbraStats measure_penumbra(const LadderInput& input, const Image<float>& truth,
                               const Image<Label>& labels);

}  // namespace gnomon::compare
