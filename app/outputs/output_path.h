// Checks that outputs can be written, made before the work whose results they are to hold. Nothing is left
// behind.
#pragma once

#include <string>
#include <string_view>

#include "scene/base/expected.h"

namespace gnomon::app {

/// The folder, or the nearest one above it that exists, takes files; the path itself is not something else.
Expected<void> check_output_folder(const std::string& path);

/// The same for a file. An empty path and "-" (stdout) are always fine.
Expected<void> check_output_file(const std::string& path);

/// ErrorKind::usage when the path has none of the extensions (".png .exr"); `option` is named in the message.
Expected<void> check_extension(std::string_view option, const std::string& path, std::string_view extensions);

}  // namespace gnomon::app
