#include "scene/files/pictures/image_io.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "scene/base/parallel.h"
#include "scene/files/pictures/exr_decode.h"
#include "scene/files/pictures/exr_encode.h"
#include "scene/files/pictures/image_library.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"

namespace gnomon {
namespace {

// The reader is chosen by the bytes, never by the name (which may be a mesh's, with no extension).
std::string_view format_of(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG")) return "png";
  if (bytes.starts_with("\xff\xd8\xff")) return "jpeg";
  if (bytes.size() >= 12 && bytes.starts_with("RIFF") && bytes.substr(8, 4) == "WEBP") return "webp";
  if (bytes.starts_with("BM")) return "bmp";
  if (bytes.starts_with("v/1\x01")) return "openexr";
  if (bytes.starts_with("#?RADIANCE")) return "hdr";
  if (bytes.starts_with("GIF8")) return "gif";
  return "";
}

Expected<DecodedImage> decode(const std::string& name, std::string_view bytes, const HeaderCheck& check) {
  const std::string_view format = format_of(bytes);
  if (format.empty())
    return bad_image(name,
                     "image in a format that is not known (allowed PNG, JPEG, WebP, BMP, "
                     "EXR, HDR, GIF, TGA)");
  if (format == "png") return decode_png(name, bytes, DecodeAs::stored, check);
  if (format == "jpeg") {
    auto jpeg = decode_jpeg(name, bytes, check);
    if (!jpeg) return fail(jpeg.error());
    if (*jpeg) return std::move(**jpeg);
  }
  const auto library = image_library();
  if (!library) return fail(library.error());
  return (*library)->decode(name, bytes, format, max_image_side, check);
}

Expected<DecodedImage> decode_floats(const std::string& path, std::string_view bytes) {
  if (format_of(bytes) == "png") return decode_png(path, bytes, DecodeAs::floats);
  const auto library = image_library();
  if (!library) return fail(library.error());
  return (*library)->read(path, max_image_side, DecodeAs::floats, {});
}

Expected<std::vector<std::uint8_t>> floats_as_bytes(const std::string& name, const std::vector<float>& floats,
                                                    std::size_t channels, bool srgb) {
  const auto bad = std::count_if(floats.begin(), floats.end(), [](float v) { return !std::isfinite(v); });
  if (bad > 0) return bad_image(name, fmt::format("{} values are not finite numbers", bad));
  std::vector<std::uint8_t> bytes(floats.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::size_t channel = i % channels;
    const bool is_alpha = channel == 3 || (channels == 2 && channel == 1);
    const float value = floats[i];
    bytes[i] = to_8_bit(srgb && !is_alpha ? srgb_from_linear(std::clamp(value, 0.0f, 1.0f)) : value);
  }
  return bytes;
}

// 1 channel is grey, 2 grey and alpha, 3 RGB, 4 RGBA; more are not looked at.
glm::u8vec4 rgba(const std::uint8_t* value, std::size_t channels) {
  if (channels == 1) return {value[0], value[0], value[0], 255};
  if (channels == 2) return {value[0], value[0], value[0], value[1]};
  return {value[0], value[1], value[2], channels == 3 ? std::uint8_t{255} : value[3]};
}

Expected<TextureFile> texture_from(const std::string& name, DecodedImage image, bool srgb) {
  const std::size_t channels = image.channels.size();
  if (!image.floats.empty()) {
    auto bytes = floats_as_bytes(name, image.floats, channels, srgb);
    if (!bytes) return fail(bytes.error());
    image.bytes = std::move(*bytes);
  }
  Texture texture;
  texture.name = name;
  texture.size = image.size;
  texture.srgb = srgb;
  texture.texels.reserve(texture.size.pixels());
  for (std::size_t i = 0; i < texture.size.pixels(); ++i)
    texture.texels.push_back(rgba(image.bytes.data() + i * channels, channels));
  return TextureFile{std::move(texture), channels == 2 || channels >= 4};
}

Expected<TextureFile> texture_from_bytes(const std::string& name, std::string_view bytes, bool srgb,
                                         const HeaderCheck& check) {
  auto image = decode(name, bytes, check);
  if (!image) return fail(image.error());
  return texture_from(name, std::move(*image), srgb);
}

Expected<Texture> texture_alone(Expected<TextureFile> file) {
  if (!file) return fail(file.error());
  return std::move(file->texture);
}

Expected<void> check_size(ImageSize size) {
  if (size.width > 0 && size.height > 0) return {};
  return fail(ErrorKind::internal,
              fmt::format("cannot encode an image of {} x {} pixels", size.width, size.height));
}

// Encoding by search: code k begins where the decoding of (k - 1/2) / 255 lies. Steps of `linear` are so
// narrow that no two codes begin in one: a value's code is that of its step's lower end, or the next.
class SrgbCodes {
 public:
  SrgbCodes() {
    for (std::size_t i = 0; i < 255; ++i) {
      const double encoded = (static_cast<double>(i) + 0.5) / 255.0;
      begin_[i + 1] = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
    }
    begin_[0] = 0.0, begin_[256] = infinity;
    for (std::size_t i = 0, code = 0; i < steps; ++i) {
      while (begin_[code + 1] <= static_cast<double>(i) / steps) ++code;
      code_at_[i] = static_cast<std::uint8_t>(code);
    }
  }

