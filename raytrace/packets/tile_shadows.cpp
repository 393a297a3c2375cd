// Shadow rays of a tile through the hierarchy, 16 at a time: raytrace/packets/tile.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packets/tile_shadows.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "raytrace/packets/blocked-inl.h"
#include "raytrace/packets/frustum-inl.h"
#include "raytrace/packets/tile.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {
/// The slopes of the plane through three rays' receivers; none when they are too much in a line.
inline Floor slopes_through(const TileRays& r, std::size_t a, std::size_t b, std::size_t c) {
  const float du1 = r.u[b] - r.u[a], dv1 = r.v[b] - r.v[a], df1 = r.far[b] - r.far[a];
  const float du2 = r.u[c] - r.u[a], dv2 = r.v[c] - r.v[a], df2 = r.far[c] - r.far[a];
  const float det = du1 * dv2 - du2 * dv1;
  const float size = du1 * du1 + dv1 * dv1 + du2 * du2 + dv2 * dv2;
  if (!(std::abs(det) > 1e-3f * size)) return {};
  const Floor floor{(df1 * dv2 - df2 * dv1) / det, (du1 * df2 - du2 * df1) / det, 0.0f};
  return std::abs(floor.u) < 1e15f && std::abs(floor.v) < 1e15f ? floor : Floor{};
}

/// The first three corners, of four, that are asked for decide the slopes.
inline Floor slopes_of(const TileRays& r, const std::array<std::size_t, 4>& corners) {
  std::array<std::size_t, 4> found{};
  std::size_t count = 0;
  for (const std::size_t i : corners)
    if ((r.alive[i / packet_rays] >> (i % packet_rays) & 1) != 0) found[count++] = i;
  return count < 3 ? Floor{} : slopes_through(r, found[0], found[1], found[2]);
}

/// Sets the constant so that rays first … first + count lie above, by more than rounding (far: +infinity for
/// rays not asked for).
inline void lower(const TileRays& rays, const float* far, std::size_t first, std::size_t count,
                  Floor& floor) {
  V least = all(inf), scale = all(0.0f);
  const V gu = all(floor.u), gv = all(floor.v);
  for (std::size_t i = first; i < first + count; i += lanes()) {
    const V u = hn::Load(f, rays.u + i), v = hn::Load(f, rays.v + i), at = hn::Load(f, far + i);
    const M asked = hn::Lt(at, all(inf));
    const V tu = hn::Mul(gu, u), tv = hn::Mul(gv, v);
    least = hn::Min(least, hn::IfThenElse(asked, hn::Sub(hn::Sub(at, tu), tv), least));
    const V size = hn::Add(hn::Abs(at), hn::Add(hn::Abs(tu), hn::Abs(tv)));
    scale = hn::Max(scale, hn::IfThenElseZero(asked, size));
  }
  constexpr float rounding = 0x1p-19f;
  floor.constant = hn::GetLane(hn::MinOfLanes(f, least)) - rounding * hn::GetLane(hn::MaxOfLanes(f, scale));
}

class Shadows {
 public:
  Shadows(const Bvh& bvh, const EdgeSetup& setup, const TileRays& rays)
      : bvh_(bvh), setup_(setup), rays_(rays), axes_(axes_of(setup, rays)) {
    gather_packets(rays, packets_);
    for (std::size_t p = 0; p < tile_packets; ++p) {
      for (std::size_t i = 0; i < packet_rays; i += lanes()) {
        const std::size_t at = p * packet_rays + i;
        const M alive = mask_of(static_cast<unsigned>(rays.alive[p]) >> i);
        hn::Store(hn::IfThenElse(alive, hn::Load(f, rays.far + at), all(inf)), f, far_ + at);
      }
      packets_.far_min[p] = smallest(far_ + p * packet_rays);
      const std::size_t at = p * packet_rays;
      Floor floor = slopes_of(rays, {at, at + 3, at + 12, at + 15});
      lower(rays, far_, at, packet_rays, floor);
      floors_.u[p] = floor.u, floors_.v[p] = floor.v, floors_.constant[p] = floor.constant;
    }
  }

