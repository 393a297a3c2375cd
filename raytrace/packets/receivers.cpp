#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packets/receivers.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <cstddef>

#include "raytrace/packets/double_lanes-inl.h"
#include "raytrace/packets/receivers.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {
using namespace doubles;

template <int axis>
inline V along(const V3& v) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}
inline V least_of(V a, V b, V c) {
  return hn::Min(a, hn::Min(b, c));
}
inline V most_of(V a, V b, V c) {
  return hn::Max(a, hn::Max(b, c));
}

struct Weights {
  V b1, b2;
  M sound;  ///< the scalar kernel would say the same
};

/// make_ray_frame, shear and finish_triangle for rays whose largest component is along k.
template <int k>
inline Weights intersect(const V3& direction, const V3& origin, const V3 (&corner)[3]) {
  constexpr int kx = (k + 1) % 3, ky = (k + 2) % 3;
  const V dx = along<kx>(direction), dy = along<ky>(direction), dz = along<k>(direction);
  const V shear_x = hn::Div(dx, dz), shear_y = hn::Div(dy, dz), shear_z = hn::Div(all(1.0), dz);
  const auto from_origin = [&](const V3& v) {
    const V z = hn::Sub(along<k>(v), along<k>(origin));
    const auto sheared = [&](V at, V from, V shear) { return hn::Sub(hn::Sub(at, from), hn::Mul(shear, z)); };
    return V3{sheared(along<kx>(v), along<kx>(origin), shear_x),
              sheared(along<ky>(v), along<ky>(origin), shear_y), z};
  };
  const V3 p = from_origin(corner[0]), q = from_origin(corner[1]), r = from_origin(corner[2]);
  const auto edge = [](const V3& a, const V3& b) { return hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x)); };
  const V u = edge(r, q), v = edge(p, r), w = edge(q, p);
  const V det = hn::Add(hn::Add(u, v), w);
  const V depth = hn::Div(hn::Add(hn::Add(hn::Mul(u, p.z), hn::Mul(v, q.z)), hn::Mul(w, r.z)), det);
  const V clamped = hn::Min(hn::Max(depth, least_of(p.z, q.z, r.z)), most_of(p.z, q.z, r.z));
  const V t = hn::Mul(clamped, shear_z), zero = all(0.0), largest = hn::Abs(dz);
  // An edge function of zero: not here.
  const M inside = hn::Or(hn::Gt(least_of(u, v, w), zero), hn::Lt(most_of(u, v, w), zero));
  const M longest = hn::And(hn::Gt(largest, hn::Max(hn::Abs(dx), hn::Abs(dy))), hn::Lt(largest, all(1.0)));
  const M ahead = hn::And(hn::Gt(t, zero), hn::Lt(t, all(infinity)));
  return {hn::Div(v, det), hn::Div(w, det), hn::And(inside, hn::And(longest, ahead))};
}

/// What the pixels' triangles are, whichever rays hit them.
struct HitTriangles {
  HitCorners from;
  V3 normal = all(Vec3(0.0));   ///< unit, on the side of the corners' order
  V position_error = all(0.0);  ///< the part that comes of their size

  alignas(32) std::uint32_t ids[8] = {};

  void load(const Bvh& bvh, const std::uint32_t* leaf, unsigned known) {
    if (!from.load(bvh, leaf, known)) return;
    for (std::size_t i = 0; i < hn::Lanes(d); ++i)
      if ((known >> i & 1) != 0) ids[i] = bvh.id_at(leaf[i]);
    const V3(&corner)[3] = from.corner;
    const auto extent = [](V p, V q, V r) { return hn::Sub(most_of(p, q, r), least_of(p, q, r)); };
    position_error = hn::Mul(all(error_gamma(24)), most_of(extent(corner[0].x, corner[1].x, corner[2].x),
                                                           extent(corner[0].y, corner[1].y, corner[2].y),
                                                           extent(corner[0].z, corner[1].z, corner[2].z)));
    const V3 n = cross(minus(corner[1], corner[0]), minus(corner[2], corner[0]));
    const V length = hn::Sqrt(dot(n, n));
    normal = {hn::Div(n.x, length), hn::Div(n.y, length), hn::Div(n.z, length)};
  }
};

