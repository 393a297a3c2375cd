// gnomon bench: the whole benchmark against Embree; or, on a scene, what the acceleration structures, the
// precisions or the shadow techniques cost and bring, as a table.
#include <fmt/core.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include "app/commands.h"
#include "app/invocation.h"
#include "app/options/option_kinds.h"
#include "app/options/options.h"
#include "app/options/values.h"
#include "app/outputs/render_json.h"
#include "app/process/interrupt.h"
#include "app/process/machine.h"
#include "app/session.h"
#include "benchmark/build_time.h"
#include "benchmark/row.h"
#include "benchmark/techniques.h"
#include "benchmark/tuning.h"
#include "raster/technique_traits.h"
#include "scene/base/parallel.h"
#include "scene/files/own_program.h"
#include "scene/files/write_file.h"
#include "studies/commands/tune_families.h"

namespace gnomon::app {

namespace {

using bench::BenchRow;

struct BenchCommand {
  SceneArgument scene;
  std::string json;
  ImageSize size = quick_picture;
  std::vector<raytrace::Accel> accels{raytrace::all_accels().begin(), raytrace::all_accels().end()};
  bool precision = false;
  std::vector<std::string> techniques, tune;  ///< scenes; empty: not asked for
  raster::RasterOptions raster;               ///< of `techniques`
  std::string build;                          ///< folder of the sources; empty: not asked for
  std::string page;                           ///< of `techniques`, Markdown; empty: none
  std::vector<std::string> tuned_techniques;  ///< of `tune`; empty: all
  double max_error = 0.01;                    ///< of `tune`
  std::uint64_t rays = 1'000'000, seed = 1;
  std::optional<int> runs;
  int threads = 0;
  bool quiet = false;
  std::string command_line;
  std::string meaningless;  ///< an option that was given and has no meaning for what was asked
  bool size_given = false;

