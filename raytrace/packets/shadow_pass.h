// A light's hard shadows over a picture: blocks of 64 x 64 receivers, each in one traversal of the hierarchy
// (shadow_block.h). Needs packets_apply().
#pragma once

#include <span>
#include <stop_token>

#include "raytrace/packets/passes.h"
#include "raytrace/receiver_tiles.h"

namespace gnomon::raytrace {

/// Which rays go by packets. Where it is cheaper: those of a tile that meets few enough leaves for its rays, which the
/// traversal finds out (tile_state-inl.h); the other two are for those who ask what that choice is worth.
enum class PacketUse : std::uint8_t { where_cheaper, always, never };

/// A picture's receivers, or those of its rows from first_row on, as a light's pass reads them.
struct PictureReceivers {
  const Tracer& tracer;
  ImageSize size;
  const Image<SurfacePoint>* stored = nullptr;
  const View* view = nullptr;                  ///< these two when none are stored
  std::span<const TileHits> hits{};            ///< by tile
  std::span<const QuantisedTile> quantised{};  ///< by tile; empty: the receivers are stored
  int first_row = 0;                           ///< as PrimarySinks has it
  PacketUse packets = PacketUse::where_cheaper;
};

struct ShadowRayCounts {
  std::uint64_t cast = 0;
  std::uint64_t single = 0;  ///< of these, traced one by one
  ShadowRayCounts& operator+=(const ShadowRayCounts& other) {
    cast += other.cast, single += other.single;
    return *this;
  }
};

/// Fills `visibility` as Tracer::centre_visibility does, `shadowed` where the light cannot reach, and returns the
/// numbers of rays. Once a stop is requested no further block is begun.
ShadowRayCounts shadow_pass(const PictureReceivers& receivers, const Light& light,
                            Image<PointVisibility>& visibility, const std::stop_token& stop = {});

/// The visibility of the asked receivers alone (by tile, bits per packet), which exist and which the light reaches; the
/// others' are left as they are. The receivers are stored.
void shadow_pass_of(const PictureReceivers& receivers, const Light& light, std::span<const LaneMask> asked,
                    Image<PointVisibility>& visibility);

}  // namespace gnomon::raytrace
