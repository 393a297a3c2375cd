#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packets/receivers.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "raytrace/packets/hit_corners-inl.h"
#include "raytrace/packets/known_hit.h"
#include "raytrace/packets/plane_points-inl.h"
#include "raytrace/packets/receiver_writer-inl.h"

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

/// make_ray_frame, shear and finish_triangle for rays whose largest component is along k, but for the depth: a receiver
/// needs to know only that it is ahead. Not sound where that takes more than signs.
template <int k>
inline Weights intersect(const V3& direction, const V3& origin, const V3 (&corner)[3]) {
  constexpr int kx = (k + 1) % 3, ky = (k + 2) % 3;
  const V dx = along<kx>(direction), dy = along<ky>(direction), dz = along<k>(direction);
  const V shear_x = hn::Div(dx, dz), shear_y = hn::Div(dy, dz);
  const auto from_origin = [&](const V3& v) {
    const V z = hn::Sub(along<k>(v), along<k>(origin));
    const auto sheared = [&](V at, V from, V shear) { return hn::Sub(hn::Sub(at, from), hn::Mul(shear, z)); };
    return V3{sheared(along<kx>(v), along<kx>(origin), shear_x),
              sheared(along<ky>(v), along<ky>(origin), shear_y), z};
  };
  const V3 p = from_origin(corner[0]), q = from_origin(corner[1]), r = from_origin(corner[2]);
  const auto edge = [](const V3& a, const V3& b) { return hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x)); };
  const V u = edge(r, q), v = edge(p, r), w = edge(q, p);
  const V det = hn::Add(hn::Add(u, v), w), zero = all(0.0), largest = hn::Abs(dz);
  // An edge function of zero: not here.
  const M inside = hn::Or(hn::Gt(least_of(u, v, w), zero), hn::Lt(most_of(u, v, w), zero));
  const M longest = hn::And(hn::Gt(largest, hn::Max(hn::Abs(dx), hn::Abs(dy))), hn::Lt(largest, all(1.0)));
  // The depth is depth_det / det, far from where it would be rounded to zero or to infinity. Where it is ahead a corner is, so
  // that clamping it to the corners' own depths changes nothing here.
  const V depth_det = hn::Add(hn::Add(hn::Mul(u, p.z), hn::Mul(v, q.z)), hn::Mul(w, r.z));
  const V ahead_det = hn::Mul(depth_det, hn::CopySign(all(1.0), hn::Mul(det, dz)));
  const V size = hn::Abs(det);
  const M ahead = hn::And(hn::Gt(ahead_det, hn::Mul(size, all(0x1p-500))),
                          hn::Lt(ahead_det, hn::Mul(size, all(0x1p500))));
  return {hn::Div(v, det), hn::Div(w, det), hn::And(inside, hn::And(longest, ahead))};
}

/// What the pixels' triangles are, whichever rays hit them.
struct HitTriangles {
  HitCorners from;
  V3 normal = all(Vec3(0.0));   ///< unit, on the side of the corners' order
  V position_error = all(0.0);  ///< the part that comes of their size

