// A scene to show: read from its file, with what the viewer was told on the command line and what the scene or
// lesson asks of the shadow map.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/session.h"
#include "app/strongest_lights.h"
#include "compare/compare.h"

namespace gnomon::app {

/// What stays the same for every scene of a window.
struct StudioOptions {
  compare::CompareOptions compare;
  std::string shader_folder;  ///< replacements of shaders/ files; empty: none
  std::optional<std::optional<double>> exposure;
  int tessellate = 0;
  int max_lights = usual_max_lights;
};

struct SceneSource {
  SceneArgument argument;
  std::string camera;  ///< of the scene's cameras; empty: the first
  std::shared_ptr<const LoadedScene> loaded;
  std::vector<std::string> files;  ///< all that the scene consists of; none of a built-in one
};

Expected<SceneSource> read_source(const SceneArgument& argument, const std::string& camera,
                                  const StudioOptions& options);

/// The options of the shadow map that `gnomon view SCENE` begins with. Error (bad_input): the scene file asks for
/// what there is not.
Expected<raster::MapOptions> first_map_options(const SceneArgument& argument);

}  // namespace gnomon::app
