// A tile's rays from a camera or from receivers, in double, many at a time; compiled once per instruction
// set.
#pragma once

#include <array>

#include "raytrace/packet/sight.h"
#include "raytrace/packet/tile.h"
#include "scene/camera.h"

namespace gnomon::raytrace {

/// A whole tile of 16 x 16 pixels from (x0, y0). rays.axis and sign are given; rays that they do not fit are
/// not alive.
void prepare_primary(const View& view, int x0, int y0, TileRays& rays);

/// The same as a framed eye sees them (frame_of_view): all rays fit.
void prepare_framed(const View& view, int x0, int y0, TileRays& rays);

/// Bits per packet.
struct ShadowLanes {
  std::array<std::uint16_t, tile_packets> apart;      ///< receivers out of range: to the double kernels
  std::array<std::uint16_t, tile_packets> unreached;  ///< facing away
  std::array<std::uint16_t, tile_packets>
      grazing;  ///< floats cannot say whether they face away; set up alike
};

/// A whole tile of receivers, row by row `stride` apart. No spot lights.
void prepare_shadows(const Light& light, const Seen& seen, const SurfacePoint* receivers, std::size_t stride,
                     TileRays& rays, ShadowLanes& lanes);

/// The same from those of a tile's compact receivers that are asked for (bits per packet); alive rays include
/// the grazing ones. A spot light's cone is not looked at.
void prepare_compact(const Light& light, const Seen& seen, const CompactTile& tile,
                     const std::array<std::uint16_t, tile_packets>& asked, TileRays& rays,
                     ShadowLanes& lanes);

}  // namespace gnomon::raytrace