  void load(const Bvh& bvh, const std::uint32_t* leaf, unsigned known) {
    if (!from.load(bvh, leaf, known)) return;
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

/// triangle_point and the normal on the side of the viewer.
inline Points points_of(const V3& direction, const HitTriangles& triangles, const Weights& w) {
  const V3(&corner)[3] = triangles.from.corner;
  const V b0 = hn::Sub(hn::Sub(all(1.0), w.b1), w.b2);
  const V3 a = times(b0, corner[0]), b = times(w.b1, corner[1]), c = times(w.b2, corner[2]);
  const V widest = triangles.position_error;
  const V3 reach = times(all(error_gamma(7)), plus(plus(size_of(a), size_of(b)), size_of(c)));
  const V3& normal = triangles.normal;
  const M away = hn::Gt(dot(normal, direction), all(0.0));
  return {plus(plus(a, b), c), plus(reach, V3{widest, widest, widest}), facing(normal, away), w.b1, w.b2,
          triangles.from.ids()};
}

/// A packet's. All of them are found before the first receiver, so that their long chains of operations overlap.
class PacketDirections {
 public:
  void set(const View& view, const PixelPlane& pixels, std::size_t packet) {
    for (std::size_t i = 0; i < packet_rays; i += hn::Lanes(d)) {
      const std::size_t lane = packet * packet_rays + i;
      const V3 ray = pixel_direction(view, pixels.x(lane), pixels.y(lane));
      hn::Store(ray.x, d, along_[0] + i), hn::Store(ray.y, d, along_[1] + i),
          hn::Store(ray.z, d, along_[2] + i);
    }
  }
  V3 at(std::size_t i) const {
    return {hn::Load(d, along_[0] + i), hn::Load(d, along_[1] + i), hn::Load(d, along_[2] + i)};
  }

 private:
  alignas(64) double along_[3][packet_rays];
};

inline bool shows_nothing(const std::uint32_t* leaf) {
  constexpr hn::CappedTag<std::uint32_t, packet_rays> ids;
  bool nothing = true;
  for (std::size_t i = 0; i < packet_rays; i += hn::Lanes(ids))
    nothing &= hn::AllTrue(ids, hn::Eq(hn::Load(ids, leaf + i), hn::Set(ids, nothing_hit)));
  return nothing;
}

/// Holds the lanes of a packet that show triangles, and those that show planes.
struct PacketLanes {
  unsigned triangles = 0, planes = 0;
  PacketLanes(const Bvh& bvh, const PlanesSeen& seen, const std::uint32_t* leaf) {
    for (std::size_t i = 0; i < packet_rays; i += hn::Lanes(d))
      triangles |= on_triangles(bvh, leaf + i) << i, planes |= seen.lanes(leaf + i) << i;
  }
};

template <int axis>
LaneMask receivers_along(const Structures& s, const View& view, int x0, int y0, const TileHits& hits,
                         const ReceiverSinks& sinks) {
  constexpr std::size_t ahead = 3;  // packets
  constexpr unsigned together = (1u << hn::MaxLanes(d)) - 1;
  const PixelPlane pixels(view, x0, y0);
  const V3 origin = all(view.eye);
  const PlanesSeen planes(s);
  ReceiverWriter writer(sinks);
  HitTriangles triangles;
  PacketDirections directions;
  LaneMask left{};
  for (std::size_t p = 0; p < ahead; ++p) prefetch(s.bvh, hits.leaf + p * packet_rays);
  for (std::size_t p = 0; p < tile_packets; ++p) {
    const std::uint32_t* leaf = hits.leaf + p * packet_rays;
    if (p + ahead < tile_packets) prefetch(s.bvh, leaf + ahead * packet_rays);
    if (sinks.non_temporal && shows_nothing(leaf)) {
      writer.store_nothing(p);
      continue;
    }
    const PacketLanes shown(s.bvh, planes, leaf);
    unsigned done = 0;
    if ((shown.triangles | shown.planes) != 0) directions.set(view, pixels, p);
    for (std::size_t i = 0; i < packet_rays; i += hn::Lanes(d)) {
      const std::size_t lane = p * packet_rays + i;
      if (const unsigned known = shown.triangles >> i & together; known != 0) {
        triangles.load(s.bvh, leaf + i, known);
        const V3 direction = directions.at(i);
        const Weights weights = intersect<axis>(direction, origin, triangles.from.corner);
        const unsigned sound = bits_of(weights.sound) & known;
        if (sound != 0) writer.put(points_of(direction, triangles, weights), sound, lane);
        done |= sound << i;
      }
      if (const unsigned known = shown.planes >> i & together; known != 0)
        done |= planes.put(view, directions.at(i), leaf + i, known, lane, writer) << i;
    }
    left[p] = static_cast<std::uint16_t>(~done);
  }
  writer.finish();
  return left;
}

LaneMask receivers_kernel(const Structures& s, const View& view, int x0, int y0, int axis,
                          const TileHits& hits, const ReceiverSinks& sinks) {
  switch (axis) {
    case 0:
      return receivers_along<0>(s, view, x0, y0, hits, sinks);
    case 1:
      return receivers_along<1>(s, view, x0, y0, hits, sinks);
    default:
      return receivers_along<2>(s, view, x0, y0, hits, sinks);
  }
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(receivers_kernel);

LaneMask store_receivers(const Structures& s, const View& view, const TileRect& rect, const TileHits& hits,
                         const ReceiverSinks& sinks) {
  return HWY_DYNAMIC_DISPATCH(receivers_kernel)(s, view, rect.x0, rect.y0, axis_of(view, rect), hits, sinks);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
