#include "scene/files/pictures/exr_decode.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "scene/base/parallel.h"
#include "scene/files/encodings.h"
#include "scene/files/pictures/image_library.h"

namespace gnomon {
namespace {

constexpr std::int32_t magic = 20000630, version = 2, long_names_flag = 0x400;

/// Bytes from the front on; past their end all numbers are 0, and `cut_off` tells so.
class ExrBytes {
 public:
  explicit ExrBytes(std::string_view bytes) : left_(bytes) {}

  std::string_view take(std::size_t count) {
    cut_off = cut_off || count > left_.size();
    const std::string_view taken = left_.substr(0, cut_off ? 0 : count);
    left_.remove_prefix(taken.size());
    return taken;
  }
  template <class Number>
  Number number() {
    Number value{};
    const std::string_view bytes = take(sizeof value);
    if (!bytes.empty()) std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  /// Up to the 0 that ends it.
  std::string_view text() {
    const std::string_view word = take(std::min(left_.find('\0'), left_.size()));
    take(1);
    return word;
  }

  bool cut_off = false;

 private:
  std::string_view left_;
};

struct ExrChannel {
  std::string name;
  std::size_t bytes = 0;  ///< of a value: of a half or a float
};

struct ExrHeader {
  ImageSize size;
  int first_row = 0;
  std::vector<ExrChannel> channels;
  int compression = -1;
  std::size_t length = 0;  ///< of the file up to the places of its blocks, bytes

