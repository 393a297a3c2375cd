// Embree as the peer: the same rays in the same order (16 x 16 tiles, packets of 4 x 4 pixels), one at a
// time or 16 coherent ones together, over all threads that oneTBB is allowed. Its rays are floats, made ready
// beforehand: their making is not in its times.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "raytrace/frame.h"
#include "tests/support/embree.h"

namespace gnomon::bench {

/// A row of rays' numbers, of which there are several. Large blocks of memory begin at the same place of a page, so that one ray's
/// numbers would lie in one set of the processor's cache and drive each other out: the `place`-th row begins a little farther on.
template <class T>
class PeerRow {
 public:
  explicit PeerRow(std::size_t place) : skipped_(13 * place * 64 / sizeof(T)) {}
  void resize(std::size_t count) { values_.resize(skipped_ + count); }
  void assign(std::size_t count, T value) { values_.assign(skipped_ + count, value); }
  std::size_t size() const { return values_.size() - std::min(skipped_, values_.size()); }
  T& operator[](std::size_t i) { return values_[skipped_ + i]; }
  const T& operator[](std::size_t i) const { return values_[skipped_ + i]; }

 private:
  std::size_t skipped_;
  std::vector<T> values_;
};

/// Rays of all pixels in the order of tiles and places in tiles; pixels outside the image have valid 0.
struct PeerRays {
  std::size_t tiles = 0;
  PeerRow<float> ox{0}, oy{1}, oz{2}, dx{3}, dy{4}, dz{5}, far{6};
  PeerRow<int> valid{7};  ///< -1: to be traced
  std::size_t count = 0;  ///< valid ones
};

PeerRays primary_rays(const View& view);
/// From the receivers that the light can reach, lifted off their surface by 2^-14 of `scale` along the
/// normal.
PeerRays shadow_rays(const raytrace::RayTracedFrame& frame, const Light& light, double scale);

/// Mirrored at the receivers, one after another: rays that share neither origin nor direction.
PeerRays mirror_rays(const raytrace::RayTracedFrame& frame, const View& view, double scale);

struct PeerHits {
  PeerRow<float> t{8}, u{9}, v{10};
  PeerRow<unsigned> primitive{11};
};

class Embree {
 public:
  /// `settings` as rtcNewDevice takes them: "isa=avx2"; empty: the best that the machine has. Instances that the
  /// world keeps are Embree's instances.
  Embree(const World& world, const std::string& settings);
  ~Embree();
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  /// What it holds once it is built: its tree and its copies of the vertices and indices.
  std::size_t bytes() const { return static_cast<std::size_t>(*bytes_); }
  void closest_single(const PeerRays& rays, PeerHits& hits) const;
  void closest_packets(const PeerRays& rays, PeerHits& hits) const;
  void occluded_single(const PeerRays& rays, std::vector<std::uint8_t>& occluded) const;
  void occluded_packets(const PeerRays& rays, std::vector<std::uint8_t>& occluded) const;

 private:
  /// Takes the geometry over.
  void attach(RTCScene scene, RTCGeometry geometry) const;
  RTCGeometry triangles(std::span<const Vec3> positions,
                        std::span<const std::array<std::uint32_t, 3>> triangles) const;
  void add_instances(const World& world);

  std::unique_ptr<std::atomic<ssize_t>> bytes_;
  RTCDevice device_;
  RTCScene scene_;
  std::map<const Mesh*, RTCScene> meshes_;  ///< of kept instances
};

// tinybvh as a peer, where its header was found (GNOMON_TINYBVH, tests/bench/tests.cmake): BVH8_CPU, its layout for
// single rays on processors with AVX2, of its best builder. The rays are Embree's.

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
