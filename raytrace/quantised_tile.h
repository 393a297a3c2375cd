// A tile's receivers as shadow rays read them: floats that count from the middle of the tile's, a quarter of
// the size of SurfacePoint. The passes let into their bounds what a component may be wrong by, and what that
// leaves open they ask of the receivers in double.
#pragma once

#include "raytrace/tiles.h"
#include "raytrace/tracer.h"

namespace gnomon::raytrace {

/// A normal's components are whole numbers of a unit, which sixteen bits hold. Its direction matters for facing a light,
/// and what the rounding leaves open is asked of the receiver in double.
inline constexpr float normal_units = 32767.0f;
/// What a component may be wrong by, in units: its rounding, and what the normal itself is wrong by in floats.
inline constexpr double normal_error = 0.51;

/// What a quantised tile is made of: positions in double, until their middle is known.
struct alignas(64) TileDraft {
  double position[3][tile_rays];
  std::int16_t normal[3][tile_rays];
  std::uint32_t source[tile_rays];
  Aabb bounds;  ///< of the positions, world
};

struct alignas(64) QuantisedTile {
  LaneMask present;  ///< bit i of a packet: there is a receiver
  bool any = false;  ///< else only `present` has been written
  Vec3 origin;
  Aabb bounds;          ///< of the positions, world
  double extent = 0.0;  ///< no component of `position` is above this, and each is right to 1.13 * 2^-24 of it
  alignas(64) float position[3][tile_rays];
  alignas(64) std::int16_t normal[3][tile_rays];
  alignas(64) std::uint32_t source[tile_rays];

  void clear() { present.fill(0), any = false, bounds = Aabb{}, extent = 0.0; }
  /// A receiver by itself; clear() comes first.
  void put(std::size_t lane, const SurfacePoint& point, TileDraft& draft);
  /// From the draft; `eye`: where the receivers were seen from. With non-temporal stores: a picture's tiles are
  /// read after all of them are written, and after publish_receivers().
  void finish(const TileDraft& draft, const Vec3& eye);
};

/// What this thread has written with non-temporal stores (QuantisedTile::finish, ReceiverSinks::non_temporal) comes before
/// whatever it does next, as other threads see it. Waits for memory, so that it is called once for many tiles.
void publish_receivers();

/// Asks memory for a packet of a tile that is read next. Inlined by force: GCC leaves out calls of functions that do nothing
/// else.
[[gnu::always_inline]] inline void prefetch(const QuantisedTile& next, std::size_t packet) {
  const std::size_t first = packet * packet_rays;
  for (std::size_t a = 0; a < 3; ++a)
    __builtin_prefetch(next.position[a] + first), __builtin_prefetch(next.normal[a] + first);
  __builtin_prefetch(next.source + first);
}

/// The whole tile; none need be there.
[[gnu::always_inline]] inline void prefetch(const QuantisedTile* next) {
  const char* bytes = reinterpret_cast<const char*>(next);
  for (std::size_t i = 0; i < sizeof(QuantisedTile); i += 64) __builtin_prefetch(bytes + i);
}

}  // namespace gnomon::raytrace
