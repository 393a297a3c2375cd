// A picture in blocks of up to 4 x 4 tiles, which are worked on together.
#pragma once

#include <algorithm>
#include <stop_token>

#include "raytrace/tiles.h"
#include "scene/base/parallel.h"

namespace gnomon::raytrace {

inline constexpr int block_tiles = 4, block_pixels = tile_pixels * block_tiles;

/// A block's rectangle of pixels begins at a multiple of 64 and holds at most 64 x 64.
struct BlockRect {
  int x0, y0, x1, y1;
};

/// tile(its index in the block, its rectangle) for every tile of a block.
template <class Tile>
void for_each_tile_of(const BlockRect& block, const Tile& tile) {
  for (int y = block.y0; y < block.y1; y += tile_pixels)
    for (int x = block.x0; x < block.x1; x += tile_pixels) {
      const int index = (y - block.y0) / tile_pixels * block_tiles + (x - block.x0) / tile_pixels;
      tile(static_cast<std::size_t>(index),
           TileRect{x, y, std::min(x + tile_pixels, block.x1), std::min(y + tile_pixels, block.y1)});
    }
}

/// block(rectangle) for every block of the picture, over all threads. Once a stop is requested none is begun.
template <class Block>
void for_each_block(ImageSize size, const std::stop_token& stop, const Block& block) {
  const int columns = (size.width + block_pixels - 1) / block_pixels;
  const int rows = (size.height + block_pixels - 1) / block_pixels;
  parallel_for(columns * rows, [&](int i) {
    if (stop.stop_requested()) return;
    const int x = i % columns * block_pixels, y = i / columns * block_pixels;
    block(BlockRect{x, y, std::min(x + block_pixels, size.width), std::min(y + block_pixels, size.height)});
  });
}

/// The tile's place in its picture's TileGrid.
inline std::size_t tile_at(ImageSize size, const TileRect& rect) {
  return static_cast<std::size_t>(rect.y0 / tile_pixels) * TileGrid{size}.columns() +
         static_cast<std::size_t>(rect.x0 / tile_pixels);
}

}  // namespace gnomon::raytrace
