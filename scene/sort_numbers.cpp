#include "scene/sort_numbers.h"

#include <hwy/contrib/sort/vqsort.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

namespace gnomon {
namespace {

constexpr std::uint32_t sign = 0x80000000u;

/// Floats in the order of whole numbers.
std::uint32_t key_of(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return (bits & sign) != 0 ? ~bits : bits | sign;
}
float value_of(std::uint32_t key) {
  return std::bit_cast<float>((key & sign) != 0 ? key & ~sign : ~key);
}

/// Knuth, "The Art of Computer Programming" vol. 3, section 5.2.5, algorithm R: by the lowest digit first, each time
/// keeping the order of equal digits.
class RadixSort {
 public:
  /// `values` are the other half of the memory that it takes.
  explicit RadixSort(std::span<float> values) : values_(values), keys_(values.size()) {
    for (const float value : values)
      for (std::size_t k = 0; k < digits; ++k) ++next_[k][digit(key_of(value), k)];
    for (Places& places : next_) {
      std::size_t before = 0;
      for (std::size_t& place : places) before += std::exchange(place, before);
    }
  }

  void run() {
    for (const float value : values_) put(0, key_of(value), keys_.data());
    for (const std::uint32_t key : keys_) put(1, std::bit_cast<float>(key), values_.data());
    for (const float value : values_) put(2, std::bit_cast<std::uint32_t>(value), keys_.data());
    std::transform(keys_.begin(), keys_.end(), values_.begin(), value_of);
  }

 private:
  static constexpr std::size_t bits = 11, digits = 3;
  using Places = std::array<std::size_t, std::size_t{1} << bits>;

  static std::size_t digit(std::uint32_t key, std::size_t k) { return key >> bits * k & ((1u << bits) - 1); }
  template <class T>
  void put(std::size_t k, T key, T* to) {
    to[next_[k][digit(std::bit_cast<std::uint32_t>(key), k)]++] = key;
  }

  std::span<float> values_;
  std::vector<std::uint32_t> keys_;
  std::array<Places, digits> next_{};  ///< where the next number with that digit goes
};

}  // namespace

void sort_numbers(std::span<float> values) {
  constexpr std::size_t few = 4096;  // digits' places take longer to count than so many to compare
  const auto end = std::partition(values.begin(), values.end(), [](float v) { return !std::isnan(v); });
  const std::span<float> numbers(values.begin(), end);
  if (numbers.size() < few)
    std::sort(numbers.begin(), numbers.end(), [](float a, float b) { return key_of(a) < key_of(b); });
  else
    RadixSort(numbers).run();
}

void sort_numbers(std::span<std::uint64_t> values) {
  const hwy::Sorter sort;
  sort(values.data(), values.size(), hwy::SortAscending());
}

}  // namespace gnomon
