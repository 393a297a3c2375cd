// The places in an image that something holds of, in ascending order, looked for by all threads.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "scene/base/parallel.h"

namespace gnomon::compare {

template <class Predicate>
std::vector<std::uint32_t> pixels_where(std::size_t count, const Predicate& holds) {
  constexpr std::size_t block = 1 << 14;  // pixels per task
  const std::size_t blocks = (count + block - 1) / block;
  const auto each_of = [&](std::size_t b, const auto& act) {
    for (std::size_t i = b * block; i < std::min(count, (b + 1) * block); ++i)
      if (holds(i)) act(static_cast<std::uint32_t>(i));
  };
  std::vector<std::size_t> before(blocks + 1, 0);
  parallel_for(blocks, [&](std::size_t b) { each_of(b, [&](std::uint32_t) { ++before[b + 1]; }); });
  std::partial_sum(before.begin(), before.end(), before.begin());
  std::vector<std::uint32_t> pixels(before.back());
  parallel_for(blocks, [&](std::size_t b) {
    std::size_t next = before[b];
    each_of(b, [&](std::uint32_t i) { pixels[next++] = i; });
  });
  return pixels;
}

}  // namespace gnomon::compare
