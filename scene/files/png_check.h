// A look at a PNG file's chunks before libpng sees them: libpng reports what it finds on the standard error
// stream, which is ours, so that broken files must not reach it.
#pragma once

#include <string>
#include <string_view>

#include "scene/expected.h"

namespace gnomon {

/// The same picture with only the chunks that decide its pixels (IHDR, PLTE, tRNS, IDAT, IEND). Errors say
/// which chunk is cut off or damaged. `name` is the file, for messages.
Expected<std::string> essential_png(std::string_view bytes, const std::string& name);

}  // namespace gnomon