  bool prints_tables() const { return !quiet && json != "-"; }
};

bench::Progress shown_on(Console& console) {
  return [&](const std::string& what, double done) { console.progress(what, done); };
}

Expected<ExitCode> hand_out_rows(const BenchCommand& command, const std::vector<BenchRow>& rows) {
  if (const auto out = hand_out_json(command.json, bench::bench_json(rows, machine_info())); !out)
    return fail(out.error());
  return ExitCode::done;
}

Expected<ExitCode> hand_out_tables(const BenchCommand& command,
                                   const std::vector<bench::TechniqueTable>& tables,
                                   const std::vector<BenchRow>& rows) {
  StagedFiles files;
  const auto out = publish_texts({{command.page, bench::markdown(tables, command.command_line)},
                                  {command.json, bench::bench_json(rows, machine_info())}},
                                 files);
  if (!out) return fail(out.error());
  return ExitCode::done;
}

Expected<ExitCode> run_techniques(const BenchCommand& command) {
  Console console(command.quiet);
  RunFiles files;
  for (const std::string& scene : command.techniques) files.reads(command.scene.named(scene));
  files.writes("-o", command.page);
  files.writes("--json", command.json);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  raster::RasterOptions options = command.raster;
  options.size = command.size;
  options.runs = command.runs.value_or(options.runs);
  std::vector<bench::TechniqueTable> tables;
  std::vector<BenchRow> rows;
  for (const std::string& scene : command.techniques) {
    const auto loaded = load(command.scene.named(scene), files, console);
    if (!loaded) return fail(loaded.error());
    const auto renderer = make_renderer(raster::Backend::automatic, *loaded, console);
    if (!renderer) return fail(renderer.error());
    auto table =
        bench::bench_techniques(*loaded->scene, *loaded->world, **renderer, options, shown_on(console));
    if (!table) return fail(table.error());
    console.clear_progress();
    if (command.prints_tables()) print_data(bench::text_table(*table));
    for (BenchRow& row : bench::bench_rows(*table)) rows.push_back(std::move(row));
    tables.push_back(std::move(*table));
  }
  return hand_out_tables(command, tables, rows);
}

Expected<ExitCode> run_build(const BenchCommand& command) {
  Console console(command.quiet);
  RunFiles files;
  files.writes("--json", command.json);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  std::vector<std::string> programs;
  for (const Command& each : all_commands())
    if (const std::string name(each.program.empty() ? "gnomon-bench" : each.program);
        std::find(programs.begin(), programs.end(), name) == programs.end())
      programs.push_back(name);
  const auto result = bench::bench_build(command.build, programs, shown_on(console));
  if (!result) return fail(result.error());
  console.clear_progress();
  if (command.prints_tables()) print_data(result->table);
  return hand_out_rows(command, result->rows);
}

/// Every family that the scene's lights have a map for, of the techniques named.
Expected<std::vector<studies::TuneFamily>> families_of(const BenchCommand& command, const Scene& scene) {
  std::vector<std::uint32_t> lights;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) lights.push_back(i);
  const auto all = make_families({});
  if (!all) return fail(all.error());
  const auto fitting = fitting_families(*all, scene, lights);
  if (!fitting) return fail(fitting.error());
  std::vector<studies::TuneFamily> families;
  const std::vector<std::string>& named = command.tuned_techniques;
  for (const OptionFamily& family : *fitting)
    if (named.empty() || std::find(named.begin(), named.end(),
                                   raster::technique_name(family.tuned.map.technique)) != named.end())
      families.push_back(family.tuned);
  return families;
}

Expected<studies::GridCheck> check_tuning(const BenchCommand& command, int runs, const LoadedScene& loaded,
                                          Console& console) {
  const auto renderer = make_renderer(raster::Backend::automatic, loaded, console);
  if (!renderer) return fail(renderer.error());
  auto families = families_of(command, *loaded.scene);
  if (!families) return fail(families.error());
  return bench::bench_tuning(
      {*loaded.scene, *loaded.world, **renderer, std::move(*families), command.max_error, command.size, runs},
      shown_on(console));
}

Expected<ExitCode> run_tuning(const BenchCommand& command) {
  constexpr int usual_runs = 9;
  Console console(command.quiet);
  RunFiles files;
  for (const std::string& scene : command.tune) files.reads(command.scene.named(scene));
  files.writes("--json", command.json);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  const int runs = command.runs.value_or(usual_runs);
  if (command.prints_tables()) print_data(bench::tuning_head(command.max_error, command.size, runs));
  std::vector<BenchRow> rows;
  for (const std::string& scene : command.tune) {
    const auto loaded = load(command.scene.named(scene), files, console);
    if (!loaded) return fail(loaded.error());
    const auto check = check_tuning(command, runs, *loaded, console);
    if (!check) return fail(check.error());
    console.clear_progress();
    if (command.prints_tables()) print_data(bench::tuning_line(loaded->scene->name, *check));
    for (BenchRow& row : bench::tuning_rows(loaded->scene->name, *check)) rows.push_back(std::move(row));
  }
  return hand_out_rows(command, rows);
}

/// The whole benchmark, a program of its own, for it holds Embree, which the user's own program never does: beside this
/// program, or in the build's tests. Empty: nowhere.
std::string whole_benchmark() {
  const std::filesystem::path own = own_program();
  for (const auto& folder : {own.parent_path(), own.parent_path().parent_path() / "tests"}) {
    const std::filesystem::path program = folder / "gnomon_bench";
    if (access(program.c_str(), X_OK) == 0) return program.string();
  }
  return {};
}

/// Becomes that program. Returns only to say why not.
Expected<ExitCode> run_whole(const BenchCommand& command) {
  const std::string program = whole_benchmark();
  if (program.empty())
    return fail(ErrorKind::graphics,
                "gnomon_bench is not beside this program (it needs Embree 3, and is built by ./gnomon test "
                "or cmake --build BUILD --target gnomon_bench)");
  RunFiles files;
  files.writes("--json", command.json);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  std::vector<std::string> words{program};
  if (command.runs.value_or(0) > 0)
    words.insert(words.end(), {"--runs", std::to_string(command.runs.value_or(0))});
  if (command.size_given)
    words.insert(words.end(), {"--size", fmt::format("{}x{}", command.size.width, command.size.height)});
  if (!command.json.empty()) words.insert(words.end(), {"--json", command.json});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  leave_interrupts_to_the_system();
  execv(program.c_str(), arguments.data());
  return fail(ErrorKind::graphics, fmt::format("{}: {}", program, std::strerror(errno)));
}

Expected<ExitCode> run_bench(const BenchCommand& command) {
  constexpr int usual_runs = 3;
  if (!command.meaningless.empty())
    return fail(ErrorKind::usage,
                fmt::format("{}: has no meaning here (see gnomon bench --help)", command.meaningless));
  if (!command.build.empty()) return run_build(command);
  if (!command.techniques.empty()) return run_techniques(command);
  if (!command.tune.empty()) return run_tuning(command);
  if (command.scene.name.empty() && command.precision)
    return fail(ErrorKind::usage, "--precision: needs a SCENE");
  if (command.scene.name.empty()) return run_whole(command);
  Console console(command.quiet);
  RunFiles files;
  files.reads(command.scene);
  files.writes("--json", command.json);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  const auto loaded = load(command.scene, files, console);
  if (!loaded) return fail(loaded.error());
  const bench::BenchInput input{
      *loaded->scene,   *loaded->world, loaded->plan,     command.size, command.runs.value_or(usual_runs),
      threads_in_use(), command.accels, shown_on(console)};
  auto result = command.precision
                    ? Expected<bench::BenchResult>(bench::bench_precisions(input, command.rays, command.seed))
                    : bench::bench_structures(input);
  if (!result) return fail(result.error());
  if (!command.precision) {
    auto hybrid = bench::bench_hybrid(input);
    if (!hybrid) return fail(hybrid.error());
    result->table += hybrid->table;
    result->rows.insert(result->rows.end(), hybrid->rows.begin(), hybrid->rows.end());
  }
  console.clear_progress();
  if (command.prints_tables()) print_data(result->table);
  return hand_out_rows(command, result->rows);
}

void add_technique_options(CLI::App& app, BenchCommand& command) {
  app.add_option("--techniques", command.techniques,
                 "every shadow technique at its defaults: wrong pixels, error, time, texels and bytes "
                 "[scenes with commas between; default off]")
      ->delimiter(',')
      ->type_name("SCENE[,SCENE]");
  add_map_option(app, "map-size", command.raster.map);
  add_output(app, "-o,--output", command.page, "FILE.md",
             "the table of --techniques as Markdown [default none]");
}

void add_tune_options(CLI::App& app, BenchCommand& command) {
  app.add_option("--tune", command.tune,
                 "what tune answers against the best of a full grid of techniques, biases and map sizes "
                 "[scenes with commas between; default off]")
      ->delimiter(',')
      ->type_name("SCENE[,SCENE]");
  const auto reason = [](const std::string& name) {
    raster::MapOptions map;
    const auto known = raster::set_setting("technique", map, name);
    return known ? std::string() : known.error().reason;
  };
  app.add_option("--technique", command.tuned_techniques,
                 fmt::format("of --tune: the grid's techniques [{}; default all]",
                             raster::allowed_text(*raster::find_setting("technique"))))
      ->delimiter(',')
      ->check(reason)
      ->type_name("NAME[,NAME]");
  app.add_option_function<std::string>(
         "--max-error",
         [&command](const std::string& text) {
           const auto share = parse_share(text);
           if (!share) throw CLI::ValidationError("--max-error", share.error().reason);
           command.max_error = *share;
         },
         "of --tune: the largest share of wrong pixels that is good enough [0% to 100%, or 0 to 1; default "
         "1%]")
      ->type_name("SHARE");
}

}  // namespace

