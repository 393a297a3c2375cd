// Images in 16 x 16 tiles over all threads. What a tile computes may depend on the tile alone, so results are
// the same for any number of threads.
#pragma once

#include <stop_token>

#include "scene/image.h"
#include "scene/parallel.h"

namespace gnomon::raytrace {

inline constexpr int tile_pixels = 16;

struct TileGrid {
  ImageSize size;
  std::stop_token stop{};  ///< once requested, no further tile is begun
  std::size_t columns() const {
    return static_cast<std::size_t>((size.width + tile_pixels - 1) / tile_pixels);
  }
  std::size_t rows() const { return static_cast<std::size_t>((size.height + tile_pixels - 1) / tile_pixels); }
  std::size_t count() const { return columns() * rows(); }
};

/// tile(tile index, x0, y0, x1, y1) for every tile.
template <class Tile>
void for_each_tile(const TileGrid& grid, const Tile& tile) {
  parallel_for(grid.count(), [&](std::size_t i) {
    if (grid.stop.stop_requested()) return;
    const int x0 = static_cast<int>(i % grid.columns()) * tile_pixels;
    const int y0 = static_cast<int>(i / grid.columns()) * tile_pixels;
    tile(i, x0, y0, std::min(x0 + tile_pixels, grid.size.width),
         std::min(y0 + tile_pixels, grid.size.height));
  });
}

/// pixel(x, y, tile index) for every pixel.
template <class Pixel>
void for_each_pixel(const TileGrid& grid, const Pixel& pixel) {
  for_each_tile(grid, [&](std::size_t tile, int x0, int y0, int x1, int y1) {
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) pixel(x, y, tile);
  });
}

}  // namespace gnomon::raytrace
