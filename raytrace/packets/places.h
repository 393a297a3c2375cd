// Loops over the pixels of a tile.
#pragma once

#include <bit>

#include "raytrace/packets/passes.h"

namespace gnomon::raytrace {

/// pixel(x, y, lane) for every pixel of the rectangle.
template <class Pixel>
void for_each_place(const TileRect& rect, const Pixel& pixel) {
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) pixel(x, y, tile_lane(x - rect.x0, y - rect.y0));
}

/// The same for those whose bit is set.
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

inline bool is_whole(const TileRect& rect) {
  return rect.x1 - rect.x0 == 16 && rect.y1 - rect.y0 == 16;
}

inline std::uint16_t bit_of(std::size_t lane) {
  return static_cast<std::uint16_t>(1u << (lane % packet_rays));
}

}  // namespace gnomon::raytrace
