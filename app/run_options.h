// What every command takes that compares a picture with the truth.
#pragma once

#include "app/options.h"

namespace gnomon::app {

struct RunOptions {
  raster::Backend backend = raster::Backend::automatic;
  int threads = 0;                                ///< 0: all
  std::optional<std::optional<double>> exposure;  ///< an empty one: automatic; none: the scene's
  std::string trace;                              ///< file for the stages of the run; empty: none
  std::uint64_t seed = 0;                         ///< of the samples of lights with size
};
/// --backend, --threads, --exposure, --seed.
void add_run_options(CLI::App& command, RunOptions& options);

}  // namespace gnomon::app
