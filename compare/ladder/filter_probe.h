// What a filter could have read around a receiver: where its tangent plane is truly lit and truly shadowed,
// within the texels that the filter reaches from the pixel.
#pragma once

#include <string>
#include <string_view>

#include "compare/ladder/ladder.h"
#include "raster/options.h"

namespace gnomon::compare {

/// filter_reach_texels() at the mipmap level that the pixel reads.
double pixel_reach_texels(const LadderInput& input, std::size_t pixel);

/// Whether the receiver's tangent plane sees the light's centre, or is shadowed from it, anywhere in the
/// square of texels that the filter reads. It is probed at 5 x 5 to 9 x 9 points, no farther apart than 1.5
/// texels while that suffices.
bool lit_within_reach(const LadderInput& input, std::size_t pixel);
bool shadowed_within_reach(const LadderInput& input, std::size_t pixel);

/// What pcf would draw if each of its comparisons were the truth about the receiver's tangent plane at the
/// centre of the texel compared. It is probed at 9 x 9 points of its kernel. Of other filters the same over the
/// square of texels that they read. `lower` knows what the rays through most of these centres meet.
double true_average(const LowerClimb& lower, const LadderInput& input, std::size_t pixel);

// The filter of a technique: its kind, and how far it reaches. Its words are compare/result/map_words.h's.

/// "none", pcf's kernels, "penumbra" (pcss) or "moments".
std::string_view filter_kind(const raster::MapOptions& map);

/// How far from the receiver's place the filter can read, texels: half the width of its square; 0 for none.
/// For pcss that is the most it can be. `level`: the mipmap level that is read; a texel of it averages 2^level, rounded up,
/// texels on a side, and its neighbours are read too.
double filter_reach_texels(const raster::MapOptions& map, double level = 0.0);

// Light bleeding: what a filter of moments lets through deep inside a shadow, where no average of comparisons
// would.

/// Sums over the pixels that are shadowed at V0 ... V5, with nothing lit within the filter's reach, and lighter at V6 by
/// half a step of an 8-bit picture or more, of vsm, esm, evsm and msm (measure/pixel_measures.h).
class BleedingSum {
 public:
  void add(const LadderInput& input, const Climb& climb);
  void write_to(LightFigures& out) const;

 private:
  std::optional<BleedingStats> sums_;
  std::uint64_t compared_ = 0;
};

}  // namespace gnomon::compare
