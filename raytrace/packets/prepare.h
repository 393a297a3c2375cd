// A tile's shadow rays from its receivers, in double, many at a time; compiled once per instruction
// set.
#pragma once

#include <array>

#include "raytrace/packets/light_setup.h"
#include "raytrace/packets/tile.h"
#include "raytrace/quantised_tile.h"
#include "scene/camera.h"

namespace gnomon::raytrace {

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
