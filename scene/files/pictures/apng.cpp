#include "scene/files/pictures/apng.h"

#include <libdeflate.h>

#include <algorithm>
#include <cmath>

#include "scene/files/encodings.h"

namespace gnomon {
namespace {

constexpr int deflate_level = 6;

std::string big_endian(std::uint32_t value, int bytes) {
  std::string out;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xffu);
  return out;
}

void append_chunk(std::string& file, std::string_view type, std::string_view data) {
  std::string body(type);
  body += data;
  file += big_endian(static_cast<std::uint32_t>(data.size()), 4) + body;
  file += big_endian(libdeflate_crc32(0, body.data(), body.size()), 4);
}

/// Chunk fcTL: the whole picture, left as it is after it was shown, the first over nothing, others over the frame before.
std::string frame_control(std::uint32_t sequence, const ImageSize& size, unsigned milliseconds, bool first) {
  return big_endian(sequence, 4) + big_endian(static_cast<std::uint32_t>(size.width), 4) +
         big_endian(static_cast<std::uint32_t>(size.height), 4) + std::string(8, '\0') +
         big_endian(milliseconds, 2) + big_endian(1000, 2) + std::string(1, '\0') +
         std::string(1, first ? '\0' : '\1');
}

}  // namespace

AnimatedPng::AnimatedPng(ImageSize size, double fps)
    : size_(size), milliseconds_(static_cast<unsigned>(std::clamp(std::round(1000.0 / fps), 1.0, 65535.0))) {}

void AnimatedPng::add(const Rgb8Image& picture) {
  const bool first = frames_.empty();
  const auto width = static_cast<std::size_t>(size_.width), row = 4 * width + 1;
  std::string rows(row * static_cast<std::size_t>(size_.height), '\0');  // filter 0: none
  for (std::size_t i = 0; i < picture.data.size(); ++i) {
    const glm::u8vec3& c = picture.data[i];
    if (!first && c == last_.data[i]) continue;  // transparent
    char* at = &rows[i / width * row + 1 + 4 * (i % width)];
    at[0] = static_cast<char>(c.r), at[1] = static_cast<char>(c.g), at[2] = static_cast<char>(c.b);
    at[3] = static_cast<char>(0xff);
  }
  frames_.push_back(deflate(rows, deflate_level));
  last_ = picture;
}

Expected<std::string> AnimatedPng::file() const {
  if (frames_.empty()) return fail(ErrorKind::internal, "cannot encode a film without frames");
  std::string out = "\x89PNG\r\n\x1a\n";
  const char header[] = {8, 6, 0, 0, 0};  // bits, RGBA, and the only methods there are
  append_chunk(out, "IHDR",
               big_endian(static_cast<std::uint32_t>(size_.width), 4) +
                   big_endian(static_cast<std::uint32_t>(size_.height), 4) + std::string(header, 5));
  append_chunk(out, "sRGB", std::string(1, '\0'));
  append_chunk(out, "acTL", big_endian(static_cast<std::uint32_t>(frames_.size()), 4) + big_endian(0, 4));
  std::uint32_t sequence = 0;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    append_chunk(out, "fcTL", frame_control(sequence++, size_, milliseconds_, i == 0));
    if (i == 0)
      append_chunk(out, "IDAT", frames_[i]);
    else
      append_chunk(out, "fdAT", big_endian(sequence++, 4) + frames_[i]);
  }
  append_chunk(out, "IEND", {});
  return out;
}

}  // namespace gnomon
