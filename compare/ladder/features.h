// Whether the caster behind a sampling error is thinner than a texel: whether its surface lies under none of
// the texel centres nearby.
#pragma once

#include "compare/ladder/labelling.h"

namespace gnomon::compare {

/// Of a missed shadow at the sampling step: some surface that stands between x and the light lies, before the
/// receiver's tangent plane, on the light ray through one of the four texel centres around x.
bool missed_caster_is_known(const LadderInput& input, Column& column, const WrongPixel& wrong);

/// Of a false shadow at the sampling step: some surface that stands before the receiver's tangent plane on
/// the ray through the texel's centre does so too at one of the three neighbouring centres on the side that
/// lies away from x.
bool false_caster_goes_on(const LadderInput& input, Column& column, const WrongPixel& wrong);

}  // namespace gnomon::compare
