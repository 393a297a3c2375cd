#include "judge/stored_format.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace gnomon::judge {
namespace {

/// The whole numbers that 1 is in formats of that many bits. Two bytes of which the first is the whole part make the products.
struct WholeNumbers {
  double most;
  int bits;
};
constexpr WholeNumbers usual_formats[] = {
    {255, 8},      {256, 8},     {1023, 10},          {1024, 10},
    {4095, 12},    {4096, 12},   {255.0 * 255.0, 16}, {255.0 * 256.0, 16},
    {65535.0, 16}, {65536.0, 16}};
/// So many different numbers have to agree. Depths of level floors are often sums of a few_numbers powers of two.
constexpr std::size_t few_numbers = 6, few_of_binary = 32;

bool is_power_of_two(double most) {
  return std::exp2(std::round(std::log2(most))) == most;
}

bool are_whole_numbers(const std::vector<float>& values, double most) {
  return std::all_of(values.begin(), values.end(), [most](float v) {
    const double scaled = most * double{v};
    return std::abs(scaled - std::round(scaled)) < 0x1p-20 * most;
  });
}

/// Returns the step between 1/2 and 1 of floats that have no bits below those that all values have.
double step_of_bits(const std::vector<float>& values) {
  int zeros = 23;
  for (const float v : values)
    if (v != 0.0f) zeros = std::min(zeros, std::countr_zero(std::bit_cast<std::uint32_t>(v)));
  return std::exp2(zeros - 24);
}

}  // namespace

StoredFormat find_format(std::vector<float> numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  if (numbers.size() < few_numbers) return {};
  // Half floats above 2^-6 are multiples of 1/65536 as well, but those of 16 bits have longer significands.
  const bool are_half_floats = step_of_bits(numbers) >= 0x1p-11;
  const auto may_be = [&](double most) {
    return !is_power_of_two(most) ||
           (numbers.size() >= few_of_binary && (most <= 2048.0 || !are_half_floats));
  };
  for (const auto& [most, bits] : usual_formats)
    if (may_be(most) && are_whole_numbers(numbers, most)) return {1.0 / most, false};
  return numbers.size() < few_of_binary ? StoredFormat{} : StoredFormat{step_of_bits(numbers), true};
}

double step_near(const StoredFormat& format, double number) {
  if (!format.floating) return format.step;
  return std::ldexp(format.step, std::ilogb(std::max(number, 0x1p-126)) + 1);
}

std::vector<std::string> format_notes(const StoredFormat& format, double unit_world) {
  constexpr double half_floats = 0x1p-11;
  if (!format.floating) {
    const double most = std::round(1.0 / format.step);
    const auto* found = std::find_if(std::begin(usual_formats), std::end(usual_formats),
                                     [most](const WholeNumbers& f) { return f.most == most; });
    const std::string steps =
        unit_world > 0.0 ? fmt::format(", steps of {:.2g} world units", format.step * unit_world) : "";
    return {fmt::format("the map's depths are multiples of 1/{:.0f}: {} bits{}", most,
                        found->bits == 8 ? "eight" : std::to_string(found->bits), steps)};
  }
  if (format.step < half_floats) return {};
  return {fmt::format("the map's depths are {}",
                      format.step == half_floats
                          ? std::string("half floats: eleven bits")
                          : fmt::format("floats of {:.0f} bits", -std::log2(format.step)))};
}

}  // namespace gnomon::judge
