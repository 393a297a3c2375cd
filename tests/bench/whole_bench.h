// What whole commands cost, as a user starts them, over what they are made of.
#pragma once

#include <vector>

#include "benchmark/row.h"
#include "tracer_bench.h"

namespace gnomon::bench {

/// `compare` over `raster` and `raytrace` of the same picture, in processor time and by the clock, on built-in scenes, on a
/// terrain of a million triangles and on the bunny where it is there; a sweep of 1,000 biases, and 60 frames of `shimmer`, over
/// one `compare`. All at each of Settings::whole_sizes, but the last two at the first alone. The rows of bench_scale() follow.
/// Prints each row as it is measured.
std::vector<BenchRow> bench_whole(const Settings& settings);

}  // namespace gnomon::bench
