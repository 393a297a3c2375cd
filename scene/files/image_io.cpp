#include "scene/files/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "scene/files/image_check.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"

namespace gnomon {
namespace {

constexpr int max_channels = 1024;

tl::unexpected<Error> image_error(ErrorKind kind, const std::string& file, std::string reason) {
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  Error error{kind, std::move(reason)};
  error.file = file;
  return fail(std::move(error));
}

// Fetching the global error as well keeps OpenImageIO from printing it when the process ends.
std::string library_error(const std::string& own) {
  const std::string global = OIIO::geterror();
  if (!own.empty()) return own;
  return global.empty() ? "no reason given" : global;
}

struct OpenImage {
  std::string bytes;                                      // what `memory` reads, where it is not the caller's
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;  // outlives `input`
  std::unique_ptr<OIIO::ImageInput> input;
};

// Alpha is kept as stored: OpenImageIO would otherwise multiply colours by it.
OIIO::ImageSpec read_hints() {
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  return hints;
}

Expected<OpenImage> check_header(const std::string& name, OpenImage image) {
  if (!image.input)
    return image_error(ErrorKind::bad_input, name,
                       fmt::format("cannot read the image: {}", library_error({})));
  const OIIO::ImageSpec& spec = image.input->spec();
  const bool sides_fit =
      spec.width > 0 && spec.height > 0 && spec.width <= max_image_side && spec.height <= max_image_side;
  if (!sides_fit || spec.depth > 1)
    return image_error(ErrorKind::bad_input, name,
                       fmt::format("image size (got {} x {}, allowed 1 x 1 to {} x {})", spec.width,
                                   spec.height, max_image_side, max_image_side));
  if (spec.nchannels < 1 || spec.nchannels > max_channels)
    return image_error(ErrorKind::bad_input, name,
                       fmt::format("channel count (got {}, allowed 1 to {})", spec.nchannels, max_channels));
  return image;
}

Expected<OpenImage> open_path(const std::string& path) {
  const OIIO::ImageSpec hints = read_hints();
  OpenImage image;
  image.input = OIIO::ImageInput::open(path, &hints);
  return check_header(path, std::move(image));
}

// The reader is chosen by the bytes, never by the name (which may be a mesh's, with no extension).
std::string_view format_of(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG")) return "png";
  if (bytes.starts_with("\xff\xd8\xff")) return "jpeg";
  if (bytes.starts_with("RIFF") && bytes.substr(8, 4) == "WEBP") return "webp";
  if (bytes.starts_with("BM")) return "bmp";
  if (bytes.starts_with("v/1\x01")) return "openexr";
  if (bytes.starts_with("#?RADIANCE")) return "hdr";
  if (bytes.starts_with("GIF8")) return "gif";
  return "";
}

Expected<OpenImage> open_bytes(const std::string& name, std::string_view bytes) {
  const std::string_view format = format_of(bytes);
  if (format.empty())
    return image_error(ErrorKind::bad_input, name,
                       "image in a format that is not known (allowed PNG, JPEG, WebP, BMP, "
                       "EXR, HDR, GIF, TGA)");
  OpenImage image;
  if (format == "png") {
    auto essential = essential_png(bytes, name);
    if (!essential) return fail(essential.error());
    image.bytes = std::move(*essential);
    bytes = image.bytes;
  }
  if (format == "jpeg")
    if (const auto whole = check_jpeg_is_whole(bytes, name); !whole) return fail(whole.error());
  image.memory = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes.data(), bytes.size());
  image.input = OIIO::ImageInput::create(std::string(format));
  OIIO::ImageSpec hints = read_hints();
  OIIO::ImageSpec spec;
  if (image.input && image.input->set_ioproxy(image.memory.get()) &&
      !image.input->open("memory." + std::string(format), spec, hints)) {
    const std::string reason = library_error(image.input->geterror());
    return image_error(ErrorKind::bad_input, name, fmt::format("cannot read the image: {}", reason));
  }
  return check_header(name, std::move(image));
}

bool is_floating(const OIIO::TypeDesc& type) {
  return type.basetype == OIIO::TypeDesc::HALF || type.basetype == OIIO::TypeDesc::FLOAT ||
         type.basetype == OIIO::TypeDesc::DOUBLE;
}

template <class Value>
Expected<std::vector<Value>> read_pixels(const std::string& name, OIIO::ImageInput& input,
                                         OIIO::TypeDesc type) {
  const OIIO::ImageSpec& spec = input.spec();
  std::vector<Value> values(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                            static_cast<std::size_t>(spec.nchannels));
  if (!input.read_image(0, 0, 0, spec.nchannels, type, values.data()))
    return image_error(ErrorKind::bad_input, name,
                       fmt::format("cannot read the image: {}", library_error(input.geterror())));
  return values;
}

std::uint8_t to_8_bit(float value) {
  return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

Expected<std::vector<std::uint8_t>> floats_as_bytes(const std::string& name, OIIO::ImageInput& input,
                                                    bool srgb) {
  const auto floats = read_pixels<float>(name, input, OIIO::TypeFloat);
  if (!floats) return fail(floats.error());
  const auto bad = std::count_if(floats->begin(), floats->end(), [](float v) { return !std::isfinite(v); });
  if (bad > 0)
    return image_error(ErrorKind::bad_input, name, fmt::format("{} values are not finite numbers", bad));
  const int channels = input.spec().nchannels;
  std::vector<std::uint8_t> bytes(floats->size());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const int channel = static_cast<int>(i % static_cast<std::size_t>(channels));
    const bool is_alpha = channel == 3 || (channels == 2 && channel == 1);
    const float value = (*floats)[i];
    bytes[i] = to_8_bit(srgb && !is_alpha ? srgb_from_linear(std::clamp(value, 0.0f, 1.0f)) : value);
  }
  return bytes;
}

// 1 channel is grey, 2 grey and alpha, 3 RGB, 4 RGBA; more are not looked at.
glm::u8vec4 rgba(const std::uint8_t* value, int channels) {
  if (channels == 1) return {value[0], value[0], value[0], 255};
  if (channels == 2) return {value[0], value[0], value[0], value[1]};
  return {value[0], value[1], value[2], channels == 3 ? std::uint8_t{255} : value[3]};
}

Expected<Texture> texture_from(const std::string& name, OpenImage image, bool srgb) {
  const OIIO::ImageSpec spec = image.input->spec();
  const auto bytes = is_floating(spec.format)
                         ? floats_as_bytes(name, *image.input, srgb)
                         : read_pixels<std::uint8_t>(name, *image.input, OIIO::TypeUInt8);
  if (!bytes) return fail(bytes.error());
  Texture texture;
  texture.name = name;
  texture.size = {spec.width, spec.height};
  texture.srgb = srgb;
  texture.texels.reserve(texture.size.pixels());
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  for (std::size_t i = 0; i < texture.size.pixels(); ++i)
    texture.texels.push_back(rgba(bytes->data() + i * channels, spec.nchannels));
  return texture;
}

// The encoded file in memory, so that write_file can make it appear whole.
Expected<std::string> encode(const std::string& format, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                             const void* pixels) {
  const auto output = OIIO::ImageOutput::create(format);
  if (!output || !output->supports("ioproxy"))
    return fail(ErrorKind::internal,
                fmt::format("OpenImageIO cannot encode {} in memory: {}", format, library_error({})));
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const bool done = output->set_ioproxy(&memory) && output->open("memory." + format, spec) &&
                    output->write_image(type, pixels) && output->close();
  if (!done)
    return fail(ErrorKind::cannot_write,
                fmt::format("cannot encode the image: {}", library_error(output->geterror())));
  return std::string(bytes.begin(), bytes.end());
}

Expected<void> check_size(ImageSize size) {
  if (size.width > 0 && size.height > 0) return {};
  return fail(ErrorKind::internal,
              fmt::format("cannot encode an image of {} x {} pixels", size.width, size.height));
}

// Encoding by search: code k begins where the decoding of (k - 1/2) / 255 lies.
std::uint8_t encode_srgb8(double linear) {
  static const std::array<double, 255> first_of_code = [] {
    std::array<double, 255> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double encoded = (static_cast<double>(i) + 0.5) / 255.0;
      values[i] = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
    }
    return values;
  }();
  const auto above = std::upper_bound(first_of_code.begin(), first_of_code.end(), linear);
  return static_cast<std::uint8_t>(above - first_of_code.begin());
}

}  // namespace

