#include "scene/base/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace gnomon {
namespace {

constexpr std::uint32_t sign = 0x80000000u;

/// Floats in the order of whole numbers.
std::uint32_t key_of(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return (bits & sign) != 0 ? ~bits : bits | sign;
}
float value_of(std::uint64_t key) {
  const auto bits = static_cast<std::uint32_t>(key);
  return std::bit_cast<float>((bits & sign) != 0 ? bits & ~sign : ~bits);
}

}  // namespace

void sort_numbers(std::span<float> values) {
  const auto end = std::partition(values.begin(), values.end(), [](float v) { return !std::isnan(v); });
  std::vector<std::uint64_t> keys(static_cast<std::size_t>(end - values.begin()));
  std::transform(values.begin(), end, keys.begin(), key_of);
  sort_numbers(std::span(keys));
  std::transform(keys.begin(), keys.end(), values.begin(), value_of);
}

}  // namespace gnomon
