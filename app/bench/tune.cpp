#include "app/bench/techniques.h"

#include <fmt/core.h>

#include <algorithm>

#include "app/options/options.h"
#include "app/outputs/render_json.h"
#include "app/session.h"
#include "app/tune/tune_families.h"
#include "raster/technique_traits.h"
#include "scene/base/expected.h"
#include "scene/base/parallel.h"
#include "studies/tune/full_grid.h"

namespace gnomon::app {
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

compare::Setting base_setting(const LoadedScene& loaded, const TuneBench& bench) {
  compare::Setting setting;
  setting.raster.size = setting.raytrace.size = bench.size;
  setting.raster.runs = bench.runs;
  setting.raytrace.picture = false;
  setting.camera = loaded.scene->camera;
  setting.lights = loaded.scene->lights;
  for (std::uint32_t i = 0; i < setting.lights.size(); ++i) setting.compared.push_back(i);
  return setting;
}

Expected<compare::GridCheck> check_scene(const LoadedScene& loaded, const TuneBench& bench,
                                         Console& console) {
  const auto renderer = make_renderer(raster::Backend::automatic, loaded);
  if (!renderer) return fail(renderer.error());
  const compare::Setting base = base_setting(loaded, bench);
  const auto all = make_families({});
  if (!all) return fail(all.error());
  const auto fitting = fitting_families(*all, *loaded.scene, base.compared);
  if (!fitting) return fail(fitting.error());
  compare::TuneOptions options;
  options.goal.max_error = compare::Threshold{compare::find_measure("wrong"), bench.max_error};
  options.sizes = grid_sizes((*renderer)->info().max_map_size);
  for (const OptionFamily& family : *fitting) {
    const std::string technique(raster::technique_name(family.tuned.map.technique));
    const auto& named = bench.techniques;
    if (named.empty() || std::find(named.begin(), named.end(), technique) != named.end())
      options.families.push_back(family.tuned);
  }
  compare::Engine engine(*loaded.scene, *loaded.world, **renderer, false);
  const auto progress = [&](const compare::TuneFamily& family, int size, std::uint64_t drawings) {
    console.progress(fmt::format("{}: {}, {} texels", loaded.scene->name, family.name, size),
                     static_cast<double>(drawings) /
                         static_cast<double>(options.families.size() * options.sizes.size() * 3));
  };
  return check_against_grid(engine, base, options, grid_biases(), bench.runs, progress);
}

constexpr const char* head = "{:<14}{:>7}{:>10}{:>7}{:>8}{:>8}{:>7}  {}\n";

std::string table_row(const std::string& scene, const compare::GridCheck& check,
                      const std::vector<std::string>& names) {
  if (!check.tuned.feasible || !check.best)
    return fmt::format("{:<14}{:>7}{:>10}{:>7}  {}\n", scene, check.cells, check.good_cells,
                       check.tune_drawings,
                       check.tuned.feasible == check.best.has_value() ? "no setting meets the goal"
                                                                      : "only one of them meets the goal");
  const compare::Attempt& answer = *check.tuned.families[check.tuned.winner].answer;
  const std::string names_of_both = fmt::format("{} {}; {} {}", names[check.tuned.winner], answer.size,
                                                names[check.best->family], check.best->attempt.size);
  return fmt::format(head, scene, check.cells, check.good_cells, check.tune_drawings,
                     fmt::format("{:.1f}", check.tuned_cost), fmt::format("{:.1f}", check.best_cost),
                     fmt::format("{:.3f}", check.ratio()), names_of_both);
}

void add_rows(const std::string& scene, const compare::GridCheck& check, std::vector<BenchRow>& rows) {
  const BenchPeer grid{"full grid", check.best_cost};
  const int threads = threads_in_use();
  BenchRow cost{"tune's answer", scene, threads, check.tuned_cost, "ms", false, grid, 1.0 / allowed};
  if (check.tuned.feasible && check.best) rows.push_back(std::move(cost));
  const BenchPeer drawings{"full grid", static_cast<double>(check.grid_drawings)};
  rows.push_back({"tune's drawings", scene, threads, static_cast<double>(check.tune_drawings), "drawings",
                  false, drawings});
}

}  // namespace

Expected<void> run_tune_bench(const TuneBench& bench, Console& console) {
  RunFiles files;
  for (const std::string& scene : bench.scenes) files.reads(bench.how.named(scene));
  files.writes("--json", bench.json);
  if (const auto fine = files.check(); !fine) return fine;
  const bool with_table = bench.json != "-" && !bench.quiet;
  if (with_table)
    print_data(
        fmt::format("At most {:.3g} % wrong, {}x{} pixels, milliseconds, the least of {} in turn; goal: a "
                    "ratio of at most {}\n",
                    100.0 * bench.max_error, bench.size.width, bench.size.height, bench.runs, allowed) +
        fmt::format(head, "scene", "cells", "good ones", "drawn", "tuned", "best", "ratio",
                    "the tuner's answer; the grid's best"));
  std::vector<BenchRow> rows;
  for (const std::string& scene : bench.scenes) {
    const auto loaded = load(bench.how.named(scene), files, console);
    if (!loaded) return fail(loaded.error());
    const auto check = check_scene(*loaded, bench, console);
    if (!check) return fail(check.error());
    console.clear_progress();
    std::vector<std::string> names;
    for (const compare::FamilyResult& family : check->tuned.families) names.push_back(family.family.name);
    if (with_table) print_data(table_row(one_line(loaded->scene->name), *check, names));
    add_rows(loaded->scene->name, *check, rows);
  }
  return hand_out_json(bench.json, bench_json(rows));
}

}  // namespace gnomon::app
