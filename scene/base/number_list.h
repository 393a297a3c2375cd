// A short list of numbers that is part of an options struct: a size, a place, the ends of some slices.
#pragma once

#include <array>
#include <cstddef>

namespace gnomon {

/// Holds up to six numbers; an empty list stands for "not given".
struct NumberList {
  std::array<double, 6> values{};
  int count = 0;

  constexpr bool empty() const { return count == 0; }
  double operator[](int i) const { return values[static_cast<std::size_t>(i)]; }
  /// Does nothing where the list is full.
  void push_back(double value) {
    if (static_cast<std::size_t>(count) < values.size()) values[static_cast<std::size_t>(count++)] = value;
  }
  const double* begin() const { return values.data(); }
  const double* end() const { return values.data() + count; }
  bool operator==(const NumberList&) const = default;
};

}  // namespace gnomon
