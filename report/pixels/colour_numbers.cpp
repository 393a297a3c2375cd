// A picture has some millions of numbers: the logarithm of a mantissa is looked up by its first bits.
#include "report/pixels/colour_numbers.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "scene/base/parallel.h"

namespace gnomon::compare {
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

}  // namespace gnomon::compare