float srgb_from_linear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

float linear_from_srgb(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

Rgb8Image display_image(const ColorImage& linear, double exposure) {
  Rgb8Image out(linear.size);
  for (std::size_t i = 0; i < linear.data.size(); ++i) {
    const Vec3 color = exposure * Vec3(linear.data[i]);
    const bool has_nan = std::isnan(color.x) || std::isnan(color.y) || std::isnan(color.z);
    out.data[i] = has_nan ? glm::u8vec3(255, 0, 255)
                          : glm::u8vec3(encode_srgb8(color.x), encode_srgb8(color.y), encode_srgb8(color.z));
  }
  return out;
}

Expected<Texture> read_texture(const std::string& path, bool srgb) {
  const auto bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  if (lower_extension(path) != ".tga") return read_texture_bytes(path, *bytes, srgb);
  auto image = open_path(path);
  if (!image) return fail(image.error());
  return texture_from(path, std::move(*image), srgb);
}

Expected<Texture> read_texture_bytes(const std::string& name, std::string_view bytes, bool srgb) {
  auto image = open_bytes(name, bytes);
  if (!image) return fail(image.error());
  return texture_from(name, std::move(*image), srgb);
}

Expected<std::string> encode_png(const Rgb8Image& image) {
  if (const auto sized = check_size(image.size); !sized) return fail(sized.error());
  OIIO::ImageSpec spec(image.size.width, image.size.height, 3, OIIO::TypeUInt8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  return encode("png", spec, OIIO::TypeUInt8, image.data.data());
}

Expected<void> write_png(const std::string& path, const Rgb8Image& image) {
  const auto bytes = encode_png(image);
  if (!bytes) return fail(bytes.error());
  return write_file(path, *bytes);
}

Expected<void> write_exr(const std::string& path, ImageSize size, std::span<const Channel> channels,
                         std::span<const std::pair<std::string, std::string>> attributes) {
  if (const auto sized = check_size(size); !sized) return fail(sized.error());
  const std::size_t count = channels.size();
  OIIO::ImageSpec spec(size.width, size.height, static_cast<int>(count), OIIO::TypeFloat);
  spec.channelnames.clear();
  spec.alpha_channel = -1;
  std::vector<float> pixels(size.pixels() * count);
  for (std::size_t c = 0; c < count; ++c) {
    if (channels[c].values.size() != size.pixels())
      return fail(ErrorKind::internal, fmt::format("channel {} has {} values, not {}", channels[c].name,
                                                   channels[c].values.size(), size.pixels()));
    spec.channelnames.push_back(channels[c].name);
    for (std::size_t i = 0; i < size.pixels(); ++i) pixels[i * count + c] = channels[c].values[i];
  }
  spec.attribute("compression", "zip");
  for (const auto& [key, value] : attributes) spec.attribute(key, value);
  const auto bytes = encode("openexr", spec, OIIO::TypeFloat, pixels.data());
  if (!bytes) return fail(bytes.error());
  return write_file(path, *bytes);
}

const Channel* ChannelImage::find(std::string_view name) const {
  const auto found =
      std::find_if(channels.begin(), channels.end(), [&](const Channel& c) { return c.name == name; });
  return found == channels.end() ? nullptr : &*found;
}

Expected<ChannelImage> read_channels(const std::string& path) {
  auto image = open_path(path);
  if (!image) return fail(image.error());
  const OIIO::ImageSpec spec = image->input->spec();
  const auto pixels = read_pixels<float>(path, *image->input, OIIO::TypeFloat);
  if (!pixels) return fail(pixels.error());
  ChannelImage out{{spec.width, spec.height}, {}};
  const auto count = static_cast<std::size_t>(spec.nchannels);
  for (std::size_t c = 0; c < count; ++c) {
    Channel channel{spec.channelnames[c], std::vector<float>(out.size.pixels())};
    for (std::size_t i = 0; i < channel.values.size(); ++i) channel.values[i] = (*pixels)[i * count + c];
    out.channels.push_back(std::move(channel));
  }
  return out;
}

}  // namespace gnomon
