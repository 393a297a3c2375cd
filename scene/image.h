// Images as plain data. Row 0 is the top row; row-major; linear values unless a type says otherwise.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/math.h"

namespace gnomon {

struct ImageSize {
  int width = 0;
  int height = 0;
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  bool operator==(const ImageSize&) const = default;
};

template <class Pixel>
struct Image {
  ImageSize size;
  std::vector<Pixel> data;

  Image() = default;
  explicit Image(ImageSize s, const Pixel& fill = Pixel{}) : size(s), data(s.pixels(), fill) {}
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
  }
  Pixel& at(int x, int y) { return data[index(x, y)]; }
  const Pixel& at(int x, int y) const { return data[index(x, y)]; }
};

using ColorImage = Image<Vec3f>;                     ///< linear RGB
using Rgb8Image = Image<glm::u8vec3>;                ///< sRGB-encoded, for files and screens
inline constexpr std::uint32_t no_id = 0xffffffffu;  ///< no primitive, no object, no texture

// Some of a picture's rows: large pictures are worked through in bands of them.

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
