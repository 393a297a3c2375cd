// Frames that RenderDoc recorded (.rdc): the script adapters/renderdoc replays them and makes captures of them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"

namespace gnomon::judge {

/// Whether a path names a recorded frame, by its end.
bool is_recorded_frame(std::string_view path);

/// Makes a capture of the frame's lights, capture.json and what it names, in a folder that is there. `light` counts from 1 as
/// recorded_lights() does; empty takes all. Returns what was found of the frame, one sentence each: bias, matrix, light and
/// camera with their residuals. Errors:
/// - ErrorKind::bad_input where no capture can be made of the frame
/// - usage where `light` is no number
/// - graphics where Python's module for RenderDoc is missing or the replay takes more than ten minutes or 16 GB
Expected<std::vector<std::string>> capture_recorded_frame(const std::string& frame, const std::string& folder,
                                                          const std::string& light);

/// Lists the frame's lights that have a shadow map, one line each: what they are, their map, its casters and readers. Errors as
/// above.
Expected<std::vector<std::string>> recorded_lights(const std::string& frame);

}  // namespace gnomon::judge
