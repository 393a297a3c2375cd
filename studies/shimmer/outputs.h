// Everything that a film of shadows is written as.
#pragma once

#include <string>

#include "studies/shimmer/shimmer.h"

namespace gnomon::compare {

struct ShimmerProvenance {
  std::string command;  ///< as the user could type it again
  std::uint64_t seed = 0;
  double total_ms = 0.0;
};

/// Flips over all pairs of following frames and receivers, a second.
double flips_per_receiver_second(const ShimmerOptions& options, const ShimmerLight& light);

/// World area that the drawn and the true shadow sweep, over the length of the true shadow's edge: how fast the
/// edges go, back and forth counting alike. NaN where there is no edge.
struct EdgeSpeed {
  double drawn_world_per_second = std::numeric_limits<double>::quiet_NaN();
  double true_world_per_second = std::numeric_limits<double>::quiet_NaN();
  double drawn_texels_per_frame = std::numeric_limits<double>::quiet_NaN();  ///< of the first frame's map
  double true_texels_per_frame = std::numeric_limits<double>::quiet_NaN();
};
EdgeSpeed edge_speed(const ShimmerOptions& options, const ShimmerLight& light);

/// The result file (studies/shimmer/shimmer.schema.json), schema "gnomon/shimmer/1".
std::string shimmer_json(const Shimmer& shimmer, const ShimmerProvenance& from);
/// One plain sentence on one light.
std::string shimmer_sentence(const Shimmer& shimmer, const ShimmerLight& light);
/// The summary for stdout, at most 80 columns wide.
std::string shimmer_table(const Shimmer& shimmer);

}  // namespace gnomon::compare
