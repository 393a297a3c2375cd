// OpenEXR files of 32-bit float channels, uncompressed in scan lines (openexr.com, "OpenEXR File Layout"): what of the image
// library a page needs, where results are written and textures are PNG or JPEG.
#include <algorithm>
#include <cstring>
#include <numeric>

#include "scene/files/pictures/image_library.h"
#include "scene/files/write_file.h"

namespace gnomon {
namespace {

tl::unexpected<Error> not_read(const std::string& path) {
  Error error{ErrorKind::bad_input, "images are PNG or JPEG here; all others are read on Linux alone"};
  error.file = path;
  return fail(std::move(error));
}

/// The bytes of a file, little-endian as the platform is.
class ExrText {
 public:
  template <class Number>
  void number(Number value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void text(std::string_view value) { bytes_.append(value).push_back('\0'); }
  void attribute(std::string_view name, std::string_view type, const ExrText& value) {
    text(name);
    text(type);
    number(static_cast<std::int32_t>(value.bytes_.size()));
    bytes_ += value.bytes_;
  }
  template <class... Numbers>
  static ExrText of(Numbers... values) {
    ExrText out;
    (out.number(values), ...);
    return out;
  }
  void raw(std::string_view value) { bytes_.append(value); }
  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
};

/// The order in which a file has the channels: that of their names.
std::vector<std::size_t> by_name(std::span<const std::string> channels) {
  std::vector<std::size_t> order(channels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) -> const std::string& { return channels[i]; });
  return order;
}

std::string header(ImageSize size, std::span<const std::string> channels,
                   std::span<const std::pair<std::string, std::string>> attributes) {
  ExrText list;
  for (const std::size_t i : by_name(channels)) {
    list.text(channels[i]);
    for (const std::int32_t field : {2, 0, 1, 1}) list.number(field);  // float, not linear, every pixel
  }
  list.number('\0');
  const ExrText window =
      ExrText::of(std::int32_t{0}, std::int32_t{0}, static_cast<std::int32_t>(size.width - 1),
                  static_cast<std::int32_t>(size.height - 1));
  ExrText out = ExrText::of(std::int32_t{20000630}, std::int32_t{2});
  out.attribute("channels", "chlist", list);
  out.attribute("compression", "compression", ExrText::of(char{0}));
  out.attribute("dataWindow", "box2i", window);
  out.attribute("displayWindow", "box2i", window);
  out.attribute("lineOrder", "lineOrder", ExrText::of(char{0}));
  out.attribute("pixelAspectRatio", "float", ExrText::of(1.0f));
  out.attribute("screenWindowCenter", "v2f", ExrText::of(0.0f, 0.0f));
  out.attribute("screenWindowWidth", "float", ExrText::of(1.0f));
  for (const auto& [name, value] : attributes) {
    ExrText words;
    words.raw(value);
    out.attribute(name, "string", words);
  }
  out.number('\0');
  return std::move(out.bytes());
}

/// All rows are kept until the file is closed: it is one in memory.
class PlainRows final : public ExrRows {
 public:
  PlainRows(std::string path, ImageSize size, std::span<const std::string> channels, std::string begin)
      : path_(std::move(path)), size_(size), order_(by_name(channels)), bytes_(std::move(begin)) {
    const std::size_t row = 8 + order_.size() * static_cast<std::size_t>(size.width) * sizeof(float);
    const std::size_t first = bytes_.size() + static_cast<std::size_t>(size.height) * 8;
    for (int y = 0; y < size.height; ++y) {
      const std::uint64_t offset = first + static_cast<std::size_t>(y) * row;
      bytes_.append(reinterpret_cast<const char*>(&offset), sizeof offset);
    }
  }
  Expected<void> write(const PictureRows& rows, std::span<const float> pixels) override {
    const auto width = static_cast<std::size_t>(size_.width);
    std::vector<float> line(order_.size() * width);
    for (int y = 0; y < rows.count; ++y) {
      const float* from = pixels.data() + static_cast<std::size_t>(y) * line.size();
      for (std::size_t c = 0; c < order_.size(); ++c)
        for (std::size_t x = 0; x < width; ++x) line[c * width + x] = from[x * order_.size() + order_[c]];
      const auto length = static_cast<std::int32_t>(line.size() * sizeof(float));
      for (const std::int32_t value : {rows.first + y, length})
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
      bytes_.append(reinterpret_cast<const char*>(line.data()), static_cast<std::size_t>(length));
    }
    return {};
  }
  Expected<void> close() override { return path_.empty() ? Expected<void>() : write_file(path_, bytes_); }
  std::string& bytes() { return bytes_; }

 private:
  std::string path_;
  ImageSize size_;
  std::vector<std::size_t> order_;
  std::string bytes_;
};

class PlainImages final : public ImageLibrary {
 public:
  Expected<ImageSize> size(const std::string& path, int) const override { return not_read(path); }
  Expected<DecodedImage> read(const std::string& path, int, DecodeAs) const override {
    return not_read(path);
  }
  Expected<DecodedImage> decode(const std::string& name, std::string_view, std::string_view,
                                int) const override {
    return not_read(name);
  }
  Expected<std::string> encode_exr(
      ImageSize size, std::span<const std::string> channels, std::span<const float> pixels,
      std::span<const std::pair<std::string, std::string>> attributes) const override {
    PlainRows rows("", size, channels, header(size, channels, attributes));
    if (const auto written = rows.write({0, size.height}, pixels); !written) return fail(written.error());
    return std::move(rows.bytes());
  }
  Expected<std::unique_ptr<ExrRows>> open_exr(
      const std::string& path, ImageSize size, std::span<const std::string> channels,
      std::span<const std::pair<std::string, std::string>> attributes) const override {
    return std::make_unique<PlainRows>(path, size, channels, header(size, channels, attributes));
  }
};

}  // namespace

Expected<const ImageLibrary*> image_library() {
  static const PlainImages images;
  return &images;
}

}  // namespace gnomon
