// One label for every error: the step that made it, and for some steps what was met there.
// docs/labels.md has the rules as a stranger could write them again.
#pragma once

#include "compare/truth/columns.h"

namespace gnomon::compare {

/// A pixel that is off V0, by more than one half (wrong) or less.
struct WrongPixel {
  std::size_t pixel;          ///< index in the image
  raytrace::TexelKey lookup;  ///< the texel that the biased test looked up
  Cause step;                 ///< deciding_step()
  bool false_shadow;          ///< drawn darker than the truth; otherwise a missed shadow
  bool exact_is_right;        ///< V5 is off, and would not be with the exact depth in place of the stored one
  float truth;                ///< V0
};

/// The label of a pixel that is off, by the rules of docs/labels.md: those of wrong pixels, or those of errors of one
/// half and less.
Label label_of_error(const LowerClimb& lower, const LadderInput& input, Column& column, const WrongPixel& off,
                     const std::array<float, rung_count>& rungs);

/// The step that a label stands for: the one whose doing it is, which for a missed shadow that leaks is the
/// deciding one.
Cause step_of_label(Label label, const std::array<float, rung_count>& rungs);

}  // namespace gnomon::compare
