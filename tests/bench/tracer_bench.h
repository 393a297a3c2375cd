// The tracer against Embree 3 on one scene. Both get the same rays; hits and occlusions are counted and compared.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "bench_scenes.h"
#include "benchmark/row.h"

namespace gnomon::bench {

struct Settings {
  ImageSize size{1920, 1080};
  int runs = 5;
  std::string json;
  std::vector<std::string> scenes;
  std::string target;  ///< of instruction_sets(); empty: the best that the machine has
  /// stdout is the rows' where they go there.
  std::FILE* table() const { return json == "-" ? stderr : stdout; }
};

/// Prints each row as it is measured.
std::vector<BenchRow> bench_tracer(const BenchScene& scene, const Settings& settings);

}  // namespace gnomon::bench
