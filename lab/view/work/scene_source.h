// A scene to show: read from its file, with what the viewer was told on the command line and what the scene or
// lesson asks of the shadow map.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/outputs/run_files.h"
#include "app/session.h"
#include "app/strongest_lights.h"
#include "compare/compare.h"
#include "lab/lab_options.h"
#include "lab/view/state/state.h"
#include "scene/base/expected.h"

namespace gnomon::lab {

/// What stays the same for every scene of a window.
struct StudioOptions {
  compare::CompareOptions compare;
  std::string shader_folder;  ///< replacements of shaders/ files; empty: none
  std::optional<std::optional<double>> exposure;
  int tessellate = 0;
  int max_lights = app::usual_max_lights;
};

struct SceneSource {
  app::SceneArgument argument;
  std::string camera;  ///< of the scene's cameras; empty: the first
  std::shared_ptr<const app::LoadedScene> loaded;
  std::vector<std::string> files;  ///< all that the scene consists of; none of a built-in one
};

/// Reads the scene that a lab begins with, and says what is to be said of it.
Expected<SceneSource> first_source(const LabOptions& options, app::Console& console);

/// Reads another one.
Expected<SceneSource> read_source(const app::SceneArgument& argument, const std::string& camera,
                                  const StudioOptions& options);

/// The options of the shadow map that `gnomon view SCENE` begins with. Error (bad_input): the scene file asks for
/// what there is not.
Expected<raster::MapOptions> first_map_options(const app::SceneArgument& argument);

// A scene file of what the window shows: the scene that was opened, with the camera, the lights and the settings
// of the shadow map as they are now.

/// A .json that `gnomon compare` takes. A scene in the project's own format is written again with all that is in
/// it, but for comments; a model is included, and a file that the scene names must lie in the new file's folder
/// or below. Its lights are all of the file's own, whatever file brought them, and those that the state has: what
/// --max-lights left out is left out here. Error: usage where the place is wrong; what stood there is then left as it was.
Expected<void> write_scene(const std::string& path, const app::SceneArgument& opened, const ViewState& state);

/// Where such a file of this scene finds all that it names: the scene's own folder.
std::string folder_for_scene(const app::SceneArgument& opened);

}  // namespace gnomon::lab
