// Some of a picture's rows: large pictures are worked through in bands of them.
#pragma once

#include <algorithm>
#include <vector>

#include "scene/image.h"

namespace gnomon {

struct PictureRows {
  int first = 0, count = 0;
  int end() const { return first + count; }
  bool operator==(const PictureRows&) const = default;
};

/// Bands begin at multiples of this, which is the side of the ray tracer's blocks.
inline constexpr int band_step = 64;

/// A picture from top to bottom in bands of so many rows, the last of what is left. `rows`: a multiple of
/// band_step, or at least the picture's height.
inline std::vector<PictureRows> bands_of(const ImageSize& size, int rows) {
  std::vector<PictureRows> bands;
  for (int first = 0; first < size.height; first += rows)
    bands.push_back({first, std::min(rows, size.height - first)});
  return bands;
}

}  // namespace gnomon
