// The first of many things that is so, looked for on every thread.
#pragma once

#include <algorithm>
#include <cstddef>

#include "scene/parallel.h"

namespace gnomon {

/// The least i below `count` for which is(i); `count` where there is none.
template <class Is>
std::size_t first_where(std::size_t count, const Is& is) {
  constexpr std::size_t at_a_time = 8192;
  return parallel_reduce(
      count, at_a_time, count,
      [&](std::size_t first, std::size_t last, std::size_t none) {
        for (std::size_t i = first; i < last; ++i)
          if (is(i)) return i;
        return none;
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
}

}  // namespace gnomon
