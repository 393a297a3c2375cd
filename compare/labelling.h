// One label for every wrong pixel: the last step that made it wrong, and for some steps what was met there.
#pragma once

#include "compare/columns.h"

namespace gnomon::compare {

struct WrongPixel {
  std::size_t pixel;   ///< index in the image
  std::size_t lookup;  ///< index in the map of the texel that the biased test looked up
  Cause step;          ///< deciding_step()
  bool false_shadow;   ///< drawn darker than the truth; otherwise a missed shadow
};

/// The label of a wrong pixel (DESIGN.md section 3), with these refinements: a shadow missed at the slope
/// step (the receiver's depth, taken as constant, fell before its occluder) is a light leak, since acne is a
/// false shadow; a false shadow made by the bias (a negative one, or an offset into another texel) is acne on
/// the receiver's own sheet, else a false feature; a shadow missed at the filter step is a light leak where
/// nothing within the filter's reach is lit (bleeding.h), else blur.
Label label_wrong_pixel(const LadderInput& input, const Column& column, const WrongPixel& wrong);

}  // namespace gnomon::compare
