#include "report/pixels/packing.h"

#include <algorithm>

#include "scene/files/encodings.h"

namespace gnomon::compare {
namespace {

// Printable ASCII without the space and what JSON or HTML would escape.
std::string make_alphabet() {
  std::string out;
  for (char c = '!'; c <= '~'; ++c)
    if (c != '"' && c != '\\' && c != '<') out += c;
  return out;
}

// What is left of a number of `bytes` bytes, so that small ones of either sign are small.
template <int bytes>
std::uint32_t folded(std::uint32_t number) {
  constexpr int spare = 32 - 8 * bytes;
  const auto value = static_cast<std::int32_t>(number << spare) >> spare;
  return static_cast<std::uint32_t>(value) << 1 ^ static_cast<std::uint32_t>(value >> 31);
}

template <int bytes>
std::string planes(std::vector<std::uint32_t> numbers) {
  const std::size_t count = numbers.size();
  for (std::uint32_t& n : numbers) n = folded<bytes>(n);
  std::string out(count * bytes, '\0');
  for (int plane = 0; plane < bytes; ++plane) {
    char* to = out.data() + count * static_cast<std::size_t>(plane);
    for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<char>(numbers[i] >> (8 * plane));
  }
  return out;
}

std::string planes(std::vector<std::uint32_t> numbers, int bytes) {
  if (bytes == 1) return planes<1>(std::move(numbers));
  return bytes == 2 ? planes<2>(std::move(numbers)) : planes<4>(std::move(numbers));
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
  constexpr std::uint32_t none = ~0u;
  std::uint32_t most = 0;
  for (const std::uint32_t surface : surfaces)
    if (surface != none) most = std::max(most, surface);
  std::vector<std::uint32_t> last(std::size_t{most} + 2, none);  // the last entry: of what is no surface
  Sources from(surfaces.size());
  for (std::uint32_t i = 0; i < from.size(); ++i) {
    std::uint32_t& before = last[surfaces[i] == none ? std::size_t{most} + 1 : surfaces[i]];
    from[i] = before != none ? before : i > 0 ? i - 1 : 0;
    before = i;
  }
  return from;
}

std::string packed(std::vector<std::uint32_t> numbers, const PackOptions& options, const Sources* sources) {
  if (options.from == From::surface)
    for (std::size_t i = numbers.size(); i-- > 1;) numbers[i] -= numbers[(*sources)[i]];
  else if (options.from == From::previous)
    for (std::size_t i = numbers.size(); i-- > 1;) numbers[i] -= numbers[i - 1];
  return dense_text(deflate(planes(std::move(numbers), options.bytes), options.level));
}

}  // namespace gnomon::compare
