// OpenImageIO behind scene/files/pictures/image_library.h; built as a module that is loaded on first use. Nothing of
// the project is linked into it: what it shares with the program are types that headers define.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "scene/files/pictures/image_library.h"

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

// Alpha is kept as stored: OpenImageIO would otherwise multiply colours by it.
OIIO::ImageSpec read_hints() {
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  return hints;
}

Expected<void> check_header(const std::string& name, const OIIO::ImageInput* input, int max_side) {
  if (input == nullptr)
    return image_error(ErrorKind::bad_input, name,
                       fmt::format("cannot read the image: {}", library_error({})));
  const OIIO::ImageSpec& spec = input->spec();
  const bool sides_fit =
      spec.width > 0 && spec.height > 0 && spec.width <= max_side && spec.height <= max_side;
  if (!sides_fit || spec.depth > 1)
    return image_error(ErrorKind::bad_input, name,
                       fmt::format("image size (got {} x {}, allowed 1 x 1 to {} x {})", spec.width,
                                   spec.height, max_side, max_side));
  if (spec.nchannels < 1 || spec.nchannels > max_channels)
    return image_error(ErrorKind::bad_input, name,
                       fmt::format("channel count (got {}, allowed 1 to {})", spec.nchannels, max_channels));
  return {};
}

/// Films are no pictures: ffmpeg, which would read them, opens further files and addresses that they name.
Expected<void> check_no_film(const std::string& path) {
  const auto input = OIIO::ImageInput::create(path);
  if (input == nullptr || std::string_view(input->format_name()) != "FFmpeg movie") return {};
  return image_error(ErrorKind::bad_input, path, "a film is no picture; give one of its frames as PNG");
}

bool is_floating(const OIIO::TypeDesc& type) {
  return type.basetype == OIIO::TypeDesc::HALF || type.basetype == OIIO::TypeDesc::FLOAT ||
         type.basetype == OIIO::TypeDesc::DOUBLE;
}

Expected<void> check_budget(const std::string& name, const OIIO::ImageSpec& spec, bool floats,
                            std::uint64_t file_bytes) {
  const std::uint64_t bytes = std::uint64_t{spec.image_pixels()} *
                              static_cast<std::uint64_t>(spec.nchannels) * (floats ? sizeof(float) : 1);
  if (bytes <= image_budget(file_bytes)) return {};
  return image_error(ErrorKind::bad_input, name,
                     fmt::format("a file of {} bytes cannot hold so large a picture (got {} x {} with {} "
                                 "channels, {} MB; allowed {} MB)",
                                 file_bytes, spec.width, spec.height, spec.nchannels, bytes / 1000000,
                                 image_budget(file_bytes) / 1000000));
}

Expected<DecodedImage> pixels_of(const std::string& name, OIIO::ImageInput* input, int max_side, DecodeAs as,
                                 std::uint64_t file_bytes, const HeaderCheck& check) {
  if (const auto sound = check_header(name, input, max_side); !sound) return fail(sound.error());
  const bool floats = as == DecodeAs::floats || is_floating(input->spec().format);
  if (const auto fits = check_budget(name, input->spec(), floats, file_bytes); !fits)
    return fail(fits.error());
  const OIIO::ImageSpec spec = input->spec();
  const std::size_t pixel = static_cast<std::size_t>(spec.nchannels) * (floats ? sizeof(float) : 1);
  if (check)
    if (const auto fits = check({spec.width, spec.height}, pixel); !fits) return fail(fits.error());
  DecodedImage out{{spec.width, spec.height}, spec.channelnames, {}, {}};
  const std::size_t count = out.size.pixels() * static_cast<std::size_t>(spec.nchannels);
  bool done = false;
  if (floats) {
    out.floats.resize(count);
    done = input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, out.floats.data());
  } else {
    out.bytes.resize(count);
    done = input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeUInt8, out.bytes.data());
  }
  if (done) return out;
  return image_error(ErrorKind::bad_input, name,
                     fmt::format("cannot read the image: {}", library_error(input->geterror())));
}

class OpenImageIo final : public ImageLibrary {
 public:
  Expected<ImageSize> size(const std::string& path, int max_side) const override {
    if (const auto still = check_no_film(path); !still) return fail(still.error());
    const auto input = OIIO::ImageInput::open(path);
    if (const auto sound = check_header(path, input.get(), max_side); !sound) return fail(sound.error());
    return ImageSize{input->spec().width, input->spec().height};
  }

  Expected<DecodedImage> read(const std::string& path, int max_side, DecodeAs as,
                              const HeaderCheck& check) const override {
    const OIIO::ImageSpec hints = read_hints();
    if (const auto still = check_no_film(path); !still) return fail(still.error());
    const auto input = OIIO::ImageInput::open(path, &hints);
    return pixels_of(path, input.get(), max_side, as, OIIO::Filesystem::file_size(path), check);
  }

  Expected<DecodedImage> decode(const std::string& name, std::string_view bytes, std::string_view format,
                                int max_side, const HeaderCheck& check) const override {
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());  // outlives `input`
    const auto input = OIIO::ImageInput::create(std::string(format));
    const OIIO::ImageSpec hints = read_hints();
    OIIO::ImageSpec spec;
    if (input && input->set_ioproxy(&memory) && !input->open("memory." + std::string(format), spec, hints)) {
      const std::string reason = library_error(input->geterror());
      return image_error(ErrorKind::bad_input, name, fmt::format("cannot read the image: {}", reason));
    }
    return pixels_of(name, input.get(), max_side, DecodeAs::stored, bytes.size(), check);
  }
};

}  // namespace
}  // namespace gnomon

extern "C" __attribute__((visibility("default"))) const gnomon::ImageLibrary* gnomon_image_library(
    int threads) {
  OIIO::attribute("threads", std::max(1, threads));
  OIIO::attribute("exr_threads", threads > 0 ? threads : -1);  // -1: OpenEXR works on the calling thread
  static const gnomon::OpenImageIo library;
  return &library;
}
