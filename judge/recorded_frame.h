// Frames that RenderDoc recorded (.rdc): the script adapters/renderdoc replays them and makes captures of them. It records
// frames of web pages, too.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"

namespace gnomon::judge {

/// Whether a path names a recorded frame, by its end.
bool is_recorded_frame(std::string_view path);

/// Whether a word names a web page: an address of http, https or file, or a file that ends with .html or .htm.
bool is_page(std::string_view word);

/// Opens a page in a browser without a screen and records its first frame with shadows to the file `frame`. `said` is called
/// with what is done and waited for, one sentence each. Returns what the engine calls itself, empty where it does not. Errors
/// name the page:
/// - ErrorKind::bad_input where it does not load, or draws no shadows
/// - cannot_write where the file cannot be written
/// - graphics where the browser or what records it is missing, or takes more than ten minutes
Expected<std::string> record_page(const std::string& page, const std::string& frame,
                                  const std::function<void(std::string)>& said);

/// Makes a capture of the frame's lights, capture.json and what it names, in a folder that is there. `light` counts from 1 as
/// recorded_lights() does; empty takes all. `renderer` is its name; empty: that of the frame. Returns what was found of the frame, one sentence each: bias, matrix, light and
/// camera with their residuals. Errors:
/// - ErrorKind::bad_input where no capture can be made of the frame
/// - usage where `light` is no number
/// - graphics where Python's module for RenderDoc is missing or the replay takes more than ten minutes or 16 GB
Expected<std::vector<std::string>> capture_recorded_frame(const std::string& frame, const std::string& folder,
                                                          const std::string& light,
                                                          const std::string& renderer = {});

/// Lists the frame's lights that have a shadow map, one line each: what they are, their map, its casters and readers. Errors as
/// above.
Expected<std::vector<std::string>> recorded_lights(const std::string& frame);

}  // namespace gnomon::judge
