// A tile's receivers as shadow rays read them: floats that count from a point of the tile, a third of the
// size of SurfacePoint. A component is right to 2^-24 of `extent`; the passes let that into their bounds, and
// what it leaves open they ask of the receivers in double.
#pragma once

#include "raytrace/packet/tile.h"

namespace gnomon::raytrace {

struct alignas(64) CompactTile {
  std::array<std::uint16_t, tile_packets> present;  ///< bit i of a packet: there is a receiver
  bool any = false;                                 ///< else only `present` has been written
  Vec3 origin;
  Aabb bounds;          ///< of the positions, world
  double extent = 0.0;  ///< no component of `position` is larger
  alignas(64) float position[3][tile_rays], normal[3][tile_rays];
  alignas(64) std::uint32_t own[tile_rays];

  void clear() { present.fill(0), any = false, bounds = Aabb{}, extent = 0.0; }
  /// A receiver by itself; clear() comes first.
  void put(std::size_t lane, const SurfacePoint& point);
  /// Sets what follows from the bounds.
  void finish();
};

}  // namespace gnomon::raytrace
