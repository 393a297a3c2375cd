// gnomon raster: the shadow-mapped picture alone.
#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands.h"
#include "app/invocation.h"
#include "app/options/effect_options.h"
#include "app/options/map_options.h"
#include "app/options/options.h"
#include "app/options/pose_options.h"
#include "app/outputs/picture_bands.h"
#include "app/outputs/picture_command.h"
#include "app/outputs/run_files.h"
#include "app/session.h"
#include "raster/bands.h"

namespace gnomon::app {

namespace {

struct RasterCommand : PictureCommand {
  raster::RasterOptions options;
  raster::Backend backend = raster::Backend::automatic;
  std::string shader_folder;
};

constexpr BytesPerPixel raster_bytes_per_pixel{.png = raster_png, .exr = raster_exr};

struct Drawing {
  const RasterCommand& command;
  const LoadedScene& loaded;
  raster::Renderer& renderer;
  const std::vector<std::uint32_t>& lights;
};

/// Band by band into the picture; `costs` are of all of them.
Expected<void> draw_in_bands(const Drawing& in, const std::vector<PictureRows>& bands, PictureBands& picture,
                             raster::RasterFrame& costs, Console& console) {
  const raster::RasterOptions& options = in.command.options;
  if (in.command.wants_records())  // an .exr grows in its place
    if (const auto made = make_folder_for(in.command.image); !made) return made;
  for (const PictureRows& rows : bands) {
    console.progress("drawing in bands", double(rows.first) / options.size.height);
    raster::set_rows(in.renderer, rows);
    const auto frame = in.renderer.render(options, in.lights);
    if (!frame) return fail(frame.error());
    if (const auto added = picture.add(*frame, rows); !added) return fail(added.error());
    raster::add_costs(*frame, costs);
  }
  raster::set_rows(in.renderer, std::nullopt);
  return {};
}

Expected<void> draw_whole(const Drawing& in, raster::RasterFrame& frame) {
  auto drawn = in.renderer.render(in.command.options, in.lights);
  if (!drawn) return fail(drawn.error());
  frame = std::move(*drawn);
  return {};
}

Expected<ExitCode> run_raster(RasterCommand& command) {
  const Stopwatch watch;
  Console console(command.quiet);
  auto files = check_files(command, "raster");
  if (!files) return fail(files.error());
  files->reads_shaders(command.shader_folder);
  auto loaded = open_scene(command, *files, command.options.size, raster_bytes_per_pixel, console);
  if (!loaded) return fail(loaded.error());
  const auto lights = choose_lights(*loaded->scene, command.light);
  if (!lights) return fail(lights.error());
  const auto posed = apply_poses(command.poses, command.light, *loaded);
  if (!posed) return fail(posed.error());
  const auto drawn_lights = choose_lights(*loaded->scene, "");  // --light chooses records alone
  if (!drawn_lights) return fail(drawn_lights.error());
  for (const std::string& note :
       options_without_effect(command.given, command.options.map, *loaded->scene, *drawn_lights))
    console.note(note);
  const auto renderer = make_renderer(command.backend, *loaded, console, command.shader_folder);
  if (!renderer) return fail(renderer.error());
  console.progress("shadow maps", 0.5);
  command.options.runs = command.json.empty() ? 0 : 1;
  command.options.analysis = command.wants_records() || !command.shader_folder.empty();
  const auto bands = plan_bands(command.memory, command.options.size, raster_bytes_per_pixel.of(command),
                                raster::most_pixels(**renderer, command.options.map));
  if (!bands) return fail(bands.error());
  raster::RasterFrame frame;
  PictureBands picture(command.image, *loaded->world, command.options.size,
                       known_exposure(command.exposure, *loaded->scene));
  const Drawing drawing{command, *loaded, **renderer, *lights};
  const bool whole = bands->size() == 1;
  const auto drawn =
      whole ? draw_whole(drawing, frame) : draw_in_bands(drawing, *bands, picture, frame, console);
  if (!drawn) return fail(drawn.error());
  const auto used = check_shaders_used(command.shader_folder, frame, *loaded->scene, console);
  if (!used) return fail(used.error());
  const PictureWriter writer{.picture =
                                 [&](const std::string& place) {
                                   return whole ? write_whole(command, *loaded, frame, place)
                                                : picture.finish(place);
                                 },
                             .json = [&](const RenderRecord& record) { return render_json(record, frame); }};
  return hand_out(command, *loaded, writer, watch, console);
}

}  // namespace

GNOMON_COMMAND(raster, 20, "Render with shadow maps only: a PNG, or an EXR with its records.") {
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
