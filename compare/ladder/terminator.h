// The shadow terminator: where a mesh's triangle and the smooth normal that shades it do not agree on whether they face the
// light. Both renderers let the triangle decide, so that none of it is an error of the map.
#pragma once

#include "compare/ladder/ladder.h"

namespace gnomon::compare {

/// Counts under the light's centre; docs/labels.md has the definition. Nothing where no mesh has normals of its own.
TerminatorCount count_terminator(const LadderInput& in, const Image<Label>& labels);

}  // namespace gnomon::compare
