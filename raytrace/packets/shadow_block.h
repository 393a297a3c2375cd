// Shadow rays of up to 4 x 4 tiles in one traversal through the hierarchy, as view_block.h for the eye. A
// primitive's numbers (edge_setup.h) are found when the traversal comes to it, tried on the packets that its bounds
// touch, and forgotten. A light costs what lies between it and the receivers, whatever else the world holds.
#pragma once

#include <array>
#include <span>

#include "raytrace/packets/edge_setup.h"
#include "raytrace/packets/light_setup.h"
#include "raytrace/packets/tile.h"
#include "raytrace/quantised_tile.h"
#include "scene/camera.h"

namespace gnomon::raytrace {

inline constexpr std::size_t most_shadow_tiles = 16;

/// A tile's rays, seen in the setup's axes, and where their answers go.
struct ShadowTileRays {
  const TileRays* rays;
  TileShadows* shadows;
};

/// `setup`: a direction's, or a framed point's. At most most_shadow_tiles. A tile that meets more leaves than its rays are
/// worth is left to single rays, unless `at_any_cost`. All rays of a tile so left are ambiguous, and it says that it does
/// not know what they may hit.
void shadows_in_block(const Structures& structures, const EdgeSetup& setup,
                      std::span<const ShadowTileRays> tiles, bool at_any_cost = false);

// A tile's shadow rays from its receivers, in double, many at a time; compiled once per instruction
// set.

/// Bits per packet.
struct ShadowLanes {
  LaneMask apart;      ///< receivers out of range: to the double kernels
  LaneMask unreached;  ///< facing away
  LaneMask grazing;    ///< floats cannot say whether they face away; set up alike
};

/// The rays of those of a tile's quantised receivers that are asked for (bits per packet); alive rays include the
/// grazing ones. A spot light's cone is not looked at. `next`, or null: the tile that comes next, of which memory is asked.
void prepare_quantised(const Light& light, const EdgeSetup& setup, const QuantisedTile& tile,
                       const QuantisedTile* next, const LaneMask& asked, TileRays& rays, ShadowLanes& lanes);

}  // namespace gnomon::raytrace
