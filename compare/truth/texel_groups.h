// The pixels of one light sorted by the texel they look up, so that what belongs to a texel (its centre ray,
// its sheets) is worked out once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raster/frame.h"
#include "raytrace/sheets/sheets.h"

namespace gnomon::compare {

/// Pixel indices grouped by texel; groups ascend by key, pixels ascend inside a group.
struct TexelGroups {
  std::vector<raytrace::TexelKey> keys;
  std::vector<std::uint32_t> offsets;  ///< keys.size() + 1, into pixels
  std::vector<std::uint32_t> pixels;
  std::span<const std::uint32_t> operator[](std::size_t group) const {
    return {pixels.data() + offsets[group], pixels.data() + offsets[group + 1]};
  }
};

/// The texel that a pixel's receiver looked up (before any offset), or none when that lies outside the map.
bool texel_of_pixel(const raster::LightRecord& record, std::size_t pixel, raytrace::TexelKey& key);

/// Groups the given pixels, ascending and below 2^28. Those that look outside the map go into `outside`.
TexelGroups group_by_texel(const raster::LightRecord& record, std::span<const std::uint32_t> pixels,
                           std::vector<std::uint32_t>& outside);

}  // namespace gnomon::compare
