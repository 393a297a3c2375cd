// The tuner against a full grid on real milliseconds: does its answer cost no more than the grid's best?
#pragma once

#include <string>
#include <vector>

#include "benchmark/row.h"
#include "raster/renderer.h"
#include "studies/tune/full_grid.h"

namespace gnomon::bench {

struct TuningInput {
  Scene& scene;  ///< its camera and lights are the engine's while it draws
  const World& world;
  raster::Renderer& renderer;
  std::vector<studies::TuneFamily> families;
  double max_error = 0.0;  ///< share of wrong pixels, the tuner's goal
  ImageSize size{};
  int runs = 0;  ///< drawings in turn: of the tuner's finalists, and of its answer and the grid's best
};

/// Tries every family at the map sizes from 128 to 2048 texels, all lights compared. Errors are those of drawing.
Expected<studies::GridCheck> bench_tuning(const TuningInput& input, const Progress& progress);

/// The head of a terminal's table of tuning_line().
std::string tuning_head(double max_error, ImageSize size, int runs);
/// The tuner's answer and the grid's best on one scene.
std::string tuning_line(const std::string& scene, const studies::GridCheck& check);
/// What the answer costs against the grid's best, and how many drawings either took.
std::vector<BenchRow> tuning_rows(const std::string& scene, const studies::GridCheck& check);

}  // namespace gnomon::bench
