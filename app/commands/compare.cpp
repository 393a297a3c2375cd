// gnomon compare: the main job. Load, render twice, climb the ladder, write the folder, print the table.
#include "compare/compare.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>

#include "app/effect_options.h"
#include "app/interrupt.h"
#include "app/invocation.h"
#include "app/machine.h"
#include "app/options.h"
#include "app/output_path.h"
#include "app/session.h"
#include "app/setting.h"
#include "app/swim_note.h"
#include "app/technique_options.h"
#include "compare/number_text.h"
#include "compare/outputs.h"
#include "compare/time_budget.h"
#include "scene/files/write_file.h"
#include "scene/stages.h"
#include "scene/timing.h"

namespace gnomon::app {

namespace {

struct CompareCommand {
  std::string scene, camera, folder, json, aov;
  SettingOptions setting;
  raster::Backend backend = raster::Backend::automatic;
  std::string shader_folder;
  std::optional<int> runs;
  std::optional<std::optional<double>> exposure;
  std::optional<compare::Threshold> fail_above;
  double report_max_mb = compare::default_report_max_mb;
  std::uint64_t seed = 0;
  int threads = 0;
  int tessellate = 0;  ///< sectors; 0: shapes stay exact
  bool quiet = false;
  std::string command_line;
  std::vector<std::string> given;  ///< options
};

Expected<void> check_outputs(const CompareCommand& command) {
  if (!command.aov.empty()) {
    if (const auto known = check_extension("--aov", command.aov, ".exr"); !known) return known;
    if (const auto writable = check_output_file(command.aov); !writable) return writable;
  }
  if (const auto writable = check_output_file(command.json); !writable) return writable;
  return command.folder.empty() ? Expected<void>() : check_output_folder(command.folder);
}

// Measured: what the peak grows by from 320x180 to 2560x1440, with one light and with four.
constexpr double bytes_per_pixel = 260.0;
constexpr double bytes_per_pixel_and_light = 57.0;

Expected<compare::Comparison> render_and_compare(const CompareCommand& command, const LoadedScene& loaded,
                                                 Console& console) {
  const auto lights = choose_lights(*loaded.scene, command.setting.light);
  if (!lights) return fail(lights.error());
  for (const std::string& note : idle_options(command.given, loaded.plan)) console.note(note);
  for (const std::string& note :
       idle_options(command.given, command.setting.options.raster.map, *loaded.scene, *lights))
    console.note(note);
  const raster::RasterOptions& raster = command.setting.options.raster;
  if (std::string swims = swim_note(*loaded.world, raster.map, raster.size, *lights); !swims.empty()) {
    console.note(swims);
    loaded.scene->notes.push_back(std::move(swims));  // for the page and the JSON
  }
  const double bytes = bytes_per_pixel + bytes_per_pixel_and_light * static_cast<double>(lights->size());
  if (const auto fits = check_memory(command.setting.options.raster.size, bytes); !fits)
    return fail(fits.error());
  auto renderer = make_renderer(command.backend, loaded, command.shader_folder);
  if (!renderer) return fail(renderer.error());
  auto comparison =
      compare::compare_world(*loaded.world, **renderer, *lights, command.setting.options,
                             [&](std::string_view stage, double done) { console.progress(stage, done); });
  if (!comparison) return comparison;
  const auto used = check_shaders_used(command.shader_folder, comparison->raster, *loaded.scene, console);
  if (!used) return fail(used.error());
  {
    const TimedStage stage("exit");
    renderer->reset();
  }
  comparison->command = command.command_line;
  comparison->seed = command.seed;
  comparison->machine = machine_info();
  comparison->fail_above = command.fail_above;
  comparison->load_ms = loaded.load_ms;
  comparison->peak_memory_bytes = peak_memory_bytes();
  return comparison;
}

Expected<std::string> read_back(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file || bytes.empty())
    return fail(Error{ErrorKind::cannot_write, "cannot read back what was written", path});
  return bytes;
}

/// Nothing but the result on stdout was asked for: no folder is written.
bool only_prints_json(const CompareCommand& command) {
  return command.json == "-" && command.folder.empty() && command.aov.empty();
}

/// --json hands out the same bytes as the folder's result.json.
Expected<void> write_json(const CompareCommand& command) {
  if (command.json.empty()) return {};
  const Expected<std::string> json = read_back(command.folder + "/result.json");
  if (!json) return fail(json.error());
  if (command.json == "-") {
    print_data(*json);
    return {};
  }
  if (const auto made = make_folder_for(command.json); !made) return made;
  return write_file(command.json, *json);
}

/// All but result.json.
Expected<compare::WrittenOutputs> write_all(const CompareCommand& command,
                                            const compare::Comparison& comparison, Console& console) {
  auto written = compare::write_all_but_result(comparison, command.folder, command.report_max_mb, nullptr);
  if (!written) return fail(written.error());
  if (written->beside) console.note(beside_note(written->page_mb, command.report_max_mb));
  if (!command.aov.empty()) {
    const TimedStage stage("write");
    if (const auto made = make_folder_for(command.aov); !made) return fail(made.error());
    if (const auto saved = compare::write_aov(comparison, command.aov); !saved) return fail(saved.error());
  }
  return written;
}

/// Holds one light against --fail-above; the words say what is too much.
bool passes(const compare::Threshold& threshold, const std::string& light,
            const compare::ErrorFigures& figures, Console& console) {
  const std::string limit = compare::threshold_text(threshold);
  if (compare::exceeds(threshold, figures)) {
    console.message(fmt::format("light {}: {}; that is more than --fail-above {}", light,
                                compare::figure_words(figures, threshold.measure), limit));
    return false;
  }
  if (!compare::too_uncertain(threshold, figures)) return true;
  console.message(fmt::format(
      "light {}: {} of {} pixels that show a lit or shadowed surface are uncertain, more than --fail-above "
      "{} allows to be wrong: the truth there lies within its own error bound (--precision exact decides "
      "rays; lights with size want more --samples, or a limit of the mean error, such as mean:1%)",
      light, compare::grouped(compare::unknown_pixels(figures, threshold.measure)),
      compare::grouped(figures.compared + figures.uncertain), limit));
  return false;
}

ExitCode judge(const CompareCommand& command, const compare::Comparison& comparison, Console& console) {
  ExitCode code = ExitCode::done;
  if (!command.fail_above) return code;
  for (const compare::LightComparison& light : comparison.lights)
    if (!passes(*command.fail_above, comparison.world->scene->lights[light.light].name,
                compare::figures_of(light), console))
      code = ExitCode::threshold_exceeded;
  return code;
}

/// Before result.json is written, so that what it takes is in its time budget.
void give_back(compare::Comparison& comparison, LoadedScene& loaded) {
  const TimedStage stage("exit");
  comparison = {};
  loaded = {};
}

/// --json - alone: the result goes to stdout and nowhere else.
ExitCode print_result(const CompareCommand& command, compare::Comparison& comparison, LoadedScene& loaded,
                      Console& console) {
  const ExitCode code = judge(command, comparison, console);
  std::string json = compare::result_json(comparison);
  give_back(comparison, loaded);
  print_data(compare::with_time_budget(std::move(json)));
  return code;
}

Expected<ExitCode> write_folder(const CompareCommand& command, compare::Comparison& comparison,
                                LoadedScene& loaded, const Stopwatch& total, Console& console) {
  std::optional<OutputGuard> whole_outputs(std::in_place);
  auto written = write_all(command, comparison, console);
  if (!written) return fail(written.error());
  std::string summary = compare::summary_table(comparison, stdout_takes_colour());
  const ExitCode code = judge(command, comparison, console);
  give_back(comparison, loaded);
  if (const auto result = compare::write_result(*written, command.folder); !result)
    return fail(result.error());
  if (const auto json = write_json(command); !json) return fail(json.error());
  whole_outputs.reset();
  if (const StageLog* log = StageLog::current())
    summary += compare::time_budget_text(log->budget(), stdout_takes_colour());
  if (!command.quiet && command.json != "-") print_data(summary);
  console.message(fmt::format("report: {}/report.html ({:.1f} s, {:.0f} MB of memory at most)",
                              command.folder, total.elapsed_ms() / 1000.0,
                              static_cast<double>(peak_memory_bytes()) / 1e6));
  return code;
}

/// A large picture's shadow map and shading take long enough to be timed once.
constexpr std::size_t large_picture = 1'000'000;  // pixels
constexpr int runs_of_large = 1;

Expected<ExitCode> run_compare(CompareCommand& command) {
  const Stopwatch total;
  Console console(command.quiet);
  const ThreadLimit thread_limit(command.threads);
  if (command.folder.empty() && !only_prints_json(command)) command.folder = default_output(command.scene);
  if (command.runs)
    command.setting.options.raster.runs = command.setting.options.raytrace.runs = *command.runs;
  else if (command.setting.options.raster.size.pixels() > large_picture)
    command.setting.options.raster.runs = runs_of_large;
  command.setting.options.raytrace.size = command.setting.options.raster.size;
  command.setting.options.raytrace.seed = command.seed;

  if (const auto writable = check_outputs(command); !writable) return fail(writable.error());
  auto loaded = load(command.scene, console, command.tessellate, command.camera);
  if (!loaded) return fail(loaded.error());
  if (command.exposure) loaded->scene->exposure = *command.exposure;
  const auto posed =
      apply_poses(command.setting.poses, command.setting.light, *loaded->scene, *loaded->world);
  if (!posed) return fail(posed.error());
  auto comparison = render_and_compare(command, *loaded, console);
  if (!comparison) return fail(comparison.error());
  comparison->total_ms = total.elapsed_ms();
  console.progress("writing", 1.0);
  return only_prints_json(command) ? print_result(command, *comparison, *loaded, console)
                                   : write_folder(command, *comparison, *loaded, total, console);
}

void add_options(CLI::App& app, CompareCommand& command) {
  add_scene(app, command.scene);
  add_tessellate(app, command.tessellate);
  add_camera(app, command.camera);
  add_output(app, "-o,--output", command.folder, "DIR",
             "folder for report.html, result.json, result.csv and the pictures [default out/NAME of the "
             "scene; none with "
             "--json - alone]");
  add_setting_options(app, command.setting);
  add_backend(app, command.backend);
  add_shader_dir(app, command.shader_folder);
  add_threads(app, command.threads, "threads of the ray tracer and of Mesa's software rasterizer");
  add_runs(
      app, command.runs,
      fmt::format("{} for shadow maps ({} above a million pixels), {} for rays",
                  command.setting.options.raster.runs, runs_of_large, command.setting.options.raytrace.runs)
          .c_str());
  add_exposure(app, command.exposure);
  add_seed(app, command.seed, "of the samples of lights with size; recorded in the result");
  add_report_max_mb(app, command.report_max_mb);
  add_threshold(app, "--fail-above", command.fail_above,
                "exit with 1 when the error of any light is more than this, or so many pixels are uncertain",
                "never");
  add_output(app, "--aov", command.aov, "FILE.exr",
             "also write every per-pixel number as 32-bit channels, one file per light [default off]");
  add_json(app, command.json, "the result");
  add_quiet(app, command.quiet);
}

}  // namespace

void add_compare(CLI::App& program, Invocation& invocation) {
  CLI::App* app = program.add_subcommand(
      "compare", "Render with shadow maps and with rays, and report where the two shadows differ and why.");
  app->footer(
      "gnomon compare fence\n"
      "gnomon compare model.glb --map-size 2048 --bias 0.5texel -o report\n"
      "gnomon compare whitted --light lamp --json - | jq .lights[0].error\n"
      "gnomon compare scene.json --fail-above 1% --quiet    for scripts: exit code 1");
  const auto command = std::make_shared<CompareCommand>();
  command->command_line = invocation.command_line;
  add_options(*app, *command);
  app->callback([command, &invocation, app] {
    invocation.finish = [command, app] { finish_map_options(*app, command->setting.options.raster.map); };
    command->given = given_options(*app);
    invocation.action = [command] { return run_compare(*command); };
  });
}

}  // namespace gnomon::app
