// Shadow rays of up to 4 x 4 tiles in one traversal through the hierarchy, as view_block.h for the eye: a
// primitive's numbers (edge_setup.h) are found when the traversal comes to it, tried on the packets that its
// bounds touch, and forgotten. A light costs what lies between it and the receivers, whatever else the world holds.
#pragma once

#include <span>

#include "raytrace/packets/edge_setup.h"
#include "raytrace/packets/tile.h"

namespace gnomon::raytrace {

inline constexpr std::size_t most_shadow_tiles = 16;

/// A tile's rays, seen in the setup's axes, and where their answers go.
struct ShadowTileRays {
  const TileRays* rays;
  TileShadows* shadows;
};

/// `setup`: a direction's, or a framed point's. At most most_shadow_tiles. A tile that meets more leaves than its rays are
/// worth is left to single rays, unless `at_any_cost`: then all its rays are ambiguous, and it says that it does not know
/// what they may hit.
void shadows_in_block(const Structures& structures, const EdgeSetup& setup,
                      std::span<const ShadowTileRays> tiles, bool at_any_cost = false);

}  // namespace gnomon::raytrace
