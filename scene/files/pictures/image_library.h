// What of OpenImageIO the program uses, behind an interface: the library brings some two hundred others
// along, whose loading takes longer than most pictures do. So it sits in a module of its own
// (image_module.cpp). That is loaded when an image file is read that is none of PNG, JPEG and the usual kinds of EXR, and not
// before.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/base/expected.h"
#include "scene/image.h"

namespace gnomon {

/// Pixel by pixel, channel by channel, row 0 at the top: in bytes, or in floats.
struct DecodedImage {
  ImageSize size;
  std::vector<std::string> channels;
  std::vector<std::uint8_t> bytes;
  std::vector<float> floats;
};

enum class DecodeAs { stored, floats };  ///< stored: floats where the file holds floating-point values

/// What the decoded samples of an image file may weigh, bytes. No compression that the formats have makes
/// more than 1,032 bytes of one (deflate; Gailly and Adler, zlib technical details), and what small files
/// with empty parts say of themselves is allowed up to a limit.
inline std::uint64_t image_budget(std::uint64_t file_bytes) {
  return (std::uint64_t{64} << 20) + 1100 * file_bytes;
}

/// Asked what a file's header says, before anything is decoded: its size, and the bytes of a pixel once it is decoded. An error
/// ends the reading. An empty one takes all.
using HeaderCheck = std::function<Expected<void>(const ImageSize& size, std::size_t bytes_per_pixel)>;

class ImageLibrary {
 public:
  virtual ~ImageLibrary() = default;
  /// What the header of an image file says, of at most max_side pixels a side; nothing is decoded.
  virtual Expected<ImageSize> size(const std::string& path, int max_side) const = 0;
  /// An image file of at most max_side pixels a side, or one in memory whose format is known ("png", ...).
  virtual Expected<DecodedImage> read(const std::string& path, int max_side, DecodeAs as,
                                      const HeaderCheck& check) const = 0;
  virtual Expected<DecodedImage> decode(const std::string& name, std::string_view bytes,
                                        std::string_view format, int max_side,
                                        const HeaderCheck& check) const = 0;
};

/// Loads the module the first time. Errors: where it was looked for, and why it could not be loaded; too few threads can be
/// started for it (graphics).
Expected<const ImageLibrary*> image_library();

// PNG and JPEG files by the libraries that are made for them. What textures of models come in does not load
// OpenImageIO, which takes a quarter of a second (image_library.h).

/// The file is no image that can be read (bad input).
tl::unexpected<Error> bad_image(const std::string& file, std::string reason);

/// In 8 bits, or in floats that are fractions of the largest value; colours as they are stored: of gamma and profiles nothing is
/// applied, palettes and tRNS are. `name` is the file, for messages. Error (bad input): the file is cut off or damaged, or a side
/// is not in 1 … max_image_side. Others are those of `check`.
Expected<DecodedImage> decode_png(const std::string& name, std::string_view bytes,
                                  DecodeAs as = DecodeAs::stored, const HeaderCheck& check = {});
/// Returns what the header says. Errors as those of decode_png().
Expected<ImageSize> png_size(const std::string& name, std::string_view bytes);

/// Grey or RGB; of what is stored as CMYK nothing. Errors as those of decode_png().
Expected<std::optional<DecodedImage>> decode_jpeg(const std::string& name, std::string_view bytes,
                                                  const HeaderCheck& check = {});

}  // namespace gnomon
