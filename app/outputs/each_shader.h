// What `gnomon grade` asks of one process for all the usual mistakes: the same drawing, or the same calls, with the shaders of
// many folders.
#pragma once

#include <functional>
#include <string>

#include "app/invocation.h"
#include "scene/base/expected.h"

namespace gnomon::app {

/// Whether the environment names a folder of such folders (raster::each_folder_variable).
bool is_asked_for_each_shader();

/// Calls `make` with each of them, and with `output` as the place of what it makes: DIR/values.exr becomes
/// DIR/NAME/values.exr. A folder whose shader is at fault leaves nothing there; any other error ends it.
Expected<ExitCode> for_each_shader(
    const std::string& output,
    const std::function<Expected<void>(const std::string& shaders, const std::string& place)>& make);

}  // namespace gnomon::app
