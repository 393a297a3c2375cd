// gnomon raster: the shadow-mapped picture alone.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/effect_options.h"
#include "app/interrupt.h"
#include "app/invocation.h"
#include "app/machine.h"
#include "app/options.h"
#include "app/output_path.h"
#include "app/picture_file.h"
#include "app/pose_options.h"
#include "app/render_json.h"
#include "app/session.h"
#include "app/technique_options.h"

namespace gnomon::app {

namespace {

struct RasterCommand {
  std::string scene, image, light, json, command_line;
  raster::RasterOptions options;
  raster::Backend backend = raster::Backend::automatic;
  std::string shader_folder;
  std::optional<std::optional<double>> exposure;
  PoseOptions poses;
  int threads = 0;
  int tessellate = 0;  ///< sectors; 0: shapes stay exact
  bool quiet = false;
  std::vector<std::string> given;  ///< options
};

// Measured: what the peak grows by from 320x180 to 2560x1440, with one light.
constexpr double png_bytes_per_pixel = 42.0;
constexpr double exr_bytes_per_pixel = 178.0;

Expected<ExitCode> run_raster(RasterCommand& command) {
  const Stopwatch watch;
  Console console(command.quiet);
  const ThreadLimit thread_limit(command.threads);
  if (command.image.empty()) command.image = default_output(command.scene) + "-raster.png";
  if (const auto known = check_extension("-o", command.image, ".png .exr"); !known)
    return fail(known.error());
  if (const auto writable = check_output_file(command.image); !writable) return fail(writable.error());
  if (const auto writable = check_output_file(command.json); !writable) return fail(writable.error());

  const bool records = command.image.ends_with(".exr");
  const double bytes = records ? exr_bytes_per_pixel : png_bytes_per_pixel;
  if (const auto fits = check_memory(command.options.size, bytes); !fits) return fail(fits.error());
  const auto loaded = load(command.scene, console, command.tessellate);
  if (!loaded) return fail(loaded.error());
  const auto lights = choose_lights(*loaded->scene, command.light);
  if (!lights) return fail(lights.error());
  for (const std::string& note : idle_options(command.given, command.options.map, *loaded->scene, *lights))
    console.note(note);
  const auto posed = apply_poses(command.poses, command.light, *loaded->scene, *loaded->world);
  if (!posed) return fail(posed.error());
  const auto renderer = make_renderer(command.backend, *loaded, command.shader_folder);
  if (!renderer) return fail(renderer.error());
  console.progress("shadow maps", 0.5);
  command.options.runs = command.json.empty() ? 0 : 1;
  command.options.analysis = records;
  const auto frame = (*renderer)->render(command.options, *lights);
  if (!frame) return fail(frame.error());

  const OutputGuard whole_outputs;
  if (const auto made = make_folder_for(command.image); !made) return fail(made.error());
  const double exposure = choose_exposure(command.exposure, *loaded->scene, frame->color);
  if (const auto written = write_picture(command.image, *loaded->world, *frame, exposure); !written) {
    return fail(written.error());
  }
  console.message(fmt::format("picture: {}", command.image));
  const RenderRecord record{command.command_line, command.image, *loaded, exposure, watch.elapsed_ms()};
  if (!command.json.empty())
    if (const auto out = hand_out_json(command.json, render_json(record, *frame)); !out)
      return fail(out.error());
  return ExitCode::done;
}

}  // namespace

void add_raster(CLI::App& program, Invocation& invocation) {
  CLI::App* app =
      program.add_subcommand("raster", "Render with shadow maps only: a PNG, or an EXR with its records.");
  app->footer(
      "gnomon raster fence -o fence.png\n"
      "gnomon raster model.glb --map-size 512 --bias 0.01 -o model.exr");
  const auto command = std::make_shared<RasterCommand>();
  add_scene(*app, command->scene);
  add_output(*app, "-o,--output", command->image, "IMAGE",
             ".png, or .exr with ids and, per light, visibility, gap and map position [default "
             "out/NAME-raster.png]");
  add_size(*app, command->options.size);
  add_tessellate(*app, command->tessellate);
  add_map_options(*app, command->options.map);
  add_light(*app, command->light,
            "put this light's records only into the .exr; the picture always has all lights");
  add_pose_options(*app, command->poses);
  add_backend(*app, command->backend);
  add_shader_dir(*app, command->shader_folder);
  add_threads(*app, command->threads, "threads of Mesa's software rasterizer");
  add_exposure(*app, command->exposure);
  add_json(*app, command->json, "what was drawn, costs and times");
  add_quiet(*app, command->quiet);
  app->callback([command, &invocation, app] {
    command->command_line = invocation.command_line;
    finish_map_options(*app, command->options.map);
    command->given = given_options(*app);
    invocation.action = [command] { return run_raster(*command); };
  });
}

}  // namespace gnomon::app