/// SurfacePoint, as many as there are lanes, but for their primitives.
struct Points {
  V3 position, error, normal;
  V b1, b2;
};

/// triangle_point and the normal on the side of the viewer.
inline Points points_of(const V3& direction, const HitTriangles& triangles, const Weights& w) {
  const V3(&corner)[3] = triangles.from.corner;
  const V b0 = hn::Sub(hn::Sub(all(1.0), w.b1), w.b2);
  const V3 a = times(b0, corner[0]), b = times(w.b1, corner[1]), c = times(w.b2, corner[2]);
  const V widest = triangles.position_error;
  const V3 reach = times(all(error_gamma(7)), plus(plus(size_of(a), size_of(b)), size_of(c)));
  const V3& normal = triangles.normal;
  const M away = hn::Gt(dot(normal, direction), all(0.0));
  const auto facing = [&](V component) { return hn::IfThenElse(away, hn::Neg(component), component); };
  return {plus(plus(a, b), c),
          plus(reach, V3{widest, widest, widest}),
          {facing(normal.x), facing(normal.y), facing(normal.z)},
          w.b1,
          w.b2};
}

/// Writes a packet's points, lanes from `first` on, in the order of SurfacePoint's members: three times four doubles.
inline void write(const Points& p, const std::uint32_t* ids, unsigned sound, std::size_t first,
                  SurfacePoint* packet, std::size_t stride) {
  static_assert(offsetof(SurfacePoint, position) == 0 && offsetof(SurfacePoint, position_error) == 24 &&
                offsetof(SurfacePoint, normal) == 48 && offsetof(SurfacePoint, primitive) == 72 &&
                offsetof(SurfacePoint, barycentric) == 80 && sizeof(SurfacePoint) == 96 &&
                std::endian::native == std::endian::little);
  constexpr hn::RebindToUnsigned<D> u64;
  constexpr hn::Rebind<std::uint32_t, D> u32;
  constexpr hn::CappedTag<double, 4> four;
  alignas(64) double part[3][4 * 8];
  hn::StoreInterleaved4(p.position.x, p.position.y, p.position.z, p.error.x, d, part[0]);
  hn::StoreInterleaved4(p.error.y, p.error.z, p.normal.x, p.normal.y, d, part[1]);
  hn::StoreInterleaved4(p.normal.z, hn::BitCast(d, hn::PromoteTo(u64, hn::Load(u32, ids))), p.b1, p.b2, d,
                        part[2]);
  for (unsigned left = sound; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(left)), lane = first + i;
    auto* out = reinterpret_cast<double*>(packet + lane / 4 * stride + lane % 4);
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t j = 0; j < 4; j += hn::Lanes(four))
        hn::StoreU(hn::Load(four, part[k] + 4 * i + j), four, out + 4 * k + j);
  }
}

/// The same of a quantised tile, where one is asked for; others of its lanes may have been written already.
class Draft {
 public:
  explicit Draft(const ReceiverSinks& sinks) : tile_(sinks.quantised), draft_(sinks.draft) {
    for (int a = 0; a < 3; ++a) low_[a] = all(infinity), high_[a] = all(-infinity);
  }
  void put(const Points& p, const std::uint32_t* ids, unsigned sound, std::size_t lane) {
    if (tile_ == nullptr) return;
    constexpr hn::Rebind<float, D> half;
    constexpr hn::Rebind<std::uint32_t, D> u32;
    const M here = mask_of(sound);
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(sound)};
    const auto here_of_half = hn::LoadMaskBits(half, bytes);
    const auto put_along = [&](std::size_t axis, V position, V normal) {
      blend_into(d, draft_->position[axis] + lane, here, position);
      blend_into(half, tile_->normal[axis] + lane, here_of_half, hn::DemoteTo(half, normal));
      low_[axis] = hn::Min(low_[axis], hn::IfThenElse(here, position, low_[axis]));
      high_[axis] = hn::Max(high_[axis], hn::IfThenElse(here, position, high_[axis]));
    };
    put_along(0, p.position.x, p.normal.x);
    put_along(1, p.position.y, p.normal.y);
    put_along(2, p.position.z, p.normal.z);
    blend_into(u32, tile_->source + lane, hn::RebindMask(u32, here_of_half), hn::Load(u32, ids));
    tile_->present[lane / packet_rays] |= static_cast<std::uint16_t>(sound << (lane % packet_rays));
  }
  void finish() const {
    if (tile_ == nullptr) return;
    Aabb& bounds = draft_->bounds;
    for (int a = 0; a < 3; ++a) {
      bounds.min[a] = std::min(bounds.min[a], hn::GetLane(hn::MinOfLanes(d, low_[a])));
      bounds.max[a] = std::max(bounds.max[a], hn::GetLane(hn::MaxOfLanes(d, high_[a])));
    }
  }

 private:
  /// A masked store takes longer on some processors than all that is done here.
  template <class Tag, class Mask, class Vector, class T>
  static void blend_into(Tag tag, T* to, Mask here, Vector values) {
    hn::Store(hn::IfThenElse(here, values, hn::Load(tag, to)), tag, to);
  }

  QuantisedTile* tile_;
  TileDraft* draft_;
  V low_[3], high_[3];
};

