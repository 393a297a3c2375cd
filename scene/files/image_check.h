// A look at PNG and JPEG files before their libraries see them: libpng reports what it finds on the standard
// error stream, which is ours, and libjpeg fills what is missing with grey.
#pragma once

#include <string>
#include <string_view>

#include "scene/expected.h"

namespace gnomon {

/// The same picture with only the chunks that decide its pixels (IHDR, PLTE, tRNS, IDAT, IEND). Errors say
/// which chunk is cut off or damaged. `name` is the file, for messages.
Expected<std::string> essential_png(std::string_view bytes, const std::string& name);

/// An error when the file ends before its picture does.
Expected<void> check_jpeg_is_whole(std::string_view bytes, const std::string& name);

}  // namespace gnomon
