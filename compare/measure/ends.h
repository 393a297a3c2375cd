// The figures of a drawing that is not climbed.
#pragma once

#include "compare/ladder/ladder.h"

namespace gnomon::compare {

/// What `measure` needs of one light of a whole picture; figures that cost more are left NaN.
LightFigures measure_ends(const LadderInput& input, const Figure& measure);

}  // namespace gnomon::compare
