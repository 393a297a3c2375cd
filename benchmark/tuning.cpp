#include "benchmark/tuning.h"

#include <fmt/core.h>

#include <algorithm>

#include "scene/base/expected.h"
#include "scene/base/parallel.h"

namespace gnomon::bench {
namespace {

constexpr double allowed = 1.1;  // of the grid's best cost

std::vector<int> grid_sizes(int limit) {
  std::vector<int> sizes;
  for (int size = 128; size <= std::min(limit, 2048); size *= 2) sizes.push_back(size);
  return sizes;
}

// Of techniques whose drawings do not tell every bias.
std::vector<raster::Bias> grid_biases() {
  std::vector<raster::Bias> biases;
  for (const double texels : {0.25, 1.0, 4.0}) biases.push_back({texels, raster::BiasUnit::texel});
  return biases;
}

compare::Setting base_setting(const TuningInput& input) {
  compare::Setting setting;
  setting.raster.size = setting.raytrace.size = input.size;
  setting.raster.runs = input.runs;
  setting.raytrace.picture = false;
  setting.camera = input.scene.camera;
  setting.lights = input.scene.lights;
  for (std::uint32_t i = 0; i < setting.lights.size(); ++i) setting.compared.push_back(i);
  return setting;
}

constexpr const char* columns = "{:<14}{:>7}{:>10}{:>7}{:>8}{:>8}{:>7}  {}\n";

}  // namespace

Expected<studies::GridCheck> bench_tuning(const TuningInput& input, const Progress& progress) {
  studies::TuneOptions options;
  options.goal.max_error = compare::Threshold{compare::find_measure("wrong"), input.max_error};
  options.sizes = grid_sizes(input.renderer.info().max_map_size);
  options.families = input.families;
  studies::Engine engine(input.scene, input.world, input.renderer, false);
  const double drawings_expected = static_cast<double>(options.families.size() * options.sizes.size() * 3);
  return studies::check_against_grid(
      engine, base_setting(input), options, grid_biases(), input.runs,
      [&](const studies::TuneFamily& family, int size, std::uint64_t drawings) {
        progress(fmt::format("{}: {}, {} texels", input.scene.name, family.name, size),
                 static_cast<double>(drawings) / drawings_expected);
      });
}

std::string tuning_head(double max_error, ImageSize size, int runs) {
  return fmt::format(
             "At most {:.3g} % wrong, {}x{} pixels, milliseconds, the least of {} in turn; goal: a "
             "ratio of at most {}\n",
             100.0 * max_error, size.width, size.height, runs, allowed) +
         fmt::format(columns, "scene", "cells", "good ones", "drawn", "tuned", "best", "ratio",
                     "the tuner's answer; the grid's best");
}

std::string tuning_line(const std::string& scene, const studies::GridCheck& check) {
  const std::string name = one_line(scene);
  if (!check.tuned.feasible || !check.best)
    return fmt::format("{:<14}{:>7}{:>10}{:>7}  {}\n", name, check.cells, check.good_cells,
                       check.tune_drawings,
                       check.tuned.feasible == check.best.has_value() ? "no setting meets the goal"
                                                                      : "only one of them meets the goal");
  const auto& families = check.tuned.families;
  const studies::Attempt& answer = *families[check.tuned.winner].answer;
  const std::string names_of_both =
      fmt::format("{} {}; {} {}", families[check.tuned.winner].family.name, answer.size,
                  families[check.best->family].family.name, check.best->attempt.size);
  return fmt::format(columns, name, check.cells, check.good_cells, check.tune_drawings,
                     fmt::format("{:.1f}", check.tuned_cost), fmt::format("{:.1f}", check.best_cost),
                     fmt::format("{:.3f}", check.ratio()), names_of_both);
}

std::vector<BenchRow> tuning_rows(const std::string& scene, const studies::GridCheck& check) {
  std::vector<BenchRow> rows;
  const BenchPeer grid{"full grid", check.best_cost};
  const int threads = threads_in_use();
  if (check.tuned.feasible && check.best)
    rows.push_back({"tune's answer", scene, threads, check.tuned_cost, "ms", false, grid, 1.0 / allowed});
  const BenchPeer drawings{"full grid", static_cast<double>(check.grid_drawings)};
  rows.push_back({"tune's drawings", scene, threads, static_cast<double>(check.tune_drawings), "drawings",
                  false, drawings});
  return rows;
}

}  // namespace gnomon::bench
