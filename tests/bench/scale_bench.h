// How a comparison grows: with triangles, with the picture, and with lights.
#pragma once

#include <vector>

#include "benchmark/row.h"
#include "tracer_bench.h"

namespace gnomon::bench {

/// `compare` of terrains of 1, 10 and 20 million triangles at 640 x 360, of `fence` in full HD, 4k and 8k, and of the teapot under 1,
/// 10 and 50 point lights at 320 x 180: processor seconds and the most memory, each beside the next smaller of its series. A row
/// carries the exponent between the two (BenchRow::exponent). Each is run once, and takes minutes. Prints each row as it is
/// measured.
std::vector<BenchRow> bench_scale(const Settings& settings);

}  // namespace gnomon::bench
