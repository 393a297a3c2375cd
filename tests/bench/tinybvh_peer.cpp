#include "embree_peer.h"

#if __has_include(<tiny_bvh.h>)
#define TINYBVH_IMPLEMENTATION
#include <hwy/targets.h>
#include <tbb/parallel_for.h>
#include <tiny_bvh.h>

#include "raytrace/packets/tile.h"

namespace gnomon::bench {
namespace {

using tinybvh::bvhvec3;

/// Its directions have length 1.
tinybvh::Ray ray_at(const PeerRays& rays, std::size_t at) {
  tinybvh::Ray ray;
  const bvhvec3 direction(rays.dx[at], rays.dy[at], rays.dz[at]);
  ray.O = bvhvec3(rays.ox[at], rays.oy[at], rays.oz[at]);
  ray.D = tinybvh::tinybvh_normalize(direction), ray.rD = tinybvh::tinybvh_rcp(ray.D);
  ray.hit.t = std::min(rays.far[at] * tinybvh::tinybvh_length(direction), BVH_FAR);
  return ray;
}

/// trace(at) for the rays that are to be traced, by tiles over all threads.
template <class Trace>
void for_each_ray(const PeerRays& rays, const Trace& trace) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.tiles, 1), [&](const auto& tiles) {
    for (std::size_t at = tiles.begin() * raytrace::tile_rays; at < tiles.end() * raytrace::tile_rays; ++at)
      if (rays.valid[at] != 0) trace(at);
  });
}

class Peer : public TinyBvh {
 public:
  explicit Peer(const World& world) {
    const std::vector<Vec3> positions = positions_of(world);
    for (const auto& triangle : triangles_of(world))
      for (const std::uint32_t corner : triangle) {
        const Vec3f p(positions[corner]);
        corners_.emplace_back(p.x, p.y, p.z, 0.0f);
      }
    bvh_.BuildHQ(corners_.data(), static_cast<std::uint32_t>(corners_.size() / 3));
  }

  void closest(const PeerRays& rays, PeerHits& hits) const override {
    const std::size_t n = rays.tiles * raytrace::tile_rays;
    hits.t.resize(n), hits.u.resize(n), hits.v.resize(n);
    hits.primitive.assign(n, no_id);
    for_each_ray(rays, [&](std::size_t at) {
      tinybvh::Ray ray = ray_at(rays, at);
      bvh_.Intersect(ray);
      hits.t[at] = ray.hit.t, hits.u[at] = ray.hit.u, hits.v[at] = ray.hit.v;
      if (ray.hit.t < BVH_FAR) hits.primitive[at] = ray.hit.prim;
    });
  }

  void occluded(const PeerRays& rays, std::vector<std::uint8_t>& occluded) const override {
    occluded.assign(rays.tiles * raytrace::tile_rays, 0);
    for_each_ray(rays, [&](std::size_t at) { occluded[at] = bvh_.IsOccluded(ray_at(rays, at)) ? 1 : 0; });
  }

 private:
  std::vector<tinybvh::bvhvec4> corners_;
  tinybvh::BVH8_CPU bvh_;
};

}  // namespace

std::unique_ptr<TinyBvh> make_tiny_bvh(const World& world) {
  const bool has_avx2 = (hwy::SupportedTargets() & (HWY_AVX2 | HWY_AVX3 | HWY_AVX3_DL)) != 0;
  if (!has_avx2 || world.keeps_instances()) return nullptr;
  return std::make_unique<Peer>(world);
}

}  // namespace gnomon::bench

#else

namespace gnomon::bench {

std::unique_ptr<TinyBvh> make_tiny_bvh(const World&) {
  return nullptr;
}

}  // namespace gnomon::bench
#endif