  /// Returns the byte of any number; what is no number is 0.
  std::uint8_t of(double linear) const {
    if (!(linear > 0.0)) return 0;
    if (linear >= 1.0) return 255;
    const std::uint8_t low = code_at_[static_cast<std::size_t>(linear * steps)];
    return static_cast<std::uint8_t>(low + (linear >= begin_[low + std::size_t{1}] ? 1 : 0));
  }

 private:
  static constexpr std::size_t steps = 4096;  // the darkest codes are 1 / (255 * 12.92) wide
  std::array<double, 257> begin_{};
  std::array<std::uint8_t, steps> code_at_{};
};

}  // namespace

tl::unexpected<Error> bad_image(const std::string& file, std::string reason) {
  Error error{ErrorKind::bad_input, std::move(reason)};
  error.file = file;
  return fail(std::move(error));
}

float srgb_from_linear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

float linear_from_srgb(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

Rgb8Image display_image(const ColorImage& linear, double exposure) {
  static const SrgbCodes codes;
  constexpr std::size_t at_a_time = 16384;
  Rgb8Image out(linear.size);
  parallel_for(linear.data.size(), at_a_time, [&](std::size_t i) {
    const Vec3 color = exposure * Vec3(linear.data[i]);
    const bool has_nan = std::isnan(color.x) || std::isnan(color.y) || std::isnan(color.z);
    out.data[i] = has_nan ? glm::u8vec3(255, 0, 255)
                          : glm::u8vec3(codes.of(color.x), codes.of(color.y), codes.of(color.z));
  });
  return out;
}

Expected<TextureFile> read_texture_file(const std::string& path, bool srgb, const HeaderCheck& check) {
  const auto bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  if (lower_extension(path) != ".tga") return texture_from_bytes(path, *bytes, srgb, check);
  const auto library = image_library();
  if (!library) return fail(library.error());
  auto image = (*library)->read(path, max_image_side, DecodeAs::stored, check);
  if (!image) return fail(image.error());
  return texture_from(path, std::move(*image), srgb);
}

Expected<Texture> read_texture(const std::string& path, bool srgb, const HeaderCheck& check) {
  return texture_alone(read_texture_file(path, srgb, check));
}

Expected<Texture> read_texture_bytes(const std::string& name, std::string_view bytes, bool srgb,
                                     const HeaderCheck& check) {
  return texture_alone(texture_from_bytes(name, bytes, srgb, check));
}

Expected<void> write_png(const std::string& path, const Rgb8Image& image) {
  const auto bytes = encode_png(image);
  if (!bytes) return fail(bytes.error());
  return write_file(path, *bytes);
}

Expected<void> write_exr(const std::string& path, ImageSize size, std::span<const Channel> channels,
                         std::span<const std::pair<std::string, std::string>> attributes) {
  if (const auto sized = check_size(size); !sized) return fail(sized.error());
  for (const Channel& channel : channels)
    if (channel.values.size() != size.pixels())
      return fail(ErrorKind::internal, fmt::format("channel {} has {} values, not {}", channel.name,
                                                   channel.values.size(), size.pixels()));
  ExrEncoder encoder(size, channels, attributes);
  const std::string blocks = encoder.add(size.height, channels);
  return write_file(path, encoder.begin() + blocks);
}

const Channel* ChannelImage::find(std::string_view name) const {
  const auto found =
      std::find_if(channels.begin(), channels.end(), [&](const Channel& c) { return c.name == name; });
  return found == channels.end() ? nullptr : &*found;
}

Expected<ImageSize> read_image_size(const std::string& path) {
  const auto bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  if (format_of(*bytes) == "png") return png_size(path, *bytes);
  if (const auto size = exr_size(*bytes)) return *size;
  const auto library = image_library();
  if (!library) return fail(library.error());
  return (*library)->size(path, max_image_side);
}

Expected<ChannelImage> read_channels(const std::string& path) {
  const auto bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  if (auto exr = decode_exr(*bytes)) return std::move(*exr);
  const auto image = decode_floats(path, *bytes);
  if (!image) return fail(image.error());
  ChannelImage out{image->size, {}};
  const std::size_t count = image->channels.size();
  for (std::size_t c = 0; c < count; ++c) {
    Channel channel{image->channels[c], std::vector<float>(out.size.pixels())};
    for (std::size_t i = 0; i < channel.values.size(); ++i) channel.values[i] = image->floats[i * count + c];
    out.channels.push_back(std::move(channel));
  }
  return out;
}

}  // namespace gnomon
