// Primary rays of a tile through the hierarchy, 16 at a time: raytrace/packet/tile.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packet/tile_closest.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "raytrace/packet/frustum-inl.h"
#include "raytrace/packet/tile.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {
/// The closest hits of a tile. Of each ray the best sure hit's nearness is known to lie in [low, high], and
/// no other hit is nearer than `doubt`.
class Closest {
 public:
  Closest(const Bvh& bvh, const Seen& seen, const TileRays& rays)
      : bvh_(bvh), seen_(seen), rays_(rays), axes_(axes_of(seen, rays)) {
    gather_packets(rays, packets_);
    for (std::size_t p = 0; p < tile_packets; ++p) {
      packets_.far_min[p] = rays.alive[p] != 0 ? 0.0f : inf;
      for (std::size_t i = 0; i < packet_rays; i += lanes()) {
        const std::size_t at = p * packet_rays + i;
        const V start =
            hn::IfThenElse(mask_of(static_cast<unsigned>(rays.alive[p]) >> i), all(0.0f), all(inf));
        hn::Store(start, f, low_ + at), hn::Store(start, f, high_ + at);
        hn::Store(all(-inf), f, doubt_ + at);
        hn::Store(hn::Set(ids, nothing_hit), ids, leaf_ + at);
      }
    }
  }

  void run(TileHits& hits) {
    for (std::uint32_t i = 0; i < seen_.planes.size(); ++i)
      for (std::size_t p = 0; p < tile_packets; ++p) test<true>(seen_.planes[i], first_plane + i, p);
    const Frustum frustum(bvh_, seen_, axes_, packets_);
    update_limit();
    walk_tile(
        bvh_, frustum, [&] { return limit_; },
        [&](std::uint32_t first, std::uint32_t count) {
          bool taken = false;
          for (std::uint32_t i = first; i < first + count; ++i) taken |= visit(i);
          if (taken) update_limit();
          return true;
        });
    for (std::size_t i = 0; i < tile_rays; i += lanes()) {
      const M unsure = hn::Ge(hn::Load(f, doubt_ + i), hn::Load(f, low_ + i));
      const auto leaf =
          hn::IfThenElse(hn::RebindMask(ids, unsure), hn::Set(ids, unsure_hit), hn::Load(ids, leaf_ + i));
      hn::Store(leaf, ids, hits.leaf + i);
    }
  }

 private:
  bool visit(std::uint32_t i) {
    const SeenPrimitive& primitive = seen_.primitives[i];
    const Functions of(primitive, axes_);
    unsigned met = packets_met(primitive, of, packets_,
                               [](const Linear&, V error, std::size_t) { return hn::Lt(error, error); });
    if (met == 0) return false;
    const RayTest rays(of);
    bool taken = false;
    for (; met != 0; met &= met - 1)
      taken |= test_packet<false>(primitive, rays, i, static_cast<std::size_t>(std::countr_zero(met)));
    return taken;
  }
  template <bool plane>
  void test(const SeenPrimitive& primitive, std::uint32_t leaf, std::size_t packet) {
    test_packet<plane>(primitive, RayTest(Functions(primitive, axes_)), leaf, packet);
  }

  template <bool plane>
  bool test_packet(const SeenPrimitive& primitive, const RayTest& rays, std::uint32_t leaf,
                   std::size_t packet) {
    bool taken = false;
    for (std::size_t i = 0; i < packet_rays; i += lanes()) {
      const std::size_t at = packet * packet_rays + i;
      const V u = hn::Load(f, rays_.u + at), v = hn::Load(f, rays_.v + at);
      const V edge = plane ? all(inf) : rays.least_edge(u, v);
      const V edge_error = all(primitive.edge_error), depth_error = all(primitive.depth_error);
      const V nearness = rays.nearness(u, v);
      const V low = hn::Load(f, low_ + at), high = hn::Load(f, high_ + at);
      const M known = hn::Gt(nearness, all(primitive.depth_floor));
      const M behind = hn::And(hn::Lt(nearness, hn::Sub(low, depth_error)), known);
      const M contact = hn::AndNot(behind, hn::Ge(edge, hn::Neg(edge_error)));
      if (hn::AllFalse(f, contact)) continue;
      taken |=
          record(primitive, leaf, at, contact, hn::And(hn::Gt(edge, edge_error), known), nearness, low, high);
    }
    if (taken) packets_.far_min[packet] = smallest_low(packet);
    return taken;
  }

  bool record(const SeenPrimitive& primitive, std::uint32_t leaf, std::size_t at, M contact, M inside,
              V nearness, V low, V high) {
    const V depth_error = all(primitive.depth_error);
    const bool may_be_sure = (primitive.id & never_sure) == 0;
    const M sure = hn::And(contact, may_be_sure ? inside : hn::Lt(low, low));
    const V new_low = hn::Sub(nearness, depth_error);
    const V new_high = hn::IfThenElse(hn::Gt(nearness, all(primitive.depth_floor)),
                                      hn::Add(nearness, depth_error), all(inf));
    const M take = hn::And(sure, hn::Gt(new_low, low));
    // Surely nearer than all that was sure before: the old best is no rival. Otherwise the loser is a doubt.
    const M rival = hn::AndNot(hn::And(take, hn::Gt(new_low, high)), contact);
    const V doubt = hn::Load(f, doubt_ + at), loser = hn::IfThenElse(take, high, new_high);
    hn::Store(hn::IfThenElse(rival, hn::Max(doubt, loser), doubt), f, doubt_ + at);
    if (hn::AllFalse(f, take)) return false;
    hn::Store(hn::IfThenElse(take, new_low, low), f, low_ + at);
    hn::Store(hn::IfThenElse(take, new_high, high), f, high_ + at);
    const auto old = hn::Load(ids, leaf_ + at);
    hn::Store(hn::IfThenElse(hn::RebindMask(ids, take), hn::Set(ids, leaf), old), ids, leaf_ + at);
    return true;
  }

  float smallest_low(std::size_t packet) const { return smallest(low_ + packet * packet_rays); }
  // The farthest depth at which any ray may still find something nearer, as a priority.
  void update_limit() {
    const float far = smallest(packets_.far_min);
    limit_ = far > 0.0f ? -(1.0f / far) * (1.0f + 0x1p-20f) : -inf;
  }

  const Bvh& bvh_;
  const Seen& seen_;
  const TileRays& rays_;
  Axes axes_;
  Packets packets_;
  float limit_ = -inf;
  alignas(64) float low_[tile_rays], high_[tile_rays], doubt_[tile_rays];
  alignas(64) std::uint32_t leaf_[tile_rays];
};

void closest_kernel(const Bvh& bvh, const Seen& seen, const TileRays& rays, TileHits& hits) {
  Closest(bvh, seen, rays).run(hits);
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(closest_kernel);

void closest_in_tile(const Bvh& bvh, const Seen& seen, const TileRays& rays, TileHits& hits) {
  HWY_DYNAMIC_DISPATCH(closest_kernel)(bvh, seen, rays, hits);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