  void run(TileShadows& out) {
    shadowed_.fill(0), ambiguous_.fill(0);
    out.ambiguous_count = 0, out_ = &out;
    for (const PrimitiveEdges& plane : setup_.planes) {
      const RayTest rays(Functions(plane, axes_));
      for (std::size_t p = 0; p < tile_packets; ++p) test_packet<true>(plane, 0, rays, p);
    }
    const float far = smallest(packets_.far_min);
    if (far < inf) {
      Frustum frustum(bvh_, setup_, axes_, packets_);
      Floor floor =
          slopes_of(rays_, {tile_lane(0, 0), tile_lane(15, 0), tile_lane(0, 15), tile_lane(15, 15)});
      lower(rays_, far_, 0, tile_rays, floor);
      frustum.stand_on(floor, bvh_, setup_, axes_);
      const float limit = setup_.directional ? far : far > 0.0f ? -(1.0f / far) * (1.0f + 0x1p-20f) : -inf;
      traverse_tile(
          bvh_, frustum, [&] { return limit; },
          [&](std::uint32_t first, std::uint32_t count) {
            bool taken = false;
            for (std::uint32_t i = first; i < first + count; ++i) taken |= visit(i);
            return !taken || smallest(packets_.far_min) < inf;
          });
    }
    for (std::size_t p = 0; p < tile_packets; ++p) {
      out.shadowed[p] = static_cast<std::uint16_t>(shadowed_[p] & rays_.alive[p]);
      out.ambiguous[p] = static_cast<std::uint16_t>(ambiguous_[p] & ~shadowed_[p] & rays_.alive[p]);
    }
  }

 private:
  bool visit(std::uint32_t i) {
    const PrimitiveEdges& primitive = setup_.primitives[i];
    const Functions of(primitive, axes_);
    unsigned hit = intersected_packets(primitive, of, packets_,
                                       [&](const Linear& reciprocal_depth, V error, std::size_t at) {
                                         return behind_floor(reciprocal_depth, error, at);
                                       });
    if (hit == 0) return false;
    const RayTest rays(of);
    bool taken = false;
    for (; hit != 0; hit &= hit - 1)
      taken |= test_packet<false>(primitive, i, rays, static_cast<std::size_t>(std::countr_zero(hit)));
    return taken;
  }

  // The most by which the reciprocal depth may exceed the packets' floors, over their intervals.
  M behind_floor(const Linear& reciprocal_depth, V error, std::size_t i) const {
    const V u = hn::Sub(all(reciprocal_depth.u), hn::Load(f, floors_.u + i));
    const V v = hn::Sub(all(reciprocal_depth.v), hn::Load(f, floors_.v + i));
    const V constant = hn::Sub(all(reciprocal_depth.constant), hn::Load(f, floors_.constant + i));
    const V by_u =
        hn::Max(hn::Mul(u, hn::Load(f, packets_.u_min + i)), hn::Mul(u, hn::Load(f, packets_.u_max + i)));
    const V by_v =
        hn::Max(hn::Mul(v, hn::Load(f, packets_.v_min + i)), hn::Mul(v, hn::Load(f, packets_.v_max + i)));
    return hn::Lt(hn::Add(hn::Add(by_u, by_v), constant), hn::Neg(error));
  }

  template <bool plane>
  bool test_packet(const PrimitiveEdges& primitive, std::uint32_t leaf, const RayTest& rays,
                   std::size_t packet) {
    bool taken = false;
    for (std::size_t i = 0; i < packet_rays; i += lanes()) {
      const std::size_t at = packet * packet_rays + i;
      const V u = hn::Load(f, rays_.u + at), v = hn::Load(f, rays_.v + at);
      const V far = hn::Load(f, far_ + at);
      const Blocked blocked =
          blocked_by<plane>(primitive, rays, u, v, far, hn::Load(ids, rays_.source + at), hn::Eq(far, far));
      if (hn::AllFalse(f, blocked.perhaps)) continue;
      const unsigned bits = bits_of(blocked.surely);
      const unsigned open = bits_of(blocked.perhaps) & ~bits;
      ambiguous_[packet] |= open << i;
      if (!plane) out_->note(leaf, at, open);
      if (bits == 0) continue;
      shadowed_[packet] |= bits << i;
      hn::Store(hn::IfThenElse(blocked.surely, all(inf), far), f, far_ + at);
      taken = true;
    }
    if (taken) packets_.far_min[packet] = smallest(far_ + packet * packet_rays);
    return taken;
  }

  const Bvh& bvh_;
  const EdgeSetup& setup_;
  const TileRays& rays_;
  Axes axes_;
  Packets packets_;
  Floors floors_;
  std::array<unsigned, tile_packets> shadowed_, ambiguous_;
  TileShadows* out_ = nullptr;
  alignas(64) float far_[tile_rays];
};

void shadows_kernel(const Bvh& bvh, const EdgeSetup& setup, const TileRays& rays, TileShadows& shadows) {
  Shadows(bvh, setup, rays).run(shadows);
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(shadows_kernel);

void shadows_in_tile(const Bvh& bvh, const EdgeSetup& setup, const TileRays& rays, TileShadows& shadows) {
  HWY_DYNAMIC_DISPATCH(shadows_kernel)(bvh, setup, rays, shadows);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
