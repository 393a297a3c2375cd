// A scene file of what the window shows: the scene that was opened, with the camera, the lights and the settings
// of the shadow map as they are now.
#pragma once

#include <string>

#include "app/run_files.h"
#include "app/view/state.h"
#include "scene/expected.h"

namespace gnomon::app {

/// A .json that `gnomon compare` takes. A scene in the project's own format is written again with all that is in
/// it, but for comments; a model is included, and a file that the scene names must lie in the new file's folder
/// or below. Its lights are all of the file's own, whatever file brought them, and those that the state has: what
/// --max-lights left out is left out here. Error: usage where the place is wrong; what stood there is then left as it was.
Expected<void> write_scene(const std::string& path, const SceneArgument& opened, const ViewState& state);

/// Where such a file of this scene finds all that it names: the scene's own folder.
std::string folder_for_scene(const SceneArgument& opened);

}  // namespace gnomon::app
