// gnomon compare: the main job. Load, render twice, climb the ladder, write the folder, print the table.
#include "compare/compare.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <optional>

#include "app/bind.h"
#include "app/machine.h"
#include "app/result_output.h"
#include "app/run_options.h"
#include "app/session.h"
#include "app/setting.h"
#include "app/strongest_lights.h"
#include "app/swim_note.h"
#include "scene/stages.h"
#include "scene/timing.h"

namespace gnomon::app {

namespace {

struct CompareCommand : RunOptions {
  SceneArgument scene;
  std::string camera;
  ResultOutput output;
  SettingOptions setting;
  std::string shader_folder;
  std::optional<int> runs;
  int max_lights = usual_max_lights;
  int tessellate = 0;  ///< sectors; 0: shapes stay exact
  std::string command_line;
  std::vector<std::string> given;  ///< options
};

// Measured: what the peak grows by from 320x180 to 2560x1440, with one light and with four.
constexpr double bytes_per_pixel = 260.0;
constexpr double bytes_per_pixel_and_light = 57.0;
constexpr double bytes_per_texel = 24.0;  // a map as drawn, read back and kept

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
  const double map_bytes = bytes_per_texel * std::pow(double(raster.map.size), 2.0);
  if (const auto fits = check_memory(raster.size, bytes, graphics_bytes + map_bytes); !fits)
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
  comparison->fail_above = command.output.fail_above;
  comparison->load_ms = loaded.load_ms;
  comparison->peak_memory_bytes = peak_memory_bytes();
  return comparison;
}

/// One rule for both renderers.
void set_runs(CompareCommand& command) {
  raster::RasterOptions& raster = command.setting.options.raster;
  raytrace::RaytraceOptions& rays = command.setting.options.raytrace;
  raster.runs = rays.runs = command.runs.value_or(usual_runs);
  raster.enough_ms = rays.enough_ms = command.runs ? never_enough_ms : usual_enough_ms;
  raster.shadow_cost = true;
  rays.warm_up = true;
}

Expected<ExitCode> run_compare(CompareCommand& command) {
  const Stopwatch total;
  Console console(command.output.quiet);
  const ThreadLimit thread_limit(command.threads, console);
  if (command.output.folder.empty() && !only_prints_json(command.output))
    command.output.folder = default_output(command.scene.name);
  set_runs(command);
  command.setting.options.raytrace.size = command.setting.options.raster.size;
  command.setting.options.raytrace.seed = command.seed;

  RunFiles files;
  files.reads(command.scene);
  if (const auto fine = check_outputs(command.output, files); !fine) return fail(fine.error());
  auto loaded = load(command.scene, files, console, command.tessellate, command.camera);
  if (!loaded) return fail(loaded.error());
  if (command.exposure) loaded->scene->exposure = *command.exposure;
  keep_strongest_lights(*loaded, command.max_lights, named_lights(command.setting.light), console);
  const auto posed = apply_poses(command.setting.poses, command.setting.light, *loaded);
  if (!posed) return fail(posed.error());
  auto comparison = render_and_compare(command, *loaded, console);
  if (!comparison) return fail(comparison.error());
  comparison->total_ms = total.elapsed_ms();
  console.progress("writing", 1.0);
  return only_prints_json(command.output)
             ? print_result(command.output, *comparison, *loaded, console)
             : write_folder(command.output, *comparison, *loaded, files, total, console);
}

void add_options(CLI::App& app, CompareCommand& command) {
  add_scene(app, command.scene);
  add_tessellate(app, command.tessellate);
  add_camera(app, command.camera);
  add_result_output(app, command.output, "out/NAME of the scene");
  add_setting_options(app, command.setting);
  add_max_lights(app, command.max_lights);
  add_run_options(app, command);
  add_shader_dir(app, command.shader_folder);
  add_runs(
      app, command.runs,
      fmt::format("{}, of maps, shading and rays alike, but no further one of a pass once those made took "
                  "{:g} ms together",
                  usual_runs, usual_enough_ms)
          .c_str());
  app.add_flag("--no-report", command.output.no_report,
               "write no report.html and spend no time on it; all other files as ever [default off]");
  add_result_limits(app, command.output);
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
  bind_run(*app, invocation, command, run_compare);
}

}  // namespace gnomon::app
