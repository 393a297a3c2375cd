// PNG and JPEG files by the libraries that are made for them. What textures of models come in does not load
// OpenImageIO, which takes a quarter of a second (image_library.h).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scene/files/image_library.h"

namespace gnomon {

/// The file is no image that can be read (bad input).
tl::unexpected<Error> bad_image(const std::string& file, std::string reason);

/// In 8 bits, colours as they are stored: of gamma and profiles nothing is applied, palettes and tRNS are. `name` is the
/// file, for messages. Error (bad input): the file is cut off or damaged, or a side is not in 1 … max_image_side.
Expected<DecodedImage> decode_png(const std::string& name, std::string_view bytes);

/// Grey or RGB; of what is stored as CMYK nothing. Errors as those of decode_png().
Expected<std::optional<DecodedImage>> decode_jpeg(const std::string& name, std::string_view bytes);

}  // namespace gnomon
