// Image files. PNG is written by libpng (png_encode.cpp). PNG and JPEG are read by the libraries made for them (png_decode.cpp,
// jpeg_decode.cpp). EXR of the usual kinds is read and written here (exr_decode.h, exr_encode.h). Everything else is read by
// OpenImageIO (image_library.h). Writes are whole or not at all (write_file.h).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/base/expected.h"
#include "scene/files/pictures/image_library.h"
#include "scene/image.h"
#include "scene/scene.h"

namespace gnomon {

inline constexpr int max_image_side =
    16384;  ///< pixels; larger files are refused before anything is allocated

/// Reads an image file, or an encoded image in memory (`bytes`, with `name` for messages), as 8-bit RGBA. A
/// file of floating-point values is linear by nature: it is clipped to [0, 1], encoded as sRGB where `srgb`,
/// and refused if a value is not finite.
/// Errors of `check` are passed on (texture_memory.h).
Expected<Texture> read_texture(const std::string& path, bool srgb, const HeaderCheck& check = {});
Expected<Texture> read_texture_bytes(const std::string& name, std::string_view bytes, bool srgb,
                                     const HeaderCheck& check = {});

/// A texture with what its file says of alpha.
struct TextureFile {
  Texture texture;
  bool has_alpha = false;  ///< the file has an alpha channel; without one the texture is opaque
};

/// Reads a file as read_texture() does.
Expected<TextureFile> read_texture_file(const std::string& path, bool srgb, const HeaderCheck& check = {});

/// [0, 1], clipped, to 0 ... 255, rounded to nearest.
inline std::uint8_t to_8_bit(float value) {
  return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}
/// Linear [0, 1] to sRGB (IEC 61966-2-1).
float srgb_from_linear(float linear);
float linear_from_srgb(float srgb);
/// Multiplies by exposure, clips to [0, 1], encodes as sRGB and rounds to nearest. A pixel with a NaN is
/// magenta.
Rgb8Image display_image(const ColorImage& linear, double exposure);

/// A PNG in memory (for embedding) and on disk.
Expected<std::string> encode_png(const Rgb8Image& image);
/// The texels as they are stored; with alpha where one of them is not opaque.
Expected<std::string> encode_png(const Texture& texture);
Expected<void> write_png(const std::string& path, const Rgb8Image& image);

/// A named 32-bit float channel, row 0 at the top.
struct Channel {
  std::string name;
  std::vector<float> values;
};
/// EXR files keep their channels sorted by name; the names are what a reader goes by. attributes: string
/// metadata.
Expected<void> write_exr(const std::string& path, ImageSize size, std::span<const Channel> channels,
                         std::span<const std::pair<std::string, std::string>> attributes = {});

/// Every channel of the first part of an image file, as 32-bit float (integers as fractions of their
/// maximum).
struct ChannelImage {
  ImageSize size;
  std::vector<Channel> channels;
  const Channel* find(std::string_view name) const;  ///< nullptr when there is none
};
Expected<ChannelImage> read_channels(const std::string& path);
/// What the header of an image file says; nothing is decoded.
Expected<ImageSize> read_image_size(const std::string& path);

}  // namespace gnomon
