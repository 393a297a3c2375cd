#include "compare/report/packing.h"

#include <unordered_map>

#include "scene/files/deflate.h"

namespace gnomon::compare {
namespace {

// Printable ASCII without the space and what JSON or HTML would escape.
std::string make_alphabet() {
  std::string out;
  for (char c = '!'; c <= '~'; ++c)
    if (c != '"' && c != '\\' && c != '<') out += c;
  return out;
}

std::uint32_t folded(std::uint32_t number, int bytes) {
  const int spare = 32 - 8 * bytes;
  const auto value = static_cast<std::int32_t>(number << spare) >> spare;
  return static_cast<std::uint32_t>(value) << 1 ^ static_cast<std::uint32_t>(value >> 31);
}

std::string planes(const std::vector<std::uint32_t>& numbers, int bytes) {
  std::string out(numbers.size() * static_cast<std::size_t>(bytes), '\0');
  std::size_t o = 0;
  for (int plane = 0; plane < bytes; ++plane)
    for (const std::uint32_t n : numbers) out[o++] = static_cast<char>(n >> (8 * plane) & 0xffu);
  return out;
}

}  // namespace

std::string dense_text(std::string_view bytes) {
  static const std::string alphabet = make_alphabet();
  constexpr std::uint32_t base = 91;
  std::string out;
  out.reserve(bytes.size() * 16 / 13 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char byte : bytes) {
    bits |= std::uint32_t{static_cast<unsigned char>(byte)} << count;
    if ((count += 8) < 13) continue;
    out += alphabet[(bits & 0x1fffu) / base];
    out += alphabet[(bits & 0x1fffu) % base];
    bits >>= 13;
    count -= 13;
  }
  if (count > 6) out += alphabet[bits / base];
  if (count > 0) out += alphabet[bits % base];
  return out;
}

Sources surface_sources(const std::vector<std::uint32_t>& surfaces) {
  std::unordered_map<std::uint32_t, std::uint32_t> last;
  Sources from(surfaces.size());
  for (std::uint32_t i = 0; i < from.size(); ++i) {
    const auto [entry, is_new] = last.try_emplace(surfaces[i], i);
    from[i] = !is_new ? entry->second : i > 0 ? i - 1 : 0;
    entry->second = i;
  }
  return from;
}

std::string packed(std::vector<std::uint32_t> numbers, const PackOptions& options, const Sources* sources) {
  for (std::size_t i = numbers.size(); i-- > 0;) {
    const bool predicted = options.from != From::nothing && i > 0;
    const std::size_t from = options.from == From::surface ? (*sources)[i] : i - 1;
    numbers[i] = folded(numbers[i] - (predicted ? numbers[from] : 0u), options.bytes);
  }
  return dense_text(deflate(planes(numbers, options.bytes), options.level));
}

}  // namespace gnomon::compare
