// What of OpenImageIO the program uses, behind an interface: the library brings some two hundred others
// along, whose loading takes longer than most pictures do. So it sits in a module of its own
// (image_module.cpp) that is loaded when an image file is read or an EXR is written, and not before.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/expected.h"
#include "scene/image.h"
#include "scene/picture_rows.h"

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

/// An EXR that is written some rows at a time, from the first on. Without close() it is not whole.
class ExrRows {
 public:
  virtual ~ExrRows() = default;
  /// Interleaved channels of `rows`, which begin where the last ones ended, and hold a multiple of 64 rows or the
  /// rest.
  virtual Expected<void> write(const PictureRows& rows, std::span<const float> pixels) = 0;
  virtual Expected<void> close() = 0;
};

class ImageLibrary {
 public:
  virtual ~ImageLibrary() = default;
  /// What the header of an image file says, of at most max_side pixels a side; nothing is decoded.
  virtual Expected<ImageSize> size(const std::string& path, int max_side) const = 0;
  /// An image file of at most max_side pixels a side, or one in memory whose format is known ("png", ...).
  virtual Expected<DecodedImage> read(const std::string& path, int max_side, DecodeAs as) const = 0;
  virtual Expected<DecodedImage> decode(const std::string& name, std::string_view bytes,
                                        std::string_view format, int max_side) const = 0;
  /// An EXR of float channels, interleaved; attributes: string metadata.
  virtual Expected<std::string> encode_exr(
      ImageSize size, std::span<const std::string> channels, std::span<const float> pixels,
      std::span<const std::pair<std::string, std::string>> attributes) const = 0;
  /// The same into a file, byte for byte.
  virtual Expected<std::unique_ptr<ExrRows>> open_exr(
      const std::string& path, ImageSize size, std::span<const std::string> channels,
      std::span<const std::pair<std::string, std::string>> attributes) const = 0;
};

/// Loads the module the first time. Errors: where it was looked for, and why it could not be loaded; too few threads can be
/// started for it (graphics).
Expected<const ImageLibrary*> image_library();

}  // namespace gnomon
