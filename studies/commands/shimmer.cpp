// gnomon shimmer: what shadows do from frame to frame that they should not.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <memory>

#include "app/commands.h"
#include "app/options/option_kinds.h"
#include "app/options/options.h"
#include "app/options/setting_options.h"
#include "app/options/shimmer_options.h"
#include "app/outputs/render_json.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "app/session.h"
#include "app/strongest_lights.h"
#include "scene/base/timing.h"
#include "scene/load.h"
#include "studies/shimmer/outputs.h"

namespace gnomon::app {

namespace {

struct ShimmerCommand {
  SceneArgument scene;
  std::string camera, folder, json, trace, shader_folder;
  SettingOptions setting;
  FilmOptions film;
  studies::FilmFormat film_format = studies::FilmFormat::apng;
  double report_max_mb = studies::default_film_max_mb;
  std::optional<double> fail_above;  ///< flips per receiver and second
  raster::Backend backend = raster::Backend::automatic;
  std::uint64_t seed = 0;
  int threads = 0;
  int tessellate = 0;
  int max_lights = usual_max_lights;
  bool quiet = false;
  std::string command_line;
  std::vector<std::string> given;  ///< options
};

constexpr std::pair<std::string_view, studies::FilmFormat> film_formats[] = {
    {"apng", studies::FilmFormat::apng}, {"mp4", studies::FilmFormat::mp4}};

Expected<RunFiles> check_files(ShimmerCommand& command) {
  if (command.folder.empty() && command.json != "-")
    command.folder = default_output(command.scene.name) + "-shimmer";
  if (const auto fine = studies::check_film_format(command.film_format); !fine) return fail(fine.error());
  RunFiles files;
  files.reads(command.scene);
  files.reads(path_file(command.film));
  files.reads_shaders(command.shader_folder);
  files.writes("--json", command.json);
  files.writes("--trace", command.trace);
  constexpr std::array<std::string_view, 2> names{"report.html", "result.json"};
  if (!command.folder.empty()) files.writes_folder("-o", command.folder, names);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  return files;
}

struct Filmed {
  studies::Shimmer shimmer;
  std::optional<studies::FilmRecorder> pictures;  ///< where a folder is asked for
};

Expected<Filmed> make_film(const ShimmerCommand& command, const LoadedScene& loaded, Console& console) {
  const auto lights = choose_lights(*loaded.scene, command.setting.light);
  if (!lights) return fail(lights.error());
  for (const std::string& note : options_without_effect(command.given, loaded.plan)) console.note(note);
  for (const std::string& note :
       options_without_effect(command.given, command.setting.options.raster.map, *loaded.scene, *lights))
    console.note(note);
  const StageSource source{command.scene, command.camera, command.backend, command.shader_folder};
  auto plan = resolve_film(command.film, loaded.paths, *loaded.scene, console, &source);
  if (!plan) return fail(plan.error());
  auto renderer = make_renderer(command.backend, loaded, console, command.shader_folder);
  if (!renderer) return fail(renderer.error());
  studies::ShimmerOptions options{std::move(*plan), command.setting.options};
  options.compare.raytrace.seed = command.seed;
  Filmed out;
  studies::FrameSink sink;
  if (!command.folder.empty()) {
    auto base = studies::unshadowed_picture(*loaded.scene, **renderer, options);
    if (!base) return fail(base.error());
    out.pictures.emplace(std::move(*base), options.time.fps);
    sink = [&](const studies::ShimmerFrame& frame) { return out.pictures->add(frame); };
  }
  auto shimmer =
      studies::film_shimmer(*loaded.world, *loaded.scene, **renderer, *lights, options, sink,
                            [&](std::string_view stage, double done) { console.progress(stage, done); });
  if (!shimmer) return fail(shimmer.error());
  out.shimmer = std::move(*shimmer);
  return out;
}

Expected<void> write_all(const ShimmerCommand& command, const Filmed& film, const std::string& json,
                         const RunFiles& files, Console& console) {
  const OutputGuard whole_outputs;
  if (!film.pictures) return hand_out_json(command.json, json);
  const std::vector<FileText> texts{{command.json, json}};
  const auto megabytes = studies::write_shimmer(
      film.shimmer, *film.pictures, json,
      {command.folder, command.report_max_mb, files.inputs(), command.film_format, texts_for_files(texts)});
  if (!megabytes) return fail(megabytes.error());
  if (*megabytes > command.report_max_mb) console.note(beside_note(*megabytes, command.report_max_mb));
  print_texts(texts);
  return {};
}

ExitCode judge_lights(const ShimmerCommand& command, const studies::Shimmer& film, Console& console) {
  ExitCode code = ExitCode::done;
  if (!command.fail_above) return code;
  const auto nothing = [](const studies::ShimmerLight& light) {
    return light.temporal.total().receivers == 0;
  };
  if (std::all_of(film.lights.begin(), film.lights.end(), nothing)) {
    console.message(fmt::format("no receiver could be compared, so nothing holds against --fail-above {:g}",
                                *command.fail_above));
    return ExitCode::threshold_exceeded;
  }
  for (const studies::ShimmerLight& light : film.lights) {
    const double flips = studies::flips_per_receiver_second(film.options, light);
    if (!(flips > *command.fail_above)) continue;
    console.message(
        fmt::format("light {}: {:g} flips per receiver and second; that is more than --fail-above {:g}",
                    film.world->scene->lights[light.light].name, flips, *command.fail_above));
    code = ExitCode::threshold_exceeded;
  }
  return code;
}

Expected<ExitCode> run_shimmer(ShimmerCommand& command) {
  const Stopwatch total;
  Console console(command.quiet);
  auto files = check_files(command);
  if (!files) return fail(files.error());
  auto loaded = load(command.scene, *files, console, command.tessellate, command.camera, true);
  if (!loaded) return fail(loaded.error());
  keep_strongest_lights(*loaded, command.max_lights, named_lights(command.setting.light),
                        command.setting.poses, console);
  const auto posed = apply_poses(command.setting.poses, command.setting.light, *loaded);
  if (!posed) return fail(posed.error());
  const auto film = make_film(command, *loaded, console);
  if (!film) return fail(film.error());
  console.clear_progress();
  const std::string json =
      studies::shimmer_json(film->shimmer, {command.command_line, command.seed, total.elapsed_ms()});
  if (const auto written = write_all(command, *film, json, *files, console); !written)
    return fail(written.error());
  if (!command.quiet && command.json != "-") print_data(studies::shimmer_table(film->shimmer));
  if (!command.folder.empty())
    console.message(
        fmt::format("report: {}/report.html ({:.1f} s)", command.folder, total.elapsed_ms() / 1000.0));
  return judge_lights(command, film->shimmer, console);
}

void add_options(CLI::App& app, ShimmerCommand& command) {
  add_scene(app, command.scene);
  add_tessellate(app, command.tessellate);
  add_camera(app, command.camera);
  add_output(app, "-o,--output", command.folder, "DIR",
             "folder for report.html, result.json and the film files [default out/NAME-shimmer; "
             "none with --json - alone]");
  add_film_options(app, command.film);
  add_choice(app, "--film", command.film_format, film_formats, "FORMAT",
             "of the film files; mp4 needs ffmpeg to be installed");
  add_setting_options(app, command.setting);
  add_max_lights(app, command.max_lights);
  add_backend(app, command.backend);
  add_shader_dir(app, command.shader_folder);
  add_threads(app, command.threads, "threads of the ray tracer and of Mesa's software rasterizer");
  add_seed(app, command.seed, "of the samples of lights with size; recorded in the result");
  add_value(app, "--fail-above", "NUMBER",
            describe("exit with 1 when any light has more flips per receiver and second than this",
                     "flips, 0 or more", "never"),
            [&command](const std::string& text) {
              return assign(command.fail_above, parse_number(text, {0.0, 1e9}));
            });
  add_report_max_mb(app, command.report_max_mb);
  add_json(app, command.json, "the result");
  add_quiet(app, command.quiet);
}

}  // namespace

GNOMON_COMMAND(
    shimmer, 130,
    "Move camera or light, and report what shadows do from frame to frame that they should not, and why.") {
  app->footer(
      "gnomon shimmer courtyard\n"
      "gnomon shimmer courtyard --technique csm --path walk --frames 120\n"
      "gnomon shimmer fence --move light --path sun --speed 0.02\n"
      "gnomon shimmer scene.json --path drift --drift 0.2,0.1 --json - | jq .lights[0].flips");
  const auto command = std::make_shared<ShimmerCommand>();
  command->command_line = invocation.command_line;
  add_options(*app, *command);
  bind_run(*app, invocation, command, run_shimmer);
}

}  // namespace gnomon::app
