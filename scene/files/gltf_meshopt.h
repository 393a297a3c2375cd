// EXT_meshopt_compression and KHR_meshopt_compression: bufferViews packed by meshoptimizer.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "scene/expected.h"
#include "scene/files/json_document.h"

namespace gnomon {

/// The bytes of the view, unpacked. `extension` is the view's object of that name; `buffers` are the file's;
/// `byte_length` is the view's own. The Error holds the reason alone. A size that the packed bytes cannot
/// fill is refused before anything is allocated.
Expected<std::vector<char>> unpack_meshopt(const JsonValue& extension,
                                           std::span<const std::string_view> buffers, double byte_length);

}  // namespace gnomon
