// gnomon_bench: the tracer against Embree 3 in one process, the two in turn, so that only ratios are to be
// believed. Rows: gnomon/bench/1.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>

#include "app/process/machine.h"
#include "instruction_set.h"
#include "raytrace/packets/shadow_pass.h"
#include "scene/files/write_file.h"
#include "tracer_bench.h"
#include "whole_bench.h"

namespace gnomon::bench {
namespace {

/// Writes the rows as the program does (app/outputs/render_json.h).
Expected<void> hand_out(const std::string& path, const std::string& json) {
  if (path.empty()) return {};
  if (path == "-") {
    fmt::print("{}", json);
    return {};
  }
  if (const auto made = make_folder_for(path); !made) return made;
  return write_file(path, json);
}

int run(const Settings& settings) {
  const auto wanted = [&](const std::string& name) {
    return settings.scenes.empty() ||
           std::find(settings.scenes.begin(), settings.scenes.end(), name) != settings.scenes.end();
  };
  std::vector<BenchRow> rows;
  const auto bench = [&](const BenchScene& scene) {
    const auto more = bench_tracer(scene, settings);
    rows.insert(rows.end(), more.begin(), more.end());
  };
  if (wanted("teapot")) bench(teapot_scene());
  if (wanted("bunny")) {
    const auto scene = bunny_scene();
    scene ? bench(*scene) : fmt::print(settings.table(), "bunny: not here, left out\n");
  }
  if (wanted("million")) bench(million_scene());
  const auto named = [&](const std::string& name) { return !settings.scenes.empty() && wanted(name); };
  if (named("forest"))
    if (const auto scene = forest_scene()) bench(*scene);
  if (named("terrain-5M")) bench(terrain_scene("terrain-5M", 1582));
  if (named("terrain-20M")) bench(terrain_scene("terrain-20M", 3163));
  if (settings.scenes.empty() || wanted("whole"))
    for (BenchRow& row : bench_whole(settings)) rows.push_back(std::move(row));
  fmt::print(settings.table(), "Instruction set in use: {}\n", raytrace::packet_target());
  const auto written =
      hand_out(settings.json, bench_json(rows, app::machine_info(), raytrace::packet_target()));
  if (!written) {
    fmt::print(stderr, "{}\n", written.error().message());
    return 4;
  }
  return std::ranges::all_of(rows, [](const BenchRow& row) { return row.met().value_or(true); }) ? 0 : 1;
}

}  // namespace
}  // namespace gnomon::bench

int main(int argc, char** argv) {
  gnomon::bench::Settings settings;
  CLI::App app("Gnomon's tracer against Embree 3: equal rays, in turn, in one process");
  app.add_option(
         "--scene", settings.scenes,
         "teapot, bunny, million (rays; default: these three, and whole), terrain-5M, terrain-20M, forest "
         "(instances kept); whole: whole commands")
      ->check(CLI::IsMember({"teapot", "bunny", "million", "terrain-5M", "terrain-20M", "forest", "whole"}));
  app.add_option("--runs", settings.runs, "timed repetitions, the median counts (default 5)")
      ->check(CLI::Range(1, 1000));
  std::array<int, 2> size{settings.size.width, settings.size.height};
  app.add_option("--size", size,
                 "WIDTHxHEIGHT in pixels (default 1920x1080, of whole commands 1280x720 as well)")
      ->delimiter('x')
      ->check(CLI::Range(16, 16384));
  app.add_option("--target", settings.target,
                 "hold both to an older instruction set: avx2, sse4 (default: the best that the machine has)")
      ->check(CLI::IsMember({"avx2", "sse4"}));
  app.add_option("--json", settings.json,
                 "also write the rows to this file; -: to stdout, the table to stderr");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  settings.size = {size[0], size[1]};
  if (app.count("--size") > 0) settings.whole_sizes = {settings.size};
  if (!settings.target.empty() && !gnomon::bench::hold_to(settings.target)) {
    fmt::print(stderr, "--target {}: this machine does not have it\n", settings.target);
    return 2;
  }
  return gnomon::bench::run(settings);
}
