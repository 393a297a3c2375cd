// Long lists of plain numbers in ascending order. Whole ones by Highway's vectorised quicksort (Blacher, Giesen, Kühne 2022,
// "Vectorized and performance-portable Quicksort"): one thread is there before two are with std::sort. Floats digit by
// digit: that quicksort (1.0.3) fails on infinities, and of 32 bits takes eight times as long on a Zen 4, whose
// compressing stores are slow.
#pragma once

#include <cstdint>
#include <span>

namespace gnomon {

/// Ascending; NaNs, in any order, behind all numbers.
void sort_numbers(std::span<float> values);
void sort_numbers(std::span<std::uint64_t> values);

}  // namespace gnomon
