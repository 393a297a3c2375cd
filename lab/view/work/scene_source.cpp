// CLI11 throws; what is thrown here is caught here.
#include "lab/view/work/scene_source.h"

#include <CLI/App.hpp>

#include "app/lesson_scene.h"
#include "app/options/map_options.h"
#include "app/options/options.h"

namespace gnomon::app {

Expected<SceneSource> first_source(const LabOptions& options, Console& console) {
  RunFiles files;
  files.reads(options.scene);
  auto loaded = load(options.scene, files, console, options.tessellate, options.camera, true);
  if (!loaded) return fail(loaded.error());
  keep_strongest_lights(*loaded, options.max_lights, named_lights(options.light), options.poses, console);
  if (options.exposure) loaded->scene->exposure = *options.exposure;
  return SceneSource{options.scene, options.camera, std::make_shared<const LoadedScene>(std::move(*loaded)),
                     files.inputs()};
}

Expected<SceneSource> read_source(const SceneArgument& argument, const std::string& camera,
                                  const StudioOptions& options) {
  Console quiet(true);
  LabOptions lab;
  lab.scene = argument, lab.camera = camera, lab.tessellate = options.tessellate;
  lab.max_lights = options.max_lights, lab.exposure = options.exposure;
  return first_source(lab, quiet);
}

Expected<raster::MapOptions> first_map_options(const SceneArgument& argument) {
  CLI::App command;
  command.set_help_flag();
  SceneArgument scene;
  raster::MapOptions map;
  add_scene(command, scene);
  add_map_options(command, map);
  try {
    command.parse(std::vector<std::string>{argument.name});
    add_lesson_settings(command);
    if (const auto added = add_scene_settings(command); !added) return fail(added.error());
    finish_map_options(command, map);
  } catch (const CLI::ParseError& error) {
    return fail(ErrorKind::bad_input, error.what());
  }
  return map;
}

}  // namespace gnomon::app
