// gnomon bench: the whole benchmark against Embree; or, on a scene, what the acceleration structures, the
// precisions or the shadow techniques cost and bring, as a table.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/bench/row.h"
#include "app/bench/techniques.h"
#include "app/invocation.h"
#include "app/options/option_kinds.h"
#include "app/options/options.h"
#include "app/options/values.h"
#include "app/outputs/render_json.h"
#include "scene/base/parallel.h"

namespace gnomon::app {

namespace {

struct BenchCommand {
  SceneArgument scene;
  std::string json;
  ImageSize size = quick_picture;
  std::vector<raytrace::Accel> accels = all_accels();
  bool precision = false;
  TechniqueBench techniques;
  TuneBench tune;
  std::uint64_t rays = 1'000'000, seed = 1;
  std::optional<int> runs;
  int threads = 0;
  bool quiet = false;
  std::string command_line;
  std::string idle;  ///< an option that was given and has no meaning for what was asked
  bool size_given = false;
};

Expected<ExitCode> run_techniques(const BenchCommand& command) {
  Console console(command.quiet);
  TechniqueBench bench = command.techniques;
  bench.how = command.scene;
  bench.command_line = command.command_line;
  bench.raster.size = command.size;
  bench.raster.runs = command.runs.value_or(bench.raster.runs);
  bench.json = command.json;
  bench.quiet = command.quiet;
  const auto done = run_technique_bench(bench, console);
  if (!done) return fail(done.error());
  return ExitCode::done;
}

Expected<ExitCode> run_tune_rows(const BenchCommand& command) {
  Console console(command.quiet);
  TuneBench bench = command.tune;
  bench.how = command.scene;
  bench.size = command.size;
  bench.runs = command.runs.value_or(bench.runs);
  bench.json = command.json;
  bench.quiet = command.quiet;
  const auto done = run_tune_bench(bench, console);
  if (!done) return fail(done.error());
  return ExitCode::done;
}

Expected<ExitCode> run_bench(const BenchCommand& command) {
  constexpr int usual_runs = 3;
  if (!command.idle.empty())
    return fail(ErrorKind::usage,
                fmt::format("{}: has no meaning here (see gnomon bench --help)", command.idle));
  if (!command.techniques.scenes.empty()) return run_techniques(command);
  if (!command.tune.scenes.empty()) return run_tune_rows(command);
  if (command.scene.name.empty() && command.precision)
    return fail(ErrorKind::usage, "--precision: needs a SCENE");
  if (command.scene.name.empty())
    return run_whole_bench(
        {.runs = command.runs.value_or(0),
         .json = command.json,
         .size = command.size_given ? fmt::format("{}x{}", command.size.width, command.size.height) : ""});
  Console console(command.quiet);
  RunFiles files;
  files.reads(command.scene);
  files.writes("--json", command.json);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  const auto loaded = load(command.scene, files, console);
  if (!loaded) return fail(loaded.error());
  const BenchInput input{*loaded,
                         loaded->scene->name,
                         command.size,
                         command.runs.value_or(usual_runs),
                         threads_in_use(),
                         command.accels,
                         [&](const std::string& what, double done) { console.progress(what, done); }};
  auto result = command.precision ? Expected<BenchResult>(bench_precisions(input, command.rays, command.seed))
                                  : bench_structures(input);
  if (!result) return fail(result.error());
  if (!command.precision) {
    auto hybrid = bench_hybrid(input);
    if (!hybrid) return fail(hybrid.error());
    result->table += hybrid->table;
    result->rows.insert(result->rows.end(), hybrid->rows.begin(), hybrid->rows.end());
  }
  console.clear_progress();
  if (!command.quiet && command.json != "-") print_data(result->table);
  if (const auto out = hand_out_json(command.json, bench_json(result->rows)); !out) return fail(out.error());
  return ExitCode::done;
}

}  // namespace

namespace {

void add_technique_options(CLI::App& app, TechniqueBench& bench) {
  app.add_option("--techniques", bench.scenes,
                 "every shadow technique at its defaults: wrong pixels, error, time, texels and bytes "
                 "[scenes with commas between; default off]")
      ->delimiter(',')
      ->type_name("SCENE[,SCENE]");
  add_map_option(app, "map-size", bench.raster.map);
  add_output(app, "-o,--output", bench.page, "FILE.md",
             "the table of --techniques as Markdown [default none]");
}

void add_tune_options(CLI::App& app, TuneBench& bench) {
  app.add_option("--tune", bench.scenes,
                 "what tune answers against the best of a full grid of techniques, biases and map sizes "
                 "[scenes with commas between; default off]")
      ->delimiter(',')
      ->type_name("SCENE[,SCENE]");
  const auto reason = [](const std::string& name) {
    raster::MapOptions map;
    const auto known = raster::set_setting("technique", map, name);
    return known ? std::string() : known.error().reason;
  };
  app.add_option("--technique", bench.techniques,
                 "of --tune: the grid's techniques [names with commas between; default all]")
      ->delimiter(',')
      ->check(reason)
      ->type_name("NAME[,NAME]");
  app.add_option_function<std::string>(
         "--max-error",
         [&bench](const std::string& text) {
           const auto share = parse_share(text);
           if (!share) throw CLI::ValidationError("--max-error", share.error().reason);
           bench.max_error = *share;
         },
         "of --tune: the largest share of wrong pixels that is good enough [0% to 100%, or 0 to 1; default "
         "1%]")
      ->type_name("SHARE");
}

}  // namespace

void add_bench(CLI::App& program, Invocation& invocation) {
  CLI::App* app =
      program.add_subcommand("bench",
                             "The speed figures against Embree, row by row with their goals; with a SCENE, "
                             "build time, memory, work per "
                             "ray and speed of the acceleration structures, or what each precision costs.");
  app->footer(
      "gnomon bench                           every figure, against Embree 3 (built with the tests)\n"
      "gnomon bench --precision bunny.ply     speed and wrong shadows of fast, robust and exact\n"
      "gnomon bench --techniques fence,teapot -o table.md   every shadow technique on the same pixels\n"
      "gnomon bench --tune fence,teapot       the tuner's answers against full grids\n"
      "gnomon bench stadium --accel all       where a grid loses\n"
      "gnomon bench field --accel bvh,grid    where it is at its best\n"
      "gnomon bench orchard --accel bvh,two-level   what sharing one tree's structure saves");
  const auto command = std::make_shared<BenchCommand>();
  command->command_line = invocation.command_line;
  add_scene(*app, command->scene);
  app->get_option("SCENE")->required(false);
  add_accel_list(*app, command->accels);
  app->add_flag("--precision", command->precision,
                "fast, robust and exact side by side: rays per second, and wrong shadows on adversarial rays "
                "[default off]");
  add_technique_options(*app, command->techniques);
  add_tune_options(*app, command->tune);
  add_ray_count(*app, command->rays);
  add_seed(*app, command->seed, "of the adversarial rays");
  add_size(*app, command->size);
  add_runs(*app, command->runs, "3");
  add_threads(*app, command->threads, "threads of the ray tracer");
  add_json(*app, command->json, "the rows");
  add_quiet(*app, command->quiet);
  app->callback([command, &invocation, app] {
    const auto reject = [&](bool meaningless, std::initializer_list<const char*> options) {
      for (const char* option : options)
        if (meaningless && app->count(option) > 0) command->idle = option;
    };
    const bool techniques = !command->techniques.scenes.empty();
    const bool tune = !command->tune.scenes.empty();
    reject(techniques || tune, {"SCENE", "--accel", "--precision"});
    reject(techniques, {"--tune"});
    reject(!tune, {"--max-error", "--technique"});
    reject(!techniques, {"--map-size", "--output"});
    reject(command->scene.name.empty() && !techniques && !tune, {"--accel", "--threads", "--quiet"});
    reject(command->precision, {"--accel"});
    reject(!command->precision, {"--rays", "--seed"});
    command->size_given = app->count("--size") > 0;
    invocation.action = [command] { return run_bench(*command); };
  });
}

}  // namespace gnomon::app
