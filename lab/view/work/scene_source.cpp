// CLI11 throws; what is thrown here is caught here.
#include "lab/view/work/scene_source.h"

#include <CLI/App.hpp>

#include "app/lesson_scene.h"
#include "app/options/map_options.h"
#include "app/options/options.h"

namespace gnomon::lab {

Expected<SceneSource> first_source(const LabOptions& options, app::Console& console) {
  app::RunFiles files;
  files.reads(options.scene);
  auto loaded = app::load(options.scene, files, console, options.tessellate, options.camera, true);
  if (!loaded) return fail(loaded.error());
  app::keep_strongest_lights(*loaded, options.max_lights, app::named_lights(options.light), options.poses,
                             console);
  if (options.exposure) loaded->scene->exposure = *options.exposure;
  return SceneSource{options.scene, options.camera,
                     std::make_shared<const app::LoadedScene>(std::move(*loaded)), files.inputs()};
}

Expected<SceneSource> read_source(const app::SceneArgument& argument, const std::string& camera,
                                  const StudioOptions& options) {
  app::Console quiet(true);
  LabOptions lab;
  lab.scene = argument, lab.camera = camera, lab.tessellate = options.tessellate;
  lab.max_lights = options.max_lights, lab.exposure = options.exposure;
  return first_source(lab, quiet);
}

Expected<raster::MapOptions> first_map_options(const app::SceneArgument& argument) {
  CLI::App command;
  command.set_help_flag();
  app::SceneArgument scene;
  raster::MapOptions map;
  app::add_scene(command, scene);
  app::add_map_options(command, map);
  try {
    command.parse(std::vector<std::string>{argument.name});
    app::add_lesson_settings(command);
    if (const auto added = app::add_scene_settings(command); !added) return fail(added.error());
    app::finish_map_options(command, map);
  } catch (const CLI::ParseError& error) {
    return fail(ErrorKind::bad_input, error.what());
  }
  return map;
}

}  // namespace gnomon::lab
