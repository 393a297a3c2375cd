#include "scene/files/base64.h"

#include <algorithm>
#include <cstdint>

namespace gnomon {

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto byte = [&bytes](std::size_t i) { return std::uint32_t{static_cast<unsigned char>(bytes[i])}; };
  std::string out((bytes.size() + 2) / 3 * 4, '=');
  const auto put = [&](std::size_t o, std::uint32_t group) {
    out[o] = digits[group >> 18];
    out[o + 1] = digits[group >> 12 & 63u];
    out[o + 2] = digits[group >> 6 & 63u];
    out[o + 3] = digits[group & 63u];
  };
  std::size_t i = 0, o = 0;
  for (; i + 3 <= bytes.size(); i += 3, o += 4) put(o, byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2));
  const std::size_t rest = bytes.size() - i;
  if (rest == 0) return out;
  put(o, byte(i) << 16 | (rest == 2 ? byte(i + 1) << 8 : 0u));
  std::fill(out.end() - static_cast<std::ptrdiff_t>(3 - rest), out.end(), '=');
  return out;
}

}  // namespace gnomon
