// The first of many things that is so, looked for on every thread.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cstddef>

namespace gnomon {

/// The least i below `count` for which is(i); `count` where there is none.
template <class Is>
std::size_t first_where(std::size_t count, const Is& is) {
  constexpr std::size_t at_a_time = 8192;
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count, at_a_time), count,
      [&](const auto& range, std::size_t first) {
        for (std::size_t i = range.begin(); i < range.end() && i < first; ++i)
          if (is(i)) return i;
        return first;
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
}

}  // namespace gnomon