inline SurfacePoint* packet_at(const ReceiverSinks& sinks, std::size_t packet) {
  return sinks.points + packet / 4 * 4 * sinks.stride + packet % 4 * 4;
}

/// What a packet's points are written to, also those of its background, on its way to the cache. Inlined by force: GCC
/// leaves out calls of functions that do nothing else.
HWY_INLINE void prefetch_points(const SurfacePoint* packet, std::size_t stride) {
  constexpr std::size_t line = 64;
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t at = 0; at < 4 * sizeof(SurfacePoint); at += line)
      __builtin_prefetch(reinterpret_cast<const char*>(packet + row * stride) + at, 1);
}

template <int axis>
LaneMask receivers_along(const Bvh& bvh, const View& view, int x0, int y0, const TileHits& hits,
                         const ReceiverSinks& sinks) {
  constexpr std::size_t ahead = 3;  // packets
  const PixelPlane pixels(view, x0, y0);
  const V3 origin = all(view.eye);
  Draft draft(sinks);
  HitTriangles triangles;
  LaneMask left{};
  for (std::size_t p = 0; p < ahead; ++p) prefetch(bvh, hits.leaf + p * packet_rays);
  for (std::size_t p = 0; p < tile_packets; ++p) {
    if (p + ahead < tile_packets) prefetch(bvh, hits.leaf + (p + ahead) * packet_rays);
    if (sinks.points != nullptr && p + 1 < tile_packets)
      prefetch_points(packet_at(sinks, p + 1), sinks.stride);
    unsigned done = 0;
    for (std::size_t i = 0; i < packet_rays; i += hn::Lanes(d)) {
      const std::size_t lane = p * packet_rays + i;
      const std::uint32_t* leaf = hits.leaf + lane;
      const unsigned known = on_triangles(bvh, leaf);
      if (known == 0) continue;
      triangles.load(bvh, leaf, known);
      const V3 direction = pixel_direction(view, hn::Load(d, pixels.x + lane), hn::Load(d, pixels.y + lane));
      const Weights weights = intersect<axis>(direction, origin, triangles.from.corner);
      const unsigned sound = bits_of(weights.sound) & known;
      if (sound == 0) continue;
      const Points points = points_of(direction, triangles, weights);
      draft.put(points, triangles.ids, sound, lane);
      if (sinks.points != nullptr) write(points, triangles.ids, sound, i, packet_at(sinks, p), sinks.stride);
      done |= sound << i;
    }
    left[p] = static_cast<std::uint16_t>(~done);
  }
  draft.finish();
  return left;
}

LaneMask receivers_kernel(const Bvh& bvh, const View& view, int x0, int y0, int axis, const TileHits& hits,
                          const ReceiverSinks& sinks) {
  switch (axis) {
    case 0:
      return receivers_along<0>(bvh, view, x0, y0, hits, sinks);
    case 1:
      return receivers_along<1>(bvh, view, x0, y0, hits, sinks);
    default:
      return receivers_along<2>(bvh, view, x0, y0, hits, sinks);
  }
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(receivers_kernel);

LaneMask store_receivers(const Bvh& bvh, const View& view, int x0, int y0, int axis, const TileHits& hits,
                         const ReceiverSinks& sinks) {
  return HWY_DYNAMIC_DISPATCH(receivers_kernel)(bvh, view, x0, y0, axis, hits, sinks);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
