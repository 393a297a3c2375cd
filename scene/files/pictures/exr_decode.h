// OpenEXR files as most programs write them, read here: OpenImageIO takes longer to load than most pictures take to read
// (image_library.h), and a page has none.
#pragma once

#include <optional>
#include <string_view>

#include "scene/files/pictures/image_io.h"

namespace gnomon {

/// Reads one part of scan lines, of halves or floats, stored as they are or by ZIP (openexr.com, "OpenEXR File Layout"), of at most
/// max_image_side pixels a side; channels come as R, G, B, A and then the others by name. None where the file is of another kind, cut off or damaged.
std::optional<ChannelImage> decode_exr(std::string_view bytes);
/// Returns what the header of such a file says.
std::optional<ImageSize> exr_size(std::string_view bytes);

}  // namespace gnomon
