// The rays of 16 x 16 pixels at once, as 16 packets of 16 (4 x 4 pixels each). They meet the world as seen
// from their common origin or along their common direction. The answers are certain or withheld: whoever asks
// sends the withheld rays to the double kernels.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "raytrace/packets/edge_setup.h"
#include "raytrace/tiles.h"

namespace gnomon::raytrace {

/// Shadow rays.
struct alignas(64) TileRays {
  float u[tile_rays], v[tile_rays];
  float far[tile_rays];             ///< the receiver's reciprocal depth
  std::uint32_t source[tile_rays];  ///< the primitive that the ray leaves
  LaneMask alive;                   ///< bit i: ray i of the packet is asked for
};

/// A ray's nearest hit is a leaf position, first_plane and the place in Structures::planes, or one of the first two of these.
inline constexpr std::uint32_t nothing_hit = 0xffffffffu, ambiguous_hit = 0xfffffffeu,
                               first_plane = 0x80000000u;

struct alignas(64) TileHits {
  std::uint32_t leaf[tile_rays];
};

/// What a ray neither surely intersects nor surely misses.
struct AmbiguousHit {
  std::uint32_t leaf;
  std::uint32_t lane;
};

/// Bits per packet; neither: surely lit. Both never.
struct TileShadows {
  LaneMask shadowed, ambiguous;
  /// Holds for the ambiguous rays every primitive but planes that they may intersect; for others some. When ambiguous_count
  /// is above most_ambiguous there were more.
  static constexpr std::size_t most_ambiguous = 512;
  std::array<AmbiguousHit, most_ambiguous> ambiguous_hits;
  std::size_t ambiguous_count = 0;
  void note(std::uint32_t leaf, std::size_t first_lane, unsigned bits) {
    for (; bits != 0; bits &= bits - 1, ++ambiguous_count)
      if (ambiguous_count < most_ambiguous)
        ambiguous_hits[ambiguous_count] = {leaf, static_cast<std::uint32_t>(first_lane) +
                                                     static_cast<std::uint32_t>(std::countr_zero(bits))};
  }
};

}  // namespace gnomon::raytrace
