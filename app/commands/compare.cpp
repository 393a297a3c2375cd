// gnomon compare: the main job. Load, render twice, climb the ladder, write the folder, print the table.
#include "compare/compare.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/options/effect_options.h"
#include "app/options/option_kinds.h"
#include "app/options/options.h"
#include "app/options/setting_options.h"
#include "app/options/view_options.h"
#include "app/outputs/each_shader.h"
#include "app/outputs/result_output.h"
#include "app/outputs/run_files.h"
#include "app/process/machine.h"
#include "app/session.h"
#include "app/strongest_lights.h"
#include "compare/advice/tried.h"
#include "compare/measure/reduced.h"
#include "compare/measure/subpixels.h"
#include "compare/result/estimate.h"
#include "compare/result/figures.h"
#include "compare/result/output_parts.h"
#include "compare/result/places.h"
#include "compare/result/views.h"
#include "raster/bands.h"
#include "raster/technique_traits.h"
#include "raster/use_shaders.h"
#include "scene/base/stages.h"
#include "scene/base/timing.h"

namespace gnomon::app {

namespace {

struct CompareCommand : RunOptions {
  SceneArgument scene;
  std::string camera;
  ViewListOptions views;
  FilmOptions path;
  ResultOutput output;
  SettingOptions setting;
  std::string shader_folder;
  std::string rates_file;
  std::optional<compare::Rates> rates;
  int places_per_pixel = 1;  ///< --subpixels
  std::optional<int> runs;
  bool timed_as_judged = false;
  int max_lights = usual_max_lights;
  int tessellate = 0;  ///< sectors; 0: shapes stay exact
  MemoryLimit memory;
  std::string command_line;
  std::vector<std::string> given;  ///< options
};

struct Compared {
  compare::Comparison comparison;
  std::unique_ptr<compare::BandedParts> parts;  ///< of a picture in bands
};

constexpr double bytes_per_texel = 24.0;  // a map as drawn, read back and kept

bool wants_page(const CompareCommand& command) {
  return !command.output.no_report && !only_prints_json(command.output);
}

/// Where rows of a picture in bands wait: beside the output. Empty, the current folder: there is no folder for temporary files.
std::string folder_of_rows(const CompareCommand& command) {
  const std::filesystem::path folder = command.output.folder;
  std::error_code none;
  return folder.empty() ? std::filesystem::temp_directory_path(none).string()
                        : std::filesystem::absolute(folder).parent_path().string();
}

/// Draws the picture in one piece with other options of the map, for numbers alone. A map that the memory does not hold is an
/// error.
compare::Redraw redraw_of(const CompareCommand& command, const LoadedScene& loaded,
                          const std::vector<std::uint32_t>& lights, raster::Renderer& renderer) {
  return [&](const raster::MapOptions& map) -> Expected<raster::RasterFrame> {
    raster::RasterOptions options =
        compare::drawing_options(command.setting.options.raster, command.setting.options.raytrace);
    options.map = map, options.runs = 0, options.shadow_cost = false, options.map_contents = false;
    const auto bytes = compare_bytes(*loaded.scene, lights, options.size, wants_page(command));
    const double map_bytes = bytes_per_texel * std::pow(double(map.size), 2.0);
    const auto fits = check_memory(command.memory, options.size, bytes, graphics_bytes + map_bytes);
    if (!fits) return fail(fits.error());
    return renderer.render(options, lights);
  };
}

/// Says what a picture in one piece shows before it is timed: what times say is no part of the verdict.
Expected<Compared> compare_picture(CompareCommand& command, const LoadedScene& loaded,
                                   const std::vector<std::uint32_t>& lights, compare::ViewErrors views,
                                   Console& console) {
  compare::CompareOptions options = command.setting.options;
  const raster::RasterOptions& raster = command.setting.options.raster;
  const compare::Progress progress = [&](std::string_view stage, double done) {
    console.progress(stage, done);
  };
  auto context = make_context(command.backend, console);
  if (!context) return fail(context.error());
  progress("building", 0.0);
  const raytrace::Tracer tracer(*loaded.world, options.accel, options.precision);
  auto renderer = make_renderer(std::move(*context), loaded, command.shader_folder);
  if (!renderer) return fail(renderer.error());
  const auto bytes = compare_bytes(*loaded.scene, lights, raster.size, wants_page(command));
  auto bands = plan_bands(command.memory, raster.size, bytes, raster::most_pixels(**renderer, raster.map));
  if (!bands) return fail(bands.error());
  const bool in_bands = bands->size() > 1, timed_later = !in_bands && compare::is_timed_later(raster);
  if (timed_later) options.raster = compare::untimed(raster);
  compare::Plan plan = compare::plan_of(tracer, lights, options);
  const Stopwatch joining;
  const raytrace::Topology topology(*loaded.world);
  plan.topology = &topology;
  Compared out;
  out.comparison.topology_ms = joining.elapsed_ms();
  plan.bands = std::move(*bands);
  if (in_bands) {
    plan.folder = folder_of_rows(command), plan.page = wants_page(command), plan.aov = command.output.aov;
    if (!plan.aov.empty())
      if (const auto made = make_folder_for(plan.aov); !made) return fail(made.error());
  } else {
    progress("shadow maps", 0.1);
  }
  out.comparison.command = command.command_line, out.comparison.measure = command.output.measure;
  out.comparison.views = std::move(views);
  auto parts = compare::measure(out.comparison, plan, compare::frames_of(tracer, **renderer, lights, options),
                                progress);
  if (!parts) return fail(parts.error());
  out.parts = std::move(*parts);
  const auto used = check_shaders_used(command.shader_folder, out.comparison.raster, *loaded.scene, console);
  if (!used) return fail(used.error());
  if (in_bands) return out;
  progress("trying what may help", 0.7);
  compare::try_settings(out.comparison, plan, redraw_of(command, loaded, lights, **renderer));
  say_verdict(command.output, out.comparison, console);
  progress("timing", 0.8);
  if (timed_later)
    if (const auto timed = compare::time_drawing(**renderer, lights, raster, out.comparison.raster); !timed)
      return fail(timed.error());
  const TimedStage stage("exit");
  renderer->reset();
  return out;
}

/// Says which maps swim, once they are made: for the page and the JSON, too.
void note_swimming(const CompareCommand& command, const LoadedScene& loaded,
                   const std::vector<std::uint32_t>& lights, Console& console) {
  const raster::RasterOptions& raster = command.setting.options.raster;
  std::string swims = swim_note(*loaded.world, raster.map, raster.size, lights);
  if (swims.empty()) return;
  console.note(swims);
  loaded.scene->notes.push_back(std::move(swims));
}

/// What the page leaves out is said on it and in the JSON, too.
void note_reduced_page(const CompareCommand& command, Scene& scene, Console& console) {
  const int step = compare::image_step(command.setting.options.raster.size);
  if (step == 1 || !wants_page(command)) return;
  const std::string note = fmt::format(
      "the report page shows one pixel of every {0} x {0}; all numbers and pictures are of all pixels", step);
  console.note(note);
  scene.notes.push_back(note);
}

Expected<Compared> render_and_compare(CompareCommand& command, const LoadedScene& loaded,
                                      compare::ViewErrors views, Console& console) {
  const auto lights = choose_lights(*loaded.scene, command.setting.light);
  if (!lights) return fail(lights.error());
  for (const std::string& note : options_without_effect(command.given, loaded.plan)) console.note(note);
  for (const std::string& note :
       options_without_effect(command.given, command.setting.options.raster.map, *loaded.scene, *lights))
    console.note(note);
  if (!wants_page(command))
    for (const std::string& note : page_options_without_effect(command.given)) console.note(note);
  const raster::RasterOptions& raster = command.setting.options.raster;
  const double map_bytes = bytes_per_texel * std::pow(double(raster.map.size), 2.0);
  const auto bytes = compare_bytes(*loaded.scene, *lights, raster.size, wants_page(command));
  const auto fits = check_memory(command.memory, raster.size, bytes, graphics_bytes + map_bytes);
  if (!fits) return fail(fits.error());
  auto compared = compare_picture(command, loaded, *lights, std::move(views), console);
  if (!compared) return compared;
  note_swimming(command, loaded, *lights, console);
  note_reduced_page(command, *loaded.scene, console);
  compare::Comparison& comparison = compared->comparison;
  comparison.seed = command.seed;
  comparison.machine = machine_info();
  comparison.fail_above = command.output.fail_above;
  comparison.rates = command.rates;
  comparison.load_ms = loaded.load_ms;
  comparison.peak_memory_bytes = peak_memory_bytes();
  return compared;
}

/// Compares one view for its numbers alone, untimed.
Expected<compare::Comparison> judge_view(const CompareCommand& command,
                                         const compare::CompareOptions& options, const LoadedScene& loaded,
                                         const std::vector<std::uint32_t>& lights,
                                         const raytrace::Tracer& tracer, raster::Renderer& renderer,
                                         compare::ErrorPlaces* places,
                                         compare::SubpixelSums* subpixels = nullptr) {
  const raster::RasterOptions& raster = options.raster;
  const auto bytes = compare_bytes(*loaded.scene, lights, raster.size, false);
  auto bands = plan_bands(command.memory, raster.size, bytes, raster::most_pixels(renderer, raster.map));
  if (!bands) return fail(bands.error());
  compare::Plan plan = compare::plan_of(tracer, lights, options);
  plan.bands = std::move(*bands);
  plan.page = false, plan.folder = folder_of_rows(command), plan.places = places, plan.subpixels = subpixels;
  compare::Comparison out;
  const auto measured =
      compare::measure(out, plan, compare::frames_of(tracer, renderer, lights, options), compare::Progress());
  if (!measured) return fail(measured.error());
  return out;
}

/// What the setting errs by from each view; camera and lights are then those of the worst.
Expected<compare::ViewErrors> judge_views(const CompareCommand& command, LoadedScene& loaded,
                                          const std::vector<compare::JudgedView>& views, Console& console) {
  const auto lights = choose_lights(*loaded.scene, command.setting.light);
  if (!lights) return fail(lights.error());
  compare::ViewErrors errors;
  errors.measure = command.output.fail_above ? command.output.fail_above->measure : command.output.measure;
  compare::CompareOptions options = command.setting.options;
  options.raster.runs = 0, options.raster.shadow_cost = false;
  options.raytrace.runs = 1, options.raytrace.warm_up = options.raytrace.picture = false;
  options.perceptual = errors.measure->needs == compare::FigureNeeds::perception;
  const compare::Pose own{loaded.scene->camera, loaded.scene->lights};
  errors.places = compare::places_of(*loaded.world, own.camera);
  {
    auto renderer = make_renderer(command.backend, loaded, console, command.shader_folder);
    if (!renderer) return fail(renderer.error());
    const raytrace::Tracer tracer(*loaded.world, options.accel, options.precision);
    for (const compare::JudgedView& view : views) {
      console.progress(view.name, double(errors.views.size()) / double(views.size()));
      const compare::Pose pose = view.pose(own);
      loaded.scene->camera = pose.camera, loaded.scene->lights = pose.lights;
      const auto compared = judge_view(command, options, loaded, *lights, tracer, **renderer, &errors.places);
      if (!compared) return fail(compared.error());
      add_view(errors, view.name, *compared);
    }
  }
  const compare::Pose worst = views[errors.worst].pose(own);
  loaded.scene->camera = worst.camera, loaded.scene->lights = worst.lights;
  return errors;
}

/// Compares a finer picture of the same view, for the means over several places in each pixel.
Expected<void> measure_subpixels(const CompareCommand& command, const LoadedScene& loaded,
                                 compare::Comparison& comparison, Console& console) {
  const int side = command.places_per_pixel == 16 ? 4 : 2;
  std::vector<std::uint32_t> lights;
  for (const compare::LightComparison& light : comparison.lights) lights.push_back(light.light);
  compare::CompareOptions options = command.setting.options;
  const ImageSize size = options.raster.size;
  options.raster.size = options.raytrace.size = {size.width * side, size.height * side};
  options.raster.runs = 0, options.raster.shadow_cost = false;
  options.raytrace.runs = 1, options.raytrace.warm_up = options.raytrace.picture = options.perceptual = false;
  auto renderer = make_renderer(command.backend, loaded, console, command.shader_folder);
  if (!renderer) return fail(renderer.error());
  const raytrace::Tracer tracer(*loaded.world, options.accel, options.precision);
  compare::SubpixelSums sums(size, side, lights.size());
  const auto finer = judge_view(command, options, loaded, lights, tracer, **renderer, nullptr, &sums);
  if (!finer) {
    Error error = finer.error();
    error.reason = fmt::format("--subpixels {}: {}", command.places_per_pixel, error.reason);
    return fail(std::move(error));
  }
  for (std::size_t i = 0; i < lights.size(); ++i) comparison.lights[i].subpixel = sums.figures(i);
  return {};
}

/// A denoiser's filter and a sampler's pattern are made of pixels: finer ones draw another picture.
Expected<void> check_subpixels(const CompareCommand& command) {
  if (command.places_per_pixel == 1 || !raster::samples_rays(command.setting.options.raster.map.technique))
    return {};
  return fail(ErrorKind::usage,
              "--subpixels: not with --technique rays, for a finer picture has other rays and another "
              "denoiser's width");
}

/// Compares nothing: keeps what the shaders of each folder draw, where the channels would go.
Expected<ExitCode> draw_each(const CompareCommand& command, const LoadedScene& loaded, Console& console) {
  const auto lights = choose_lights(*loaded.scene, command.setting.light);
  if (!lights) return fail(lights.error());
  raster::RasterOptions options =
      compare::drawing_options(command.setting.options.raster, command.setting.options.raytrace);
  options.runs = 0, options.shadow_cost = false, options.map_contents = false;
  compare::Comparison names;
  names.world = loaded.world.get();
  for (const std::uint32_t light : *lights) names.lights.emplace_back().light = light;
  std::unique_ptr<raster::Renderer> renderer;
  return for_each_shader(
      command.output.aov, [&](const std::string& shaders, const std::string& place) -> Expected<void> {
        if (!renderer) {
          auto made = make_renderer(command.backend, loaded, console, shaders);
          if (!made) return fail(made.error());
          renderer = std::move(*made);
        } else if (auto used = raster::use_shaders(*renderer, shaders); !used) {
          return used;
        }
        auto frame = renderer->render(options, *lights);
        if (!frame) return fail(frame.error());
        for (std::size_t i = 0; i < lights->size(); ++i) {
          const std::array channels{Channel{"drawn.V", std::move(frame->lights[i].visibility.data)}};
          const auto written =
              write_exr(compare::aov_path(names, names.lights[i], place), options.size, channels);
          if (!written) return written;
        }
        return {};
      });
}

/// One rule for both renderers.
void set_runs(CompareCommand& command) {
  raster::RasterOptions& raster = command.setting.options.raster;
  raytrace::RaytraceOptions& rays = command.setting.options.raytrace;
  raster.runs = rays.runs = command.runs.value_or(usual_runs);
  raster.enough_ms = rays.enough_ms = command.runs ? never_enough_ms : usual_enough_ms;
  raster.timed_as_judged = command.timed_as_judged;
  raster.least_subtracted = subtracted_runs_of_strips;
  raster.shadow_cost = !command.timed_as_judged;  // the drawing without shadows records nothing
  rays.warm_up = true;
}

Expected<ExitCode> run_compare(CompareCommand& command) {
  const Stopwatch total;
  Console console(command.output.quiet);
  if (command.output.folder.empty() && !only_prints_json(command.output))
    command.output.folder = default_output(command.scene.name);
  set_runs(command);
  command.setting.options.raytrace.size = command.setting.options.raster.size;
  command.setting.options.raytrace.seed = command.seed;

  RunFiles files;
  files.reads(command.scene);
  files.reads(path_file(command.path));
  files.reads_shaders(command.shader_folder);
  files.reads(command.rates_file);
  files.writes("--trace", command.trace);
  const auto is_given = [&](std::string_view option) {
    return std::ranges::count(command.given, option) > 0;
  };
  if (const auto fine = check_views(command.views, command.camera, command.path, false, is_given); !fine)
    return fail(fine.error());
  if (const auto fine = check_outputs(command.output, files); !fine) return fail(fine.error());
  if (const auto fine = check_subpixels(command); !fine) return fail(fine.error());
  if (!command.rates_file.empty()) {
    auto rates = compare::read_rates(command.rates_file);
    if (!rates) return fail(rates.error());
    command.rates = std::move(*rates);
  }
  auto loaded = load(command.scene, files, console, command.tessellate, command.camera,
                     follows_path(command.path), true, command.views.by_cameras());
  if (!loaded) return fail(loaded.error());
  if (command.exposure) loaded->scene->exposure = *command.exposure;
  keep_strongest_lights(*loaded, command.max_lights, named_lights(command.setting.light),
                        command.setting.poses, console);
  const auto posed = apply_poses(command.setting.poses, command.setting.light, *loaded);
  if (!posed) return fail(posed.error());
  const auto views = resolve_views(command.views, command.path, false, *loaded, *loaded->scene, console);
  if (!views) return fail(views.error());
  if (is_asked_for_each_shader()) return draw_each(command, *loaded, console);
  compare::ViewErrors errors;
  if (!views->empty()) {
    auto judged = judge_views(command, *loaded, *views, console);
    if (!judged) return fail(judged.error());
    errors = std::move(*judged);
  }
  auto compared = render_and_compare(command, *loaded, std::move(errors), console);
  if (!compared) return fail(compared.error());
  if (command.places_per_pixel > 1)
    if (const auto measured = measure_subpixels(command, *loaded, compared->comparison, console); !measured)
      return fail(measured.error());
  compared->comparison.total_ms = total.elapsed_ms();
  console.progress("writing", 1.0);
  if (only_prints_json(command.output))
    return print_result(command.output, compared->comparison, *loaded, console);
  return write_folder(command.output, compared->comparison, *loaded, files, total, console,
                      std::move(compared->parts));
}

void add_options(CLI::App& app, CompareCommand& command) {
  add_scene(app, command.scene);
  add_scene_time(app, command.scene);
  add_tessellate(app, command.tessellate);
  add_camera(app, command.camera);
  add_view_options(app, command.views);
  add_path_options(app, command.path);
  add_result_output(app, command.output, "out/NAME of the scene");
  add_setting_options(app, command.setting);
  add_max_lights(app, command.max_lights);
  add_run_options(app, command);
  add_memory(app, command.memory, command.scene.memory);
  add_shader_dir(app, command.shader_folder);
  add_runs(
      app, command.runs,
      fmt::format("{}, of maps, shading and rays alike, but no further one of a pass once those made took "
                  "{:g} ms together",
                  usual_runs, usual_enough_ms)
          .c_str());
  app.add_flag(
      "--timed-as-judged", command.timed_as_judged,
      "time shading with all that is recorded of it, so that nothing in a shader of --shader-dir tells "
      "a timed drawing from a judged one; in software in processor time; without shadow cost [default "
      "off]");
  add_value(app, "--subpixels", "4|16",
            describe("compare both shadows at so many places in each pixel as well, on silhouettes too",
                     "4 or 16", "the centre alone"),
            [&command](const std::string& text) -> Expected<void> {
              if (text != "4" && text != "16")
                return fail(ErrorKind::usage, fmt::format("(got {}, allowed 4 or 16)", text));
              command.places_per_pixel = text == "4" ? 4 : 16;
              return {};
            });
  add_value(app, "--rates", "FILE",
            "estimate what the shadows take on another machine, from what was counted and this file's rates "
            "(docs/rates.md) [default none]",
            [&command](const std::string& file) -> Expected<void> {
              command.rates_file = file;
              return {};
            });
  app.add_flag("--no-report", command.output.no_report,
               "write no report.html and spend no time on it; all other files as ever [default off]");
  add_result_limits(app, command.output);
}

}  // namespace

GNOMON_COMMAND(compare, 10,
               "Render with shadow maps and with rays, and report where the two shadows differ and why.") {
  app->footer(
      "gnomon compare fence\n"
      "gnomon compare model.glb --map-size 2048 --bias 0.5texel -o report\n"
      "gnomon compare whitted --light lamp --json - | jq .lights[0].error\n"
      "gnomon compare level.glb --cameras all --fail-above 2%    by its worst view\n"
      "gnomon compare scene.json --fail-above 1% --quiet    for scripts: exit code 1");
  const auto command = std::make_shared<CompareCommand>();
  command->command_line = invocation.command_line;
  add_options(*app, *command);
  bind_run(*app, invocation, command, run_compare);
}

}  // namespace gnomon::app
