#include "report/pixels/packing.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "scene/base/parallel.h"
#include "scene/files/encodings.h"

namespace gnomon::report {
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
  if (options.unit != 1)
    for (std::uint32_t& n : numbers) n = n == 0 ? 0 : n == options.unit ? 1 : ~0u;
  constexpr int level = 4;  // 6 takes two thirds more time and leaves a thirtieth less
  return dense_text(deflate(planes(std::move(numbers), options.bytes), level));
}

// A picture has some millions of numbers: the logarithm of a mantissa is looked up by its first bits.

namespace {

constexpr int mantissa_bits = 23, table_bits = 12, exponent_bias = 127;

using Steps = std::array<std::uint8_t, std::size_t{1} << table_bits>;

// Of the middle of each mantissa that begins with the same bits.
const Steps& steps_of_mantissas() {
  static const Steps steps = [] {
    Steps table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
      const double mantissa = 1.0 + (static_cast<double>(i) + 0.5) / static_cast<double>(table.size());
      table[i] = static_cast<std::uint8_t>(std::lround(colour_steps * std::log2(mantissa)));
    }
    return table;
  }();
  return steps;
}

std::uint16_t number_of(float value, const Steps& steps) {
  if (!(value > 0.0f)) return 0;
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const int octave = static_cast<int>(bits >> mantissa_bits) - exponent_bias;
  const std::size_t mantissa = bits >> (mantissa_bits - table_bits) & (steps.size() - 1);
  const int number = colour_steps * (octave - darkest_octave) + steps[mantissa];
  return static_cast<std::uint16_t>(
      1 + std::clamp(number, 0, colour_steps * (brightest_octave - darkest_octave)));
}

}  // namespace

std::uint16_t colour_number(float value) {
  return number_of(value, steps_of_mantissas());
}

std::array<std::vector<std::uint16_t>, 3> colour_numbers(const ColorImage& image) {
  const Steps& steps = steps_of_mantissas();
  std::array<std::vector<std::uint16_t>, 3> numbers;
  for (auto& channel : numbers) channel.resize(image.data.size());
  parallel_for(image.data.size(), [&](std::size_t i) {
    for (int k = 0; k < 3; ++k) numbers[static_cast<std::size_t>(k)][i] = number_of(image.data[i][k], steps);
  });
  return numbers;
}

}  // namespace gnomon::report