GNOMON_COMMAND(
    bench, 120,
    "The speed figures against Embree, row by row with their goals; with a SCENE, build time, memory, work "
    "per ray and speed of the acceleration structures, or what each precision costs.") {
  app->footer(
      "gnomon bench                           every figure, against Embree 3 (built with the tests)\n"
      "gnomon bench --precision bunny.ply     speed and wrong shadows of fast, robust and exact\n"
      "gnomon bench --techniques fence,teapot -o table.md   every shadow technique on the same pixels\n"
      "gnomon bench --tune fence,teapot       the tuner's answers against full grids\n"
      "gnomon bench --build .                 what compiling costs, program by program\n"
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
  app->add_option("--build", command->build,
                  "compile the sources from nothing, in a folder of its own: processor seconds of each "
                  "program [a folder; "
                  "default off]")
      ->type_name("DIR");
  add_technique_options(*app, *command);
  add_tune_options(*app, *command);
  add_ray_count(*app, command->rays);
  add_seed(*app, command->seed, "of the adversarial rays");
  add_size(*app, command->size);
  add_runs(*app, command->runs, "3");
  add_threads(*app, command->threads, "threads of the ray tracer");
  add_json(*app, command->json, "the rows");
  add_quiet(*app, command->quiet);
  app->callback([command, &invocation, app] {
    const auto reject = [&](bool rejected, std::initializer_list<const char*> options) {
      for (const char* option : options)
        if (rejected && app->count(option) > 0) command->meaningless = option;
    };
    const bool techniques = !command->techniques.empty();
    const bool tune = !command->tune.empty();
    const bool build = !command->build.empty();
    reject(techniques || tune || build, {"SCENE", "--accel", "--precision"});
    reject(build, {"--techniques", "--tune", "--runs", "--size", "--threads"});
    reject(techniques, {"--tune"});
    reject(!tune, {"--max-error", "--technique"});
    reject(!techniques, {"--map-size", "--output"});
    reject(command->scene.name.empty() && !techniques && !tune && !build,
           {"--accel", "--threads", "--quiet"});
    reject(command->precision, {"--accel"});
    reject(!command->precision, {"--rays", "--seed"});
    command->size_given = app->count("--size") > 0;
    invocation.action = [command] { return run_bench(*command); };
  });
}

}  // namespace gnomon::app
