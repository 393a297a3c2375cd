// The biased test of rung V5, and the same with the exact depth in place of the stored one: what is wrong
// with the one and right with the other is the stored number's fault.
#pragma once

#include "compare/ladder.h"

namespace gnomon::compare {

/// Whether a stored depth is the exact one up to the rounding of the shaders' floats. Such a depth counts as
/// exact: a floor that faces the light squarely has one depth all over, and the map's float of it may fall to
/// either side, which no rasterizer that rounds both sides alike would see.
inline bool is_exact(const LadderInput& input, double stored_depth, double exact_depth) {
  return std::abs(stored_depth - exact_depth) <= input.record.rounding.float_world;
}

/// The gap of rung V5, in double precision (biased_test.h). `group`: the pixel's; `lookup` receives the texel
/// looked up.
double gap_with_bias(const LowerClimb& lower, const LadderInput& input, std::size_t group, std::size_t pixel,
                     raytrace::TexelKey& lookup);

/// The gap of V5 to the surface that the looked-up texel stores, at the exact depth at which the ray through
/// the texel's centre meets it: the ray's first hit, or with culling the stored one (stored_surface.h); -infinity
/// where the ray meets nothing. None where the depth is no surface's (midpoint), or with culling nothing is stored.
/// `group`: the pixel's.
std::optional<double> exact_gap(const LowerClimb& lower, const LadderInput& input, std::size_t group,
                                std::size_t pixel);

}  // namespace gnomon::compare
