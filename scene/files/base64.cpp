#include "scene/files/base64.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace gnomon {
namespace {

constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<std::uint8_t, 256> make_values() {
  std::array<std::uint8_t, 256> values{};
  values.fill(64);
  for (std::uint8_t i = 0; i < 64; ++i) values[static_cast<unsigned char>(digits[i])] = i;
  return values;
}

}  // namespace

std::string base64(std::string_view bytes) {
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

std::optional<std::vector<char>> from_base64(std::string_view text) {
  static constexpr std::array<std::uint8_t, 256> values = make_values();
  for (int i = 0; i < 2 && text.ends_with('='); ++i) text.remove_suffix(1);
  std::vector<char> out;
  out.reserve(text.size() * 3 / 4);
  std::uint32_t bits = 0;
  int held = 0;
  for (const char letter : text) {
    const std::uint8_t value = values[static_cast<unsigned char>(letter)];
    if (value == 64) return std::nullopt;
    bits = bits << 6 | value, held += 6;
    if (held < 8) continue;
    held -= 8;
    out.push_back(static_cast<char>(bits >> held & 0xffu));
  }
  return out;
}

}  // namespace gnomon
