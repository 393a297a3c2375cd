// Where two pictures differ: a filter that reaches so far has nothing to do anywhere else.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "scene/base/parallel.h"
#include "scene/image.h"

namespace gnomon::compare {

/// Columns [first, end) of a picture.
struct ColumnRange {
  int first = 0, end = 0;
};

/// Knows of each row and each block of so many columns whether two pictures differ there.
class Differing {
 public:
  static constexpr int block = 16;  ///< pixels

  /// a(index), b(index): the pixels of two pictures of that size.
  template <class A, class B>
  Differing(const ImageSize& size, const A& a, const B& b)
      : width_(size.width),
        height_(size.height),
        blocks_((size.width + block - 1) / block),
        differs_(static_cast<std::size_t>(blocks_) * static_cast<std::size_t>(height_)) {
    parallel_for(height_, [&](int y) {
      const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
      for (int x = 0; x < width_; ++x) {
        const std::size_t i = row + static_cast<std::size_t>(x);
        differs_[index(y, x / block)] |= static_cast<std::uint8_t>(!(a(i) == b(i)));
      }
    });
  }

  /// Calls columns(range) for each run of columns, from left to right, of which some pixel of the rows [first, end) differs
  /// within `left` columns before it and `right` behind it. Rows and columns beyond the picture count as none.
  template <class Columns>
  void for_each_range(int first, int end, int left, int right, const Columns& columns) const {
    first = std::max(first, 0), end = std::min(end, height_);
    ColumnRange run;
    for (int b = 0; b < blocks_; ++b) {
      bool any = false;
      for (int y = first; y < end && !any; ++y) any = differs_[index(y, b)] != 0;
      if (!any) continue;
      const ColumnRange reached{std::max(0, b * block - right), std::min(width_, (b + 1) * block + left)};
      if (run.end > 0 && reached.first > run.end) columns(run), run = reached;
      if (run.end == 0) run = reached;
      run.end = reached.end;
    }
    if (run.end > 0) columns(run);
  }

 private:
  std::size_t index(int y, int b) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(blocks_) + static_cast<std::size_t>(b);
  }

  int width_, height_, blocks_;
  std::vector<std::uint8_t> differs_;
};

}  // namespace gnomon::compare
