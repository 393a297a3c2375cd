// A square of up to 4 x 4 tiles of a picture in one traversal through the hierarchy. A primitive's numbers
// (raytrace/packets/edge_setup.h) are found when the traversal comes to it, tried on the packets that its
// bounds touch, and forgotten. Nothing is sorted, nothing but hits is written to memory.
#pragma once

#include <span>
#include <vector>

#include "raytrace/packets/blocks.h"
#include "raytrace/packets/edge_setup.h"
#include "raytrace/packets/tile.h"
#include "scene/camera.h"

namespace gnomon::raytrace {

/// A primitive that a ray may intersect where its nearest hit is ambiguous. place: tile by tile, as in
/// BlockHits.
struct AmbiguousBlockHit {
  std::uint32_t place, leaf;
};

struct BlockHits {
  std::array<TileHits, std::size_t{block_tiles} * block_tiles> tiles;  ///< row by row
  /// Holds for the ambiguous rays everything but planes that may be their nearest hit, in the order of places; for others
  /// some.
  std::vector<AmbiguousBlockHit> ambiguous_hits;
  bool all_ambiguous = true;  ///< false: there were more than are worth keeping
  /// Leaves of those that the ray at this place may intersect.
  std::span<const AmbiguousBlockHit> ambiguous_at(std::size_t place) const;
};

/// `setup`: edge_setup_of_eye(). Rays outside the rectangle are ambiguous_hit.
void closest_in_block(const Structures& structures, const EdgeSetup& setup, const View& view,
                      const BlockRect& rect, BlockHits& hits);

}  // namespace gnomon::raytrace
