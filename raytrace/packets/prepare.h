// A tile's shadow rays from its receivers, in double, many at a time; compiled once per instruction
// set.
#pragma once

#include <array>

#include "raytrace/packets/sight.h"
#include "raytrace/packets/tile.h"
#include "scene/camera.h"

namespace gnomon::raytrace {

/// Bits per packet.
struct ShadowLanes {
  LaneMask apart;      ///< receivers out of range: to the double kernels
  LaneMask unreached;  ///< facing away
  LaneMask grazing;    ///< floats cannot say whether they face away; set up alike
};

/// A whole tile of receivers, row by row `stride` apart. No spot lights.
void prepare_shadows(const Light& light, const EdgeSetup& setup, const SurfacePoint* receivers,
                     std::size_t stride, TileRays& rays, ShadowLanes& lanes);

/// The same from those of a tile's quantised receivers that are asked for (bits per packet); alive rays
/// include the grazing ones. A spot light's cone is not looked at.
void prepare_quantised(const Light& light, const EdgeSetup& setup, const QuantisedTile& tile,
                       const LaneMask& asked, TileRays& rays, ShadowLanes& lanes);

}  // namespace gnomon::raytrace
