// What a filter could have read around a receiver: where its tangent plane is truly lit and truly shadowed,
// within the texels that the filter reaches from the pixel.
#pragma once

#include "compare/ladder/ladder.h"

namespace gnomon::compare {

/// filter_reach_texels() at the mipmap level that the pixel reads.
double pixel_reach_texels(const LadderInput& input, std::size_t pixel);

/// Whether the receiver's tangent plane sees the light's centre, or is shadowed from it, anywhere in the
/// square of texels that the filter reads: probed at 5 x 5 to 9 x 9 points, no farther apart than 1.5 texels
/// while that suffices.
bool lit_within_reach(const LadderInput& input, std::size_t pixel);
bool shadowed_within_reach(const LadderInput& input, std::size_t pixel);

/// What pcf would draw if each of its comparisons were the truth about the receiver's tangent plane at the
/// centre of the texel compared: probed at 9 x 9 points of its kernel. Of other filters the same over the square of
/// texels that they read. `lower` knows what the rays through most of these centres meet.
double true_average(const LowerClimb& lower, const LadderInput& input, std::size_t pixel);

}  // namespace gnomon::compare
