// gnomon tune: the cheapest setting that is good enough, as a command line.
#include "studies/tune/tune.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/commands.h"
#include "app/options/option_kinds.h"
#include "app/options/options.h"
#include "app/options/shimmer_options.h"
#include "app/options/values.h"
#include "app/outputs/render_json.h"
#include "app/process/interrupt.h"
#include "app/process/machine.h"
#include "app/session.h"
#include "app/strongest_lights.h"
#include "compare/result/figures.h"
#include "compare/result/number_text.h"
#include "raster/programs/shader_folder.h"
#include "report/write_outputs.h"
#include "scene/base/timing.h"
#include "studies/commands/axes.h"
#include "studies/commands/tune_answer.h"
#include "studies/tune/page.h"
#include "studies/tune/sheet.h"

namespace gnomon::app {

namespace {

using Values = OptionValues;

constexpr OptionRange time_range{0.0, 1e9, true};     // milliseconds
constexpr OptionRange seconds_range{0.0, 1e9, true};  // of processor time

/// Drawings in turn of those that come near the best.
constexpr int tuned_runs = 5;

struct TuneCommand {
  SceneArgument scene;
  std::string camera, json, folder, trace, shader_folder;
  int max_lights = usual_max_lights;
  double report_max_mb = report::default_report_max_mb;
  SweepOptions options;
  studies::TuneGoal goal;
  FilmedMeasure asked;
  ViewListOptions views;
  raster::Backend backend = raster::Backend::automatic;
  std::optional<int> runs;
  int threads = 0;
  bool quiet = false, verbose = false;
  const compare::TunedEngine* engine = nullptr;
  double most_seconds = 60.0;  ///< of processor time
  bool quick = false;
};

/// --map-size as a list, or the powers of two from 64 to what the context allows.
Expected<std::vector<int>> choose_sizes(const TuneCommand& command, int limit) {
  const auto grid = command.options.grid(false);
  if (!grid) return fail(grid.error());
  std::vector<std::string> texts;
  for (const studies::Axis& axis : grid->axes())
    if (axis.name == "map-size") texts = axis.values;
  for (const auto& [name, value] : command.options.fixed())
    if (name == "map-size") texts = {value};
  if (texts.empty())
    for (int size = 64; size <= std::min(limit, 8192); size *= 2) texts.push_back(std::to_string(size));
  std::vector<int> sizes;
  for (const std::string& text : texts) sizes.push_back(std::stoi(text));
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

/// Only options of the map may have several values.
Expected<void> check_lists(const TuneCommand& command) {
  const auto grid = command.options.grid(false);
  if (!grid) return fail(grid.error());
  for (const studies::Axis& axis : grid->axes())
    if (raster::find_setting(axis.name) == nullptr || axis.name == "bias")
      return fail(ErrorKind::usage,
                  fmt::format("--{}: one value only; the tuner varies the map's options", axis.name));
  if (is_given(command.options.fixed(), *grid, "bias"))
    return fail(ErrorKind::usage, "--bias: the tuner finds the constant bias itself");
  if (command.goal.max_error.has_value() == command.goal.max_time_ms.has_value())
    return fail(ErrorKind::usage, "one goal is needed: --max-error LIMIT or --max-time MS");
  if (command.quick && command.goal.max_time_ms)
    return fail(
        ErrorKind::usage,
        "--quick: ends with the first setting that is good enough, and --max-time asks for the best one");
  return {};
}

/// The setting that an answer's command asks for, read as compare reads it.
Expected<compare::Setting> setting_as_given(const TuneCommand& command, const OptionFamily& family,
                                            const studies::Attempt& attempt, const Scene& scene,
                                            const World& world, const compare::Setting& base) {
  const auto parsed = parse_setting(answer_values(command.options.fixed(), family, attempt));
  if (!parsed) return fail(parsed.error());
  auto setting = resolve_setting(*parsed, scene, world);
  if (!setting) return setting;
  setting->raster.runs = base.raster.runs;
  setting->raytrace.picture = base.raytrace.picture;
  return setting;
}

/// The comparison at the answer: what the page shows.
Expected<compare::Comparison*> compare_at_answer(studies::Engine& engine, const TuneAnswer& answer,
                                                 const compare::Setting& setting) {
  auto compared = engine.compare(setting);
  if (!compared) return compared;
  (*compared)->command = answer.line(answer.result.winner);
  (*compared)->machine = machine_info();
  (*compared)->peak_memory_bytes = peak_memory_bytes();
  return compared;
}

Expected<void> write_page(const TuneCommand& command, const TuneAnswer& answer, const RunFiles& files,
                          const compare::Comparison& comparison, const std::string& sheet, Console& console) {
  std::vector<std::string> commands;
  for (std::size_t i = 0; i < answer.families.size(); ++i) commands.push_back(answer.line(i));
  const report::PageIntroduction introduction = studies::tune_introduction(
      {comparison.world->scene->name, command.goal, answer.result, commands, answer.others()});
  const OutputGuard whole_outputs;
  const auto written =
      report::write_outputs(comparison, {.folder = command.folder,
                                         .report_max_mb = command.report_max_mb,
                                         .introduction = &introduction,
                                         .more = {{"tune.json", answer.json()}, {"sheet.html", sheet}},
                                         .inputs = files.inputs(),
                                         .elsewhere = texts_for_files({{command.json, answer.json()}})});
  if (!written) return fail(written.error());
  if (written->beside) console.note(beside_note(written->page_mb, command.report_max_mb));
  console.message(fmt::format("report: {0}/report.html, a page to print: {0}/sheet.html", command.folder));
  return {};
}

Expected<void> hand_out(const TuneCommand& command, const TuneAnswer& answer) {
  if (!command.quiet && command.json != "-")
    print_data(command.verbose ? answer.whole_text() : answer.text());
  // With a page the file has appeared with it.
  if (!command.folder.empty() && command.json != "-") return {};
  const OutputGuard whole_file;
  return hand_out_json(command.json, answer.json());
}

/// What is tuned, ready to be drawn.
struct Bench {
  LoadedScene& loaded;
  std::unique_ptr<raster::Renderer> renderer;
  Scene given;  ///< the engine changes the scene's camera and lights
  std::vector<OptionFamily> families;
  compare::Setting setting;
  studies::TuneOptions options;
  std::optional<compare::FilmPlan> film{};  ///< where errors are flips
  std::vector<compare::JudgedView> views{};
};

Expected<Bench> make_bench(const TuneCommand& command, LoadedScene& loaded,
                           const std::vector<OptionFamily>& families, Console& console) {
  const auto parsed = parse_setting(values_read(command.options.fixed()));
  if (!parsed) return fail(parsed.error());
  keep_strongest_lights(loaded, command.max_lights, command.options.values_given("light"), parsed->poses,
                        console);
  auto setting = resolve_setting(*parsed, *loaded.scene, *loaded.world);
  if (!setting) return fail(setting.error());
  setting->raster.runs = command.runs.value_or(tuned_runs);
  setting->raytrace.picture = !command.folder.empty();
  auto renderer = make_renderer(command.backend, loaded, console, command.shader_folder);
  if (!renderer) return fail(renderer.error());
  const auto sizes = choose_sizes(command, (*renderer)->info().max_map_size);
  if (!sizes) return fail(sizes.error());
  auto fitting = fitting_families(families, *loaded.scene, setting->compared, command.engine);
  if (!fitting) return fail(fitting.error());
  Bench bench{loaded, std::move(*renderer), *loaded.scene, std::move(*fitting), std::move(*setting), {}};
  if (command.asked.is_filmed()) {
    const StageSource source{command.scene, command.camera, command.backend, command.shader_folder};
    auto film = resolve_film(command.asked.film, loaded.paths, *loaded.scene, console, &source);
    if (!film) return fail(film.error());
    bench.film = std::move(*film);
  }
  auto views = resolve_views(command.views, command.asked.film, command.asked.is_filmed(), loaded,
                             *loaded.scene, console);
  if (!views) return fail(views.error());
  bench.views = std::move(*views);
  bench.options.goal = command.goal;
  bench.options.sizes = *sizes;
  for (const OptionFamily& family : bench.families) bench.options.families.push_back(family.tuned);
  return bench;
}

/// The film that says how much a setting flickers: what was asked for, else a short orbit.
compare::FilmPlan film_of_sheet(const Bench& bench) {
  return bench.film.value_or(compare::FilmPlan{{}, {.frames = 12, .fps = 30.0}, 1});
}

/// The answer and its rivals on one page, each with at most as much memory as the answer.
Expected<std::string> make_sheet(const TuneCommand& command, const Bench& bench, const TuneAnswer& answer) {
  studies::Engine engine(*bench.loaded.scene, *bench.loaded.world, *bench.renderer, true);
  if (!bench.views.empty()) engine.look_from(bench.views, command.goal.measure());
  const studies::TuneResult& result = answer.result;
  const std::uint64_t bytes = attempt_of(result.families[result.winner]).map_bytes;
  std::vector<std::size_t> shown = answer.rivals();
  shown.insert(shown.begin(), result.winner);
  studies::SheetInput sheet{bench.loaded.scene->name,
                            command.goal,
                            command.engine != nullptr ? command.engine->name : std::string_view(),
                            {}};
  for (const std::size_t family : shown) {
    studies::Attempt attempt = attempt_of(result.families[family]);
    if (family != result.winner && attempt.map_bytes > 0) {
      attempt.size = studies::size_at_memory(attempt, bench.options.sizes, bytes);
      if (auto biased = studies::attempt_at(engine, bench.setting, result.families[family].family, attempt,
                                            command.goal);
          !biased)
        return fail(biased.error());
      else
        attempt = std::move(*biased);
    }
    auto setting = bench.options.as_given(family, attempt);
    if (!setting) return fail(setting.error());
    setting->raster.runs = bench.setting.raster.runs;
    sheet.candidates.push_back(
        {result.families[family].family.name, answer.line(family, attempt), std::move(*setting)});
  }
  engine.film_with(film_of_sheet(bench));
  return studies::tune_sheet(engine, sheet);
}

Expected<ExitCode> tune_and_answer(const TuneCommand& command, Bench& bench, const RunFiles& files,
                                   const Stopwatch& total, Console& console) {
  const bool with_page = !command.folder.empty();
  bench.options.as_given = [&](std::size_t family, const studies::Attempt& attempt) {
    return setting_as_given(command, bench.families[family], attempt, bench.given, *bench.loaded.world,
                            bench.setting);
  };
  const bool perceptual = with_page || command.goal.measure().needs == compare::FigureNeeds::perception;
  studies::Engine engine(*bench.loaded.scene, *bench.loaded.world, *bench.renderer, perceptual);
  if (bench.film) engine.film_with(*bench.film);
  if (!bench.views.empty()) engine.look_from(bench.views, command.goal.measure());
  bench.options.most_seconds = command.most_seconds;
  bench.options.quick = command.quick;
  bench.options.found = [&](const studies::TuneFamily& family, const studies::Attempt& answer,
                            std::uint64_t renders) {
    console.message(fmt::format("good enough after {}: {}, {}", compare::counted(renders, "drawing"),
                                family.at_size(answer.size), compare::milliseconds(answer.time_ms)));
  };
  const auto result = studies::tune(engine, bench.setting, bench.options,
                                    [&](const studies::TuneFamily& family, int size, std::uint64_t renders) {
                                      const double share =
                                          double(renders) / double(3 * bench.families.size() + 1);
                                      console.progress(family.at_size(size), share);
                                    });
  if (!result) return fail(result.error());
  const auto shaders = raster::ShaderFolder::read(command.shader_folder);
  if (!shaders) return fail(shaders.error());
  const TuneQuestion question{
      command.scene,  command.camera,       command.shader_folder, command.options.fixed(),
      command.goal,   shaders->replaced(),  command.asked,         command.max_lights,
      command.engine, command.most_seconds, command.backend,       command.views,
      command.quick};
  const TuneAnswer answer{question, bench.families, *result};
  if (with_page) {
    const auto setting = bench.options.as_given(result->winner, attempt_of(result->families[result->winner]));
    if (!setting) return fail(setting.error());
    const auto sheet = make_sheet(command, bench, answer);
    if (!sheet) return fail(sheet.error());
    engine.map_places();
    const auto compared = compare_at_answer(engine, answer, *setting);
    if (!compared) return fail(compared.error());
    (*compared)->load_ms = bench.loaded.load_ms;
    (*compared)->total_ms = total.elapsed_ms();
    if (const auto page = write_page(command, answer, files, **compared, *sheet, console); !page)
      return fail(page.error());
  }
  if (const auto out = hand_out(command, answer); !out) return fail(out.error());
  return result->feasible ? ExitCode::done : ExitCode::threshold_exceeded;
}

Expected<RunFiles> check_files(const TuneCommand& command) {
  RunFiles files;
  files.reads(command.scene);
  files.reads(path_file(command.asked.film));
  files.reads_shaders(command.shader_folder);
  files.writes("--json", command.json);
  files.writes("--trace", command.trace);
  files.writes_folder("-o", command.folder, report::page_file_names);
  for (const char* name : {"/tune.json", "/sheet.html"})
    if (!command.folder.empty()) files.writes("-o", command.folder + name);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  return files;
}

Expected<ExitCode> run_tune(TuneCommand& command) {
  const Stopwatch total;
  Console console(command.quiet);
  if (const auto checked = check_lists(command); !checked) return fail(checked.error());
  if (const auto fine = check_film_use(command.asked); !fine) return fail(fine.error());
  command.goal.of_time = command.asked.measure;
  const auto is_given = [&](std::string_view name) { return !command.options.values_given(name).empty(); };
  if (const auto fine =
          check_views(command.views, command.camera, command.asked.film, command.asked.is_filmed(), is_given);
      !fine)
    return fail(fine.error());
  const auto families = make_families(command.options, command.asked.is_filmed(), command.engine);
  if (!families) return fail(families.error());
  auto files = check_files(command);
  if (!files) return fail(files.error());
  const bool with_paths = command.asked.is_filmed() || follows_path(command.asked.film);
  auto loaded =
      load(command.scene, *files, console, 0, command.camera, with_paths, true, command.views.by_cameras());
  if (!loaded) return fail(loaded.error());
  auto bench = make_bench(command, *loaded, *families, console);
  if (!bench) return fail(bench.error());
  return tune_and_answer(command, *bench, *files, total, console);
}

}  // namespace

GNOMON_COMMAND(tune, 100,
               "Find the cheapest shadow map that is good enough, or the best that is cheap enough, and say "
               "why the others are not. The map's options take lists, as in sweep: what is given restricts "
               "the search. Exit code 1 when the goal cannot be met.") {
  app->footer(
      "gnomon tune fence --max-error 0.5%\n"
      "gnomon tune penumbra --max-error mean:0.5%      also wrong:1%, flip:0.05, edge:0.5texel\n"
      "gnomon tune courtyard --max-error shimmer:0.02 --path walk    the cheapest that holds still\n"
      "gnomon tune fence --max-error 2% --engine godot    only what Godot draws, in its settings\n"
      "gnomon tune level.glb --cameras all --max-error 2%    good enough from every camera\n"
      "gnomon tune courtyard --max-time 20 --map-size 256:4096:x2 -o answer\n"
      "gnomon tune fence --technique hard --shader-dir mine --max-error 2%    with a shader of your own\n"
      "gnomon tune model.glb --max-error 1% --json - | jq -r .command");
  const auto command = std::make_shared<TuneCommand>();
  add_scene(*app, command->scene);
  add_scene_time(*app, command->scene);
  add_camera(*app, command->camera);
  add_measured_limit(*app, "--max-error", {command->asked.measure, command->goal.max_error},
                     "the largest error that is good enough, of the worst light; this or --max-time", "none",
                     true);
  add_film_options(*app, command->asked.film);
  add_view_options(*app, command->views);
  add_checked(*app, "--max-time", "MS",
              fmt::format("the longest time for map and shading [milliseconds, {}; this or --max-error]",
                          range_text(time_range)),
              [goal = &command->goal](const std::string& text) -> Expected<void> {
                const auto ms = parse_number(text, time_range);
                if (!ms) return fail(ms.error());
                goal->max_time_ms = *ms;
                return {};
              });
  command->options.add_to(*app);
  app->get_option("--bias")->description("refused: the tuner finds the constant bias itself [default none]");
  add_max_lights(*app, command->max_lights);
  command->options.mean_techniques(tuned_techniques());
  add_output(
      *app, "-o,--output", command->folder, "DIR",
      "also write report.html there, with the answer, the runners-up and the comparison at the answer, and "
      "tune.json [default off]");
  add_report_max_mb(*app, command->report_max_mb);
  add_backend(*app, command->backend);
  add_shader_dir(*app, command->shader_folder);
  add_threads(*app, command->threads, "threads of the ray tracer and of Mesa's software rasterizer");
  add_runs(*app, command->runs, std::to_string(tuned_runs).c_str());
  add_engine(*app, command->engine, "try only what this engine draws, and give the answer in its settings",
             "all techniques");
  add_number(*app, "--time-limit", command->most_seconds, seconds_range, "seconds of processor time",
             "after this try larger maps of the first family of settings alone, and say which are left");
  app->add_flag(
      "--quick", command->quick,
      "end with the first setting that is good enough, which need not be the cheapest [default off]");
  add_verbose(*app, command->verbose,
              "also say why each of the others lost, and the bias in the units of all engines");
  add_json(*app, command->json, "the answer");
  add_quiet(*app, command->quiet);
  bind_run(*app, invocation, command, run_tune);
}

}  // namespace gnomon::app
