// gnomon raster: the shadow-mapped picture alone.
#include <CLI/CLI.hpp>
#include <memory>

#include "app/effect_options.h"
#include "app/invocation.h"
#include "app/options.h"
#include "app/picture_command.h"
#include "app/picture_file.h"
#include "app/pose_options.h"
#include "app/session.h"
#include "app/technique_options.h"

namespace gnomon::app {

namespace {

struct RasterCommand : PictureCommand {
  raster::RasterOptions options;
  raster::Backend backend = raster::Backend::automatic;
  std::string shader_folder;
};

// Measured from 320x180 to 2560x1440, with one light.
constexpr BytesPerPixel bytes_per_pixel{.png = 42.0, .exr = 178.0};

Expected<ExitCode> run_raster(RasterCommand& command) {
  const Stopwatch watch;
  Console console(command.quiet);
  const ThreadLimit thread_limit(command.threads, console);
  auto files = check_files(command, "raster");
  if (!files) return fail(files.error());
  auto loaded = open_scene(command, *files, command.options.size, bytes_per_pixel, console);
  if (!loaded) return fail(loaded.error());
  const auto lights = choose_lights(*loaded->scene, command.light);
  if (!lights) return fail(lights.error());
  const auto posed = apply_poses(command.poses, command.light, *loaded);
  if (!posed) return fail(posed.error());
  for (const std::string& note : idle_options(command.given, command.options.map, *loaded->scene, *lights))
    console.note(note);
  const auto renderer = make_renderer(command.backend, *loaded, command.shader_folder);
  if (!renderer) return fail(renderer.error());
  console.progress("shadow maps", 0.5);
  command.options.runs = command.json.empty() ? 0 : 1;
  command.options.analysis = command.wants_records() || !command.shader_folder.empty();
  const auto frame = (*renderer)->render(command.options, *lights);
  if (!frame) return fail(frame.error());
  const auto used = check_shaders_used(command.shader_folder, *frame, *loaded->scene, console);
  if (!used) return fail(used.error());
  const PictureWriter writer{
      .picture =
          [&](double exposure) { return write_picture(command.image, *loaded->world, *frame, exposure); },
      .json = [&](const RenderRecord& record) { return render_json(record, *frame); }};
  return hand_out(command, *loaded, frame->color, writer, watch, console);
}

}  // namespace

void add_raster(CLI::App& program, Invocation& invocation) {
  CLI::App* app =
      program.add_subcommand("raster", "Render with shadow maps only: a PNG, or an EXR with its records.");
  app->footer(
      "gnomon raster fence -o fence.png\n"
      "gnomon raster model.glb --map-size 512 --bias 0.01 -o model.exr");
  const auto command = std::make_shared<RasterCommand>();
  add_picture_subject(*app, *command, command->options.size,
                      ".png, or .exr with ids and, per light, visibility, gap and map position [default "
                      "out/NAME-raster.png]");
  add_map_options(*app, command->options.map);
  add_light(*app, command->light,
            "put this light's records only into the .exr; the picture always has all lights");
  add_pose_options(*app, command->poses);
  add_backend(*app, command->backend);
  add_shader_dir(*app, command->shader_folder);
  add_picture_manner(*app, *command, "threads of Mesa's software rasterizer",
                     "what was drawn, costs and times");
  app->callback([command, &invocation, app] {
    invocation.finish = [command, app] { finish_map_options(*app, command->options.map); };
    note_call(*app, invocation, *command);
    invocation.action = [command] { return run_raster(*command); };
  });
}

}  // namespace gnomon::app
