// A square of up to 4 x 4 tiles of a picture in one walk through the hierarchy: a primitive's numbers
// (raytrace/packets/seen.h) are found when the walk comes to it, tried on the packets that its bounds touch,
// and forgotten: nothing is sorted, nothing but hits is written to memory.
#pragma once

#include <span>
#include <vector>

#include "raytrace/packets/seen.h"
#include "raytrace/packets/tile.h"
#include "scene/camera.h"

namespace gnomon::raytrace {

inline constexpr int block_tiles = 4, block_pixels = 16 * block_tiles;

/// A block's rectangle of pixels begins at a multiple of 16 and holds at most 64 x 64.
struct BlockRect {
  int x0, y0, x1, y1;
};

/// A primitive that a ray may meet where its nearest hit is unsure. place: tile by tile, as in BlockHits.
struct BlockDoubt {
  std::uint32_t place, leaf;
};

struct BlockHits {
  std::array<TileHits, std::size_t{block_tiles} * block_tiles> tiles;  ///< row by row
  /// Of the unsure rays everything but planes that may be their nearest hit, in the order of places; of
  /// others some.
  std::vector<BlockDoubt> doubts;
  bool all_doubts = true;  ///< false: there were more than are worth keeping
  /// Leaves of those that the ray at this place may meet.
  std::span<const BlockDoubt> doubts_at(std::size_t place) const;
};

/// `seen`: framed to the view, without primitives. Rays outside the rectangle are unsure_hit.
void closest_in_block(const Structures& structures, const Seen& seen, const View& view, const BlockRect& rect,
                      BlockHits& hits);

}  // namespace gnomon::raytrace
