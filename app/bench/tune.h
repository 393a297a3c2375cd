// The tuner against a full grid on real milliseconds: does its answer cost no more than the grid's best?
#pragma once

#include <string>
#include <vector>

#include "app/bench/row.h"
#include "app/console.h"
#include "scene/image.h"

namespace gnomon::app {

struct TuneBench {
  std::vector<std::string> scenes, techniques;  ///< techniques empty: all
  SceneArgument how;                            ///< the scenes are loaded
  double max_error = 0.01;                      ///< share of wrong pixels, the tuner's goal
  ImageSize size = quick_picture;
  int runs = 9;      ///< drawings in turn: of the tuner's finalists, and of its answer and the grid's best
  std::string json;  ///< file to write; empty: none
  bool quiet = false;
};

/// A line per scene on stdout. Errors are those of loading, drawing and writing.
Expected<void> run_tune_bench(const TuneBench& bench, Console& console);

}  // namespace gnomon::app
