#include "scene/files/pictures/exr_encode.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "scene/base/parallel.h"
#include "scene/files/encodings.h"

namespace gnomon {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are stored as they are in memory");

constexpr int rows_of_block = 16;
constexpr std::size_t longest_short_name = 31;  // bytes; longer ones have a flag in the file's version
constexpr int exr_deflate_level = 4;            // as OpenEXR itself has it

/// Bytes of a file, one value behind the other.
class ExrText {
 public:
  template <class... Numbers>
  static ExrText of(Numbers... values) {
    ExrText out;
    (out.number(values), ...);
    return out;
  }
  template <class Number>
  void number(Number value) {
    raw({reinterpret_cast<const char*>(&value), sizeof value});
  }
  void text(std::string_view value) {
    raw(value);
    bytes_.push_back('\0');
  }
  void attribute(std::string_view name, std::string_view type, std::string_view value) {
    text(name);
    text(type);
    number(static_cast<std::int32_t>(value.size()));
    raw(value);
  }
  void raw(std::string_view value) { bytes_.append(value); }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// A file has its channels in the order of their names.
std::vector<std::size_t> by_name(std::span<const Channel> channels) {
  std::vector<std::size_t> order(channels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) -> const std::string& { return channels[i].name; });
  return order;
}

std::string channel_list(std::span<const Channel> channels, const std::vector<std::size_t>& order) {
  ExrText list;
  for (const std::size_t i : order) {
    list.text(channels[i].name);
    for (const std::int32_t field : {2, 0, 1, 1}) list.number(field);  // float, not linear, every pixel
  }
  list.number('\0');
  return list.bytes();
}

using Attributes = std::span<const std::pair<std::string, std::string>>;

bool has_long_name(std::span<const Channel> channels, Attributes attributes) {
  const auto is_long = [](const std::string& name) { return name.size() > longest_short_name; };
  return std::ranges::any_of(channels, is_long, &Channel::name) ||
         std::ranges::any_of(attributes, is_long,
                             [](const auto& item) -> const std::string& { return item.first; });
}

std::string header_of(ImageSize size, const std::string& channels, bool long_names, Attributes attributes) {
  const std::string window = ExrText::of(std::int32_t{0}, std::int32_t{0}, std::int32_t{size.width - 1},
                                         std::int32_t{size.height - 1})
                                 .bytes();
  constexpr std::int32_t magic = 20000630, version = 2, long_names_flag = 0x400;
  constexpr char zip = 3, increasing_y = 0;
  ExrText out = ExrText::of(magic, version | (long_names ? long_names_flag : 0));
  out.attribute("channels", "chlist", channels);
  out.attribute("compression", "compression", ExrText::of(zip).bytes());
  out.attribute("dataWindow", "box2i", window);
  out.attribute("displayWindow", "box2i", window);
  for (const auto& [name, value] : attributes) out.attribute(name, "string", value);
  out.attribute("lineOrder", "lineOrder", ExrText::of(increasing_y).bytes());
  out.attribute("pixelAspectRatio", "float", ExrText::of(1.0f).bytes());
  out.attribute("screenWindowCenter", "v2f", ExrText::of(0.0f, 0.0f).bytes());
  out.attribute("screenWindowWidth", "float", ExrText::of(1.0f).bytes());
  out.number('\0');
  return out.bytes();
}

/// What ZIP packs: the bytes of even places before those of odd ones. Each but the first is its difference from the one
/// before plus 128 (OpenEXR, "ZIP" of "OpenEXR File Layout"; ImfZip.cpp).
std::string prepared(std::string_view raw) {
  std::string bytes(raw.size(), '\0');
  const std::size_t half = (raw.size() + 1) / 2;
  for (std::size_t i = 0; i < half; ++i) bytes[i] = raw[2 * i];
  for (std::size_t i = half; i < raw.size(); ++i) bytes[i] = raw[2 * (i - half) + 1];
  for (std::size_t i = bytes.size() - 1; i > 0; --i)
    bytes[i] = static_cast<char>(bytes[i] - bytes[i - 1] + 128);
  return bytes;
}

}  // namespace

ExrEncoder::ExrEncoder(ImageSize size, std::span<const Channel> channels, Attributes attributes)
    : width_(size.width),
      order_(by_name(channels)),
      header_(
          header_of(size, channel_list(channels, order_), has_long_name(channels, attributes), attributes)),
      places_(static_cast<std::size_t>((size.height + rows_of_block - 1) / rows_of_block)),
      bytes_(header_.size() + places_.size() * sizeof(std::uint64_t)) {}

std::string ExrEncoder::begin() const {
  std::string out = header_;
  return out.append(reinterpret_cast<const char*>(places_.data()), places_.size() * sizeof(std::uint64_t));
}

std::string ExrEncoder::add(int rows, std::span<const Channel> channels) {
  std::vector<std::string> blocks(static_cast<std::size_t>((rows + rows_of_block - 1) / rows_of_block));
  const auto width = static_cast<std::size_t>(width_);
  parallel_tasks(blocks.size(), [&](std::size_t i) {
    const int first = static_cast<int>(i) * rows_of_block, last = std::min(first + rows_of_block, rows);
    std::string raw;
    raw.reserve(static_cast<std::size_t>(last - first) * width * channels.size() * sizeof(float));
    for (int y = first; y < last; ++y)
      for (const std::size_t c : order_)
        raw.append(
            reinterpret_cast<const char*>(channels[c].values.data() + static_cast<std::size_t>(y) * width),
            width * sizeof(float));
    const std::string packed = deflate(prepared(raw), exr_deflate_level);
    const std::string& kept =
        packed.size() < raw.size() ? packed : raw;  // what does not shrink is stored as it is
    ExrText block = ExrText::of(std::int32_t{row_ + first}, static_cast<std::int32_t>(kept.size()));
    block.raw(kept);
    blocks[i] = block.bytes();
  });
  std::string out;
  for (const std::string& block : blocks) {
    places_[blocks_++] = bytes_ + out.size();
    out += block;
  }
  row_ += rows;
  bytes_ += out.size();
  return out;
}

}  // namespace gnomon
