// OpenImageIO behind scene/files/pictures/image_library.h; built as a module that is loaded on first use. Nothing of
// the project is linked into it: what it shares with the program are types that headers define.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>

#include "scene/files/pictures/image_library.h"

namespace gnomon {
namespace {

constexpr int max_channels = 1024;
constexpr std::size_t longest_begin = std::size_t{1} << 20;  // of an EXR's header and table, bytes

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
                                 std::uint64_t file_bytes) {
  if (const auto sound = check_header(name, input, max_side); !sound) return fail(sound.error());
  const bool floats = as == DecodeAs::floats || is_floating(input->spec().format);
  if (const auto fits = check_budget(name, input->spec(), floats, file_bytes); !fits)
    return fail(fits.error());
  const OIIO::ImageSpec spec = input->spec();
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

OIIO::ImageSpec exr_spec(ImageSize size, std::span<const std::string> channels,
                         std::span<const std::pair<std::string, std::string>> attributes) {
  OIIO::ImageSpec spec(size.width, size.height, static_cast<int>(channels.size()), OIIO::TypeFloat);
  spec.channelnames.assign(channels.begin(), channels.end());
  spec.alpha_channel = -1;
  spec.attribute("compression", "zip");
  // No date of now: an attribute of another type is not written at all, of which OpenImageIO would tell.
  spec.attribute("DateTime", 0);
  OIIO::attribute("debug", 0);
  for (const auto& [key, value] : attributes) spec.attribute(key, value);
  return spec;
}

tl::unexpected<Error> rows_are_missing(const std::string& path) {
  return image_error(ErrorKind::graphics, path, "out of memory: rows of the picture could not be compressed");
}

/// OpenImageIO has words alone for what the system refused.
tl::unexpected<Error> not_written(const std::string& path, std::string_view step, const std::string& why) {
  constexpr std::array resources{EMFILE, ENFILE, ENOMEM};
  const bool resource = std::ranges::any_of(
      resources, [&](int number) { return why.find(std::strerror(number)) != std::string::npos; });
  return image_error(resource ? ErrorKind::graphics : ErrorKind::cannot_write, path,
                     fmt::format("{}: {}", step, why));
}

/// Numbers as OpenEXR stores them, little-endian, with a place that goes on; past the end they are 0.
class ExrBytes {
 public:
  explicit ExrBytes(std::string_view bytes) : bytes_(bytes) {}

  std::uint64_t number(std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i)
      if (at_ + i < bytes_.size())
        value |= std::uint64_t{static_cast<unsigned char>(bytes_[at_ + i])} << (8 * i);
    at_ += size;
    return value;
  }
  std::string_view word() {
    const std::size_t begin = std::min(at_, bytes_.size()),
                      end = std::min(bytes_.find('\0', begin), bytes_.size());
    at_ = end + 1;
    return bytes_.substr(begin, end - begin);
  }
  void skip(std::size_t size) { at_ += size; }
  bool is_over() const { return at_ >= bytes_.size(); }
  std::size_t place() const { return at_; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

/// Whether every block of rows of a scanline file was written (OpenEXR File Layout, "Offset Tables"). OpenEXR compresses blocks
/// on threads of its own, leaves out those for which memory was missing, and says nothing of it. `begin` is the file from its
/// start, as long as its header and table at least.
bool has_all_blocks(std::string_view begin) {
  constexpr std::size_t magic_and_version = 8;
  ExrBytes bytes(begin);
  bytes.skip(magic_and_version);
  while (!bytes.is_over() && !bytes.word().empty()) {
    bytes.word();  // the attribute's type
    bytes.skip(bytes.number(4));
  }
  const std::size_t table = bytes.place();
  std::uint64_t first = 0;
  std::size_t blocks = 0;
  do {  // the table ends where the first block begins
    const std::uint64_t place = bytes.number(8);
    if (place == 0) return false;
    if (blocks == 0) first = place;
    ++blocks;
  } while (table + 8 * blocks < first);
  return true;
}

class OpenExrRows final : public ExrRows {
 public:
  OpenExrRows(std::string path, std::unique_ptr<OIIO::ImageOutput> output)
      : path_(std::move(path)), output_(std::move(output)) {}

  Expected<void> write(const PictureRows& rows, std::span<const float> pixels) override {
    return checked(output_->write_scanlines(rows.first, rows.end(), 0, OIIO::TypeFloat, pixels.data()));
  }
  Expected<void> close() override {
    if (const auto closed = checked(output_->close()); !closed) return closed;
    std::ifstream file(path_, std::ios::binary);
    std::string begin(longest_begin, '\0');
    file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    if (file.bad() || file.gcount() <= 0)
      return not_written(path_, "cannot write",
                         fmt::format("what was written cannot be read back: {}", std::strerror(errno)));
    begin.resize(static_cast<std::size_t>(file.gcount()));
    return has_all_blocks(begin) ? Expected<void>() : rows_are_missing(path_);
  }

 private:
  Expected<void> checked(bool done) const {
    if (done) return {};
    return not_written(path_, "cannot write", library_error(output_->geterror()));
  }
  std::string path_;
  std::unique_ptr<OIIO::ImageOutput> output_;
};

class OpenImageIo final : public ImageLibrary {
 public:
  Expected<ImageSize> size(const std::string& path, int max_side) const override {
    const auto input = OIIO::ImageInput::open(path);
    if (const auto sound = check_header(path, input.get(), max_side); !sound) return fail(sound.error());
    return ImageSize{input->spec().width, input->spec().height};
  }

  Expected<DecodedImage> read(const std::string& path, int max_side, DecodeAs as) const override {
    const OIIO::ImageSpec hints = read_hints();
    const auto input = OIIO::ImageInput::open(path, &hints);
    return pixels_of(path, input.get(), max_side, as, OIIO::Filesystem::file_size(path));
  }

  Expected<DecodedImage> decode(const std::string& name, std::string_view bytes, std::string_view format,
                                int max_side) const override {
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());  // outlives `input`
    const auto input = OIIO::ImageInput::create(std::string(format));
    const OIIO::ImageSpec hints = read_hints();
    OIIO::ImageSpec spec;
    if (input && input->set_ioproxy(&memory) && !input->open("memory." + std::string(format), spec, hints)) {
      const std::string reason = library_error(input->geterror());
      return image_error(ErrorKind::bad_input, name, fmt::format("cannot read the image: {}", reason));
    }
    return pixels_of(name, input.get(), max_side, DecodeAs::stored, bytes.size());
  }

  Expected<std::string> encode_exr(
      ImageSize size, std::span<const std::string> channels, std::span<const float> pixels,
      std::span<const std::pair<std::string, std::string>> attributes) const override {
    const OIIO::ImageSpec spec = exr_spec(size, channels, attributes);
    const auto output = OIIO::ImageOutput::create("openexr");
    if (!output || !output->supports("ioproxy"))
      return fail(ErrorKind::internal,
                  fmt::format("OpenImageIO cannot encode openexr in memory: {}", library_error({})));
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const bool done = output->set_ioproxy(&memory) && output->open("memory.openexr", spec) &&
                      output->write_image(OIIO::TypeFloat, pixels.data()) && output->close();
    if (!done)
      return fail(ErrorKind::cannot_write,
                  fmt::format("cannot encode the image: {}", library_error(output->geterror())));
    std::string file(bytes.begin(), bytes.end());
    if (!has_all_blocks(file)) return rows_are_missing({});
    return file;
  }

  Expected<std::unique_ptr<ExrRows>> open_exr(
      const std::string& path, ImageSize size, std::span<const std::string> channels,
      std::span<const std::pair<std::string, std::string>> attributes) const override {
    auto output = OIIO::ImageOutput::create("openexr");
    if (output && output->open(path, exr_spec(size, channels, attributes)))
      return std::make_unique<OpenExrRows>(path, std::move(output));
    return not_written(path, "cannot write it", library_error(output ? output->geterror() : ""));
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
