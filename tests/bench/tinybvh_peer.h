// tinybvh as a peer, where its header was found (GNOMON_TINYBVH, tests/raytrace_tests.cmake): BVH8_CPU, its layout for
// single rays on processors with AVX2, of its best builder. The rays are Embree's.
#pragma once

#include <memory>

#include "embree_peer.h"

namespace gnomon::bench {

class TinyBvh {
 public:
  virtual ~TinyBvh() = default;
  /// hits.primitive is no_id where nothing is hit.
  virtual void closest(const PeerRays& rays, PeerHits& hits) const = 0;
  virtual void occluded(const PeerRays& rays, std::vector<std::uint8_t>& occluded) const = 0;
};

/// Null where its header was not found, without AVX2, and where instances are kept.
std::unique_ptr<TinyBvh> make_tiny_bvh(const World& world);

}  // namespace gnomon::bench
