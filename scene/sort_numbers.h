// Long lists of plain numbers in ascending order, by Highway's vectorised quicksort (Blacher, Giesen, Kühne 2022,
// "Vectorized and performance-portable Quicksort"): one thread is there before two are with std::sort. Floats are sorted
// as whole numbers of 64 bits. As they are, Highway 1.0.3 fails on infinities, and of 32 bits it takes eight times as
// long on a Zen 4, whose compressing stores are slow; vectors of 64 bits it divides by permutations.
#pragma once

#include <cstdint>
#include <span>

namespace gnomon {

/// Ascending; NaNs, in any order, behind all numbers.
void sort_numbers(std::span<float> values);
void sort_numbers(std::span<std::uint64_t> values);

}  // namespace gnomon
