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
  bool unmoved_is_right =
      false;  ///< V5 is off by the casters' bias alone: it would not be with their own depth
};

/// The label of a pixel that is off, by the rules of docs/labels.md: those of wrong pixels, or those of errors of one
/// half and less.
Label label_of_error(const LowerClimb& lower, const LadderInput& input, Column& column, const WrongPixel& off,
                     const std::array<float, rung_count>& rungs);

/// The step that a label stands for: the one whose doing it is, which for a missed shadow that leaks is the
/// deciding one.
Cause step_of_label(Label label, const std::array<float, rung_count>& rungs);

// Whether the caster behind a sampling error is thinner than a texel: whether its surface lies under none of
// the texel centres nearby.

/// Asks of a missed shadow at the sampling step for some surface that stands between x and the light. Tells whether one
/// lies before the receiver's tangent plane on the light ray through one of the four texel centres around x.
bool missed_caster_is_known(const LadderInput& input, Column& column, const WrongPixel& wrong);

/// Asks of a false shadow at the sampling step for surfaces before the receiver's tangent plane on the ray through the
/// texel's centre. Tells whether one of them stands there, too, on the ray through a neighbouring centre. Three neighbours
/// are asked: those on the side that lies away from x.
bool false_caster_goes_on(const LadderInput& input, Column& column, const WrongPixel& wrong);

}  // namespace gnomon::compare