  int rows_of_block() const { return compression == 3 ? 16 : 1; }
  std::size_t row_bytes() const {
    std::size_t sum = 0;
    for (const ExrChannel& channel : channels) sum += channel.bytes * static_cast<std::size_t>(size.width);
    return sum;
  }
};

/// None where a value is neither half nor float, or not every pixel has one.
std::optional<std::vector<ExrChannel>> channels_of(std::string_view list) {
  std::vector<ExrChannel> channels;
  ExrBytes bytes(list);
  for (std::string_view name = bytes.text(); !name.empty(); name = bytes.text()) {
    const auto type = bytes.number<std::int32_t>();
    bytes.number<std::int32_t>();  // how it is seen
    const bool every_pixel = bytes.number<std::int32_t>() == 1 && bytes.number<std::int32_t>() == 1;
    if (bytes.cut_off || !every_pixel || (type != 1 && type != 2)) return std::nullopt;
    channels.push_back({std::string(name), type == 1 ? std::size_t{2} : std::size_t{4}});
  }
  return channels;
}

/// Reads the window's size. None where a side is not in 1 ... max_image_side.
bool take_window(ExrBytes window, ExrHeader& header) {
  const std::int64_t x0 = window.number<std::int32_t>(), y0 = window.number<std::int32_t>();
  const std::int64_t width = window.number<std::int32_t>() - x0 + 1,
                     height = window.number<std::int32_t>() - y0 + 1;
  if (width < 1 || height < 1 || width > max_image_side || height > max_image_side) return false;
  header.size = {static_cast<int>(width), static_cast<int>(height)};
  header.first_row = static_cast<int>(y0);
  return !window.cut_off;
}

std::optional<ExrHeader> header_of(std::string_view file) {
  ExrBytes bytes(file);
  ExrHeader out;
  out.length = 9;  // with the 0 behind the last attribute
  if (bytes.number<std::int32_t>() != magic) return std::nullopt;
  if ((bytes.number<std::int32_t>() & ~long_names_flag) != version)
    return std::nullopt;  // tiled, deep, several parts
  for (std::string_view name = bytes.text(); !name.empty(); name = bytes.text()) {
    const std::string_view type = bytes.text();
    const auto length = bytes.number<std::int32_t>();
    const std::string_view value =
        bytes.take(length < 0 ? file.size() + 1 : static_cast<std::size_t>(length));
    if (bytes.cut_off) return std::nullopt;
    out.length += name.size() + type.size() + value.size() + 6;
    if (name == "channels") {
      auto channels = channels_of(value);
      if (!channels) return std::nullopt;
      out.channels = std::move(*channels);
    } else if (name == "compression" && value.size() == 1) {
      out.compression = static_cast<unsigned char>(value.front());
    } else if (name == "dataWindow" && !take_window(ExrBytes(value), out)) {
      return std::nullopt;
    }
  }
  const bool known = out.compression == 0 || out.compression == 2 || out.compression == 3;
  if (bytes.cut_off || !known || out.channels.empty() || out.size.width == 0) return std::nullopt;
  return out;
}

/// Undoes what ZIP does before it packs (exr_encode.cpp).
std::string restored(std::string bytes) {
  for (std::size_t i = 1; i < bytes.size(); ++i) bytes[i] = static_cast<char>(bytes[i] + bytes[i - 1] - 128);
  std::string raw(bytes.size(), '\0');
  const std::size_t half = (raw.size() + 1) / 2;
  for (std::size_t i = 0; i < half; ++i) raw[2 * i] = bytes[i];
  for (std::size_t i = half; i < raw.size(); ++i) raw[2 * (i - half) + 1] = bytes[i];
  return raw;
}

float value_at(const char* bytes, std::size_t size) {
  if (size == 2) {
    std::uint16_t half = 0;
    std::memcpy(&half, bytes, sizeof half);
    return glm::unpackHalf1x16(half);
  }
  float value = 0.0f;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// The row that the block lying there begins with, from the picture's first on.
std::int64_t row_of_block(ExrBytes block, const ExrHeader& header) {
  return std::int64_t{block.number<std::int32_t>()} - header.first_row;
}

/// Reads the block that lies there into its rows, the first of which is `row`. Returns whether it is whole.
bool take_block(ExrBytes block, const ExrHeader& header, std::int64_t row, ChannelImage& out) {
  block.number<std::int32_t>();  // its row
  const auto length = block.number<std::int32_t>();
  if (length < 0) return false;
  const auto rows =
      static_cast<std::size_t>(std::min<std::int64_t>(header.rows_of_block(), header.size.height - row));
  const std::string_view stored = block.take(static_cast<std::size_t>(length));
  const std::size_t whole = rows * header.row_bytes();
  if (block.cut_off || stored.size() > whole) return false;
  std::string raw(stored);
  if (stored.size() < whole) {
    raw.assign(whole, '\0');
    if (header.compression == 0 || !inflate(stored, raw)) return false;
    raw = restored(std::move(raw));
  }
  const auto width = static_cast<std::size_t>(header.size.width);
  const char* at = raw.data();
  for (std::size_t y = static_cast<std::size_t>(row); y < static_cast<std::size_t>(row) + rows; ++y)
    for (std::size_t c = 0; c < header.channels.size(); ++c)
      for (std::size_t x = 0; x < width; ++x, at += header.channels[c].bytes)
        out.channels[c].values[y * width + x] = value_at(at, header.channels[c].bytes);
  return true;
}

}  // namespace

std::optional<ImageSize> exr_size(std::string_view bytes) {
  const auto header = header_of(bytes);
  return header ? std::optional(header->size) : std::nullopt;
}

namespace {

/// Colours as pictures have them, and all else behind, as the file has it.
void order_colours(std::vector<Channel>& channels) {
  constexpr std::string_view order = "RGBA";
  std::ranges::stable_sort(channels, {}, [&](const Channel& channel) {
    return channel.name.size() == 1 ? std::min(order.find(channel.name), order.size()) : order.size();
  });
}

}  // namespace

std::optional<ChannelImage> decode_exr(std::string_view bytes) {
  const auto header = header_of(bytes);
  if (!header) return std::nullopt;
  const std::size_t values = header->size.pixels() * header->channels.size();
  if (values * sizeof(float) > image_budget(bytes.size())) return std::nullopt;
  ChannelImage out{header->size, {}};
  for (const ExrChannel& channel : header->channels)
    out.channels.push_back({channel.name, std::vector<float>(header->size.pixels())});
  const int step = header->rows_of_block();
  const auto count = static_cast<std::size_t>((header->size.height + step - 1) / step);
  ExrBytes places(bytes.substr(header->length));
  std::vector<std::uint64_t> begins;
  for (std::size_t i = 0; i < count && !places.cut_off; ++i) begins.push_back(places.number<std::uint64_t>());
  if (places.cut_off || std::ranges::any_of(begins, [&](std::uint64_t at) { return at >= bytes.size(); }))
    return std::nullopt;
  std::ranges::sort(begins, {},
                    [&](std::uint64_t at) { return row_of_block(ExrBytes(bytes.substr(at)), *header); });
  for (std::size_t i = 0; i < count; ++i)  // each block once, wherever it lies
    if (row_of_block(ExrBytes(bytes.substr(begins[i])), *header) != static_cast<std::int64_t>(i) * step)
      return std::nullopt;
  std::atomic<bool> whole = true;
  parallel_tasks(count, [&](std::size_t i) {
    const std::int64_t row = static_cast<std::int64_t>(i) * step;
    if (!take_block(ExrBytes(bytes.substr(begins[i])), *header, row, out)) whole = false;
  });
  if (!whole) return std::nullopt;
  order_colours(out.channels);
  return out;
}

}  // namespace gnomon
