#include "scene/files/image_check.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>

#include "scene/files/deflate.h"
#include "scene/files/image_io.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace {

constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char c : bytes.substr(0, 4)) value = value << 8 | static_cast<unsigned char>(c);
  return value;
}

// ISO 3309, as the PNG specification's annex D has it.
std::uint32_t crc(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> values{};
    for (std::uint32_t n = 0; n < 256; ++n) {
      std::uint32_t c = n;
      for (int bit = 0; bit < 8; ++bit) c = c & 1u ? 0xedb88320u ^ (c >> 1) : c >> 1;
      values[n] = c;
    }
    return values;
  }();
  std::uint32_t c = 0xffffffffu;
  for (const char byte : bytes) c = table[(c ^ static_cast<unsigned char>(byte)) & 0xffu] ^ (c >> 8);
  return ~c;
}

tl::unexpected<Error> damage(const std::string& name, std::string reason) {
  Error error{ErrorKind::bad_input, std::move(reason)};
  error.file = name;
  return fail(std::move(error));
}

// PNG specification, 11.2.2: sizes, and which depths go with which colour types.
Expected<void> check_header(std::string_view data, const std::string& name) {
  if (data.size() != 13) return damage(name, "the PNG header has a wrong length");
  const std::uint32_t width = big_endian(data);
  const std::uint32_t height = big_endian(data.substr(4));
  if (width < 1 || height < 1 || width > max_image_side || height > max_image_side)
    return damage(name, fmt::format("image size (got {} x {}, allowed 1 x 1 to {} x {})", width, height,
                                    max_image_side, max_image_side));
  const int depth = static_cast<unsigned char>(data[8]), type = static_cast<unsigned char>(data[9]);
  const bool small_depth = depth == 1 || depth == 2 || depth == 4;
  const bool fits = (depth == 8 && (type == 0 || type == 2 || type == 3 || type == 4 || type == 6)) ||
                    (depth == 16 && (type == 0 || type == 2 || type == 4 || type == 6)) ||
                    (small_depth && (type == 0 || type == 3));
  if (!fits || data[10] != 0 || data[11] != 0 || data[12] < 0 || data[12] > 1)
    return damage(name, "the PNG header is not valid");
  return {};
}

/// Bytes of all scan lines with their filter bytes (PNG specification, 9; interlaced: 8.2, Adam7).
std::size_t scanline_bytes(std::string_view header) {
  const std::size_t width = big_endian(header), height = big_endian(header.substr(4));
  const std::size_t depth = static_cast<unsigned char>(header[8]);
  constexpr std::array<std::size_t, 7> samples{1, 0, 3, 1, 2, 0, 4};  // by colour type
  const std::size_t bits = depth * samples[static_cast<unsigned char>(header[9])];
  const auto pass = [&](std::size_t w, std::size_t h) { return w == 0 ? 0 : h * (1 + (w * bits + 7) / 8); };
  if (header[12] == 0) return pass(width, height);
  struct Pass {
    std::size_t x, y, dx, dy;
  };
  constexpr std::array<Pass, 7> passes{
      {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4}, {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}}};
  std::size_t bytes = 0;
  for (const Pass& p : passes)
    bytes += pass((width + p.dx - 1 - p.x) / p.dx, (height + p.dy - 1 - p.y) / p.dy);
  return bytes;
}

// libpng would print a line of its own.
Expected<void> check_data(std::string_view header, std::string_view data, const std::string& name) {
  const std::size_t bytes = scanline_bytes(header);
  constexpr std::size_t most_per_byte = 1032;  // deflate's limit
  if (bytes / most_per_byte > data.size())
    return damage(name, fmt::format("the PNG file is cut off: {} bytes of data cannot hold {} x {} pixels",
                                    data.size(), big_endian(header), big_endian(header.substr(4))));
  if (inflates_to(data, bytes)) return {};
  return damage(name, "the PNG file is damaged: its data does not make up its picture");
}

}  // namespace

Expected<std::string> essential_png(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with(signature)) return damage(name, "not a PNG file");
  std::string out(signature), data;
  std::string_view header;
  for (std::size_t at = signature.size(); at < bytes.size();) {
    if (bytes.size() - at < 12) break;
    const std::uint32_t length = big_endian(bytes.substr(at));
    const std::string_view type = bytes.substr(at + 4, 4);
    if (length > bytes.size() - at - 12)
      return damage(name, fmt::format("the PNG file is cut off in its chunk {}", printable(type)));
    const std::string_view body = bytes.substr(at + 4, 4 + length);
    const bool first = at == signature.size();
    if (first != (type == "IHDR")) return damage(name, "the PNG file does not begin with its header");
    const bool essential = first || type == "PLTE" || type == "tRNS" || type == "IDAT" || type == "IEND";
    if (essential && crc(body) != big_endian(bytes.substr(at + 8 + length)))
      return damage(name, fmt::format("the PNG file is damaged in its chunk {}", printable(type)));
    if (first) {
      header = body.substr(4);
      if (const auto sound = check_header(header, name); !sound) return fail(sound.error());
    }
    if (essential) out += bytes.substr(at, length + 12);
    if (type == "IDAT") data += body.substr(4);
    if (type == "IEND" && !data.empty()) {
      if (const auto whole = check_data(header, data, name); !whole) return fail(whole.error());
      return out;
    }
    at += length + 12;
  }
  return damage(name, "the PNG file is cut off");
}

// ISO/IEC 10918-1, annex B: segments with lengths up to the first scan; after it, 0xff 0xd9 is the end and
// nothing else.
Expected<void> check_jpeg_is_whole(std::string_view bytes, const std::string& name) {
  constexpr unsigned char start_of_scan = 0xda;
  for (std::size_t at = 2; at + 4 <= bytes.size();) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[at + i]); };
    if (byte(0) != 0xff) return damage(name, "the JPEG file is damaged before its picture");
    if (byte(1) == start_of_scan) {
      if (bytes.find("\xff\xd9", at) != std::string_view::npos) return {};
      break;
    }
    const bool is_fill = byte(1) == 0xff;
    at += is_fill ? 1u : 2u + (static_cast<std::size_t>(byte(2)) << 8 | byte(3));
  }
  return damage(name, "the JPEG file is cut off");
}

}  // namespace gnomon
