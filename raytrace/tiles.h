// Images in 16 x 16 tiles over all threads. What a tile computes may depend on the tile alone, so results are
// the same for any number of threads.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <stop_token>

#include "scene/base/parallel.h"
#include "scene/image.h"

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

/// A tile's pixels by lanes: 16 packets of 4 x 4 pixels, so that they stay narrow both ways.
inline constexpr std::size_t packet_rays = 16, tile_packets = 16, tile_rays = packet_rays * tile_packets;

constexpr std::size_t tile_lane(int x, int y) {
  const int packet = (y >> 2) * 4 + (x >> 2), lane = (y & 3) * 4 + (x & 3);
  return static_cast<std::size_t>(packet) * packet_rays + static_cast<std::size_t>(lane);
}

/// The pixel of a place.
struct TilePixel {
  int x, y;
};
constexpr TilePixel tile_pixel(std::size_t lane) {
  const int packet = static_cast<int>(lane / packet_rays), i = static_cast<int>(lane % packet_rays);
  return {4 * (packet % 4) + i % 4, 4 * (packet / 4) + i / 4};
}

/// Bit i of a packet's number: ray i of it.
using LaneMask = std::array<std::uint16_t, tile_packets>;
inline constexpr LaneMask every_lane = [] {
  LaneMask all{};
  for (std::uint16_t& bits : all) bits = 0xffff;
  return all;
}();

/// A tile's rectangle of pixels: at most 16 x 16.
struct TileRect {
  int x0, y0, x1, y1;
  bool is_whole() const { return x1 - x0 == tile_pixels && y1 - y0 == tile_pixels; }
};

inline void add_lane(LaneMask& bits, std::size_t lane) {
  bits[lane / packet_rays] |= static_cast<std::uint16_t>(1u << (lane % packet_rays));
}
inline bool has_lane(const LaneMask& bits, std::size_t lane) {
  return (bits[lane / packet_rays] >> (lane % packet_rays) & 1u) != 0;
}

/// pixel(x, y, lane) for every pixel of the rectangle.
template <class Pixel>
void for_each_place(const TileRect& rect, const Pixel& pixel) {
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) pixel(x, y, tile_lane(x - rect.x0, y - rect.y0));
}

/// Calls `pixel` for the pixels whose bit is set.
template <class Pixel>
void for_each_place(const TileRect& rect, const LaneMask& bits, const Pixel& pixel) {
  for (std::size_t p = 0; p < tile_packets; ++p)
    for (unsigned left = bits[p]; left != 0; left &= left - 1) {
      const std::size_t lane = p * packet_rays + static_cast<std::size_t>(std::countr_zero(left));
      const TilePixel place = tile_pixel(lane);
      const int x = rect.x0 + place.x, y = rect.y0 + place.y;
      if (x < rect.x1 && y < rect.y1) pixel(x, y, lane);
    }
}

}  // namespace gnomon::raytrace
