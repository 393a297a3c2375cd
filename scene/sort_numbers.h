// Long lists of plain numbers in ascending order, by Highway's vectorised quicksort (Blacher, Giesen, Kühne
// 2022, "Vectorized and performance-portable Quicksort"): one thread is there before two are with std::sort.
#pragma once

#include <cstdint>
#include <span>

namespace gnomon {

/// Ascending; NaNs, in any order, behind all numbers.
void sort_numbers(std::span<float> values);
void sort_numbers(std::span<std::uint64_t> values);

}  // namespace gnomon
