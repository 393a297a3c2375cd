// The packets of a picture on the eye's plane, and which of them primitives' bounds touch; compiled once per
// instruction set.
#pragma once

#include <cstdint>

#include "raytrace/packets/tile.h"

namespace gnomon::raytrace {

/// One axis of the plane: the rays of `pixels` pixels, `width` apart from `first` on, four to a packet.
struct PacketAxis {
  double first = 0.0, width = 1.0;
  int pixels = 1;
  static constexpr int per_packet = 4;
};

/// Along one axis: the packets that sixteen primitives' bounds may touch; first > last: none. Else low and high are where
/// the first and the last of these rays meet the plane.
struct alignas(64) PacketSpans {
  static constexpr std::size_t together = 16;
  std::int32_t first[together], last[together];
  float low[together], high[together];
};

/// `slack`: what rays and bounds may be wrong by. `min`, `max`: as many each.
void place_bounds(const PacketAxis& axis, double slack, const float* min, const float* max, PacketSpans& out);

/// How many of `count` numbers come before each when the greatest come first, and of equals the first. Both
/// are padded by packet_rays.
void rank_falling(const float* numbers, std::size_t count, std::uint32_t* rank);

}  // namespace gnomon::raytrace
