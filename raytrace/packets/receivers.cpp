#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packets/receivers.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <bit>

#include "raytrace/packets/receivers.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;
using Index = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
constexpr D d;
constexpr Index index;

inline V all(double v) {
  return hn::Set(d, v);
}
inline V add(V a, V b) {
  return hn::Add(a, b);
}
inline V sub(V a, V b) {
  return hn::Sub(a, b);
}
inline V mul(V a, V b) {
  return hn::Mul(a, b);
}
inline unsigned bits_of(M mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return bytes[0];
}

struct V3 {
  V a[3];
  V operator[](std::size_t i) const { return a[i]; }
};
// The orders of glm's operations.
inline V dot(const V3& x, const V3& y) {
  return add(add(mul(x[0], y[0]), mul(x[1], y[1])), mul(x[2], y[2]));
}
inline V difference(V a, V b, V c, V e) {
  return sub(mul(a, b), mul(c, e));
}
inline V3 cross(const V3& x, const V3& y) {
  return {{difference(x[1], y[2], y[1], x[2]), difference(x[2], y[0], y[2], x[0]),
           difference(x[0], y[1], y[0], x[1])}};
}
inline V3 minus(const V3& x, const V3& y) {
  return {{sub(x[0], y[0]), sub(x[1], y[1]), sub(x[2], y[2])}};
}
inline V3 times(V s, const V3& x) {
  return {{mul(s, x[0]), mul(s, x[1]), mul(s, x[2])}};
}

/// scene/camera.cpp's pixel_ray.
inline V3 pixel_direction(const View& view, V sx, V sy) {
  V3 sum;
  for (int a = 0; a < 3; ++a)
    sum.a[a] = add(add(all(view.forward[a]), mul(sx, all(view.right[a]))), mul(sy, all(view.up[a])));
  return times(hn::Div(all(1.0), hn::Sqrt(dot(sum, sum))), sum);
}

struct Weights {
  V b1, b2;
  M sound;  ///< the scalar kernel would say the same
};

/// make_ray_frame, shear and finish_triangle for rays whose largest component is along k.
inline Weights intersect(const V3& direction, const V3& origin, const V3 (&corner)[3], std::size_t k) {
  const std::size_t kx = (k + 1) % 3, ky = (k + 2) % 3;
  const V largest = hn::Abs(direction[k]);
  const V shear_x = hn::Div(direction[kx], direction[k]), shear_y = hn::Div(direction[ky], direction[k]);
  const V shear_z = hn::Div(all(1.0), direction[k]);
  V x[3], y[3], z[3];
  for (std::size_t i = 0; i < 3; ++i) {
    z[i] = sub(corner[i][k], origin[k]);
    x[i] = sub(sub(corner[i][kx], origin[kx]), mul(shear_x, z[i]));
    y[i] = sub(sub(corner[i][ky], origin[ky]), mul(shear_y, z[i]));
  }
  const V u = difference(x[2], y[1], y[2], x[1]), v = difference(x[0], y[2], y[0], x[2]);
  const V w = difference(x[1], y[0], y[1], x[0]);
  const V det = add(add(u, v), w);
  const V depth = hn::Div(add(add(mul(u, z[0]), mul(v, z[1])), mul(w, z[2])), det);
  const V low = hn::Min(z[0], hn::Min(z[1], z[2])), high = hn::Max(z[0], hn::Max(z[1], z[2]));
  const V t = mul(hn::Min(hn::Max(depth, low), high), shear_z);
  const V zero = all(0.0), least = hn::Min(u, hn::Min(v, w)), most = hn::Max(u, hn::Max(v, w));
  const M inside = hn::Or(hn::Gt(least, zero), hn::Lt(most, zero));  // an edge function of zero: not here
  const M along = hn::And(hn::Gt(largest, hn::Max(hn::Abs(direction[kx]), hn::Abs(direction[ky]))),
                          hn::Lt(largest, all(1.0)));
  const M ahead = hn::And(hn::Gt(t, zero), hn::Lt(t, all(infinity)));
  return {hn::Div(v, det), hn::Div(w, det), hn::And(inside, hn::And(along, ahead))};
}

struct alignas(64) Rows {
  double value[11][8];
};

/// triangle_point and the normal on the side of the viewer, by rows: position, error, normal, weights.
inline void point_rows(const V3& direction, const V3 (&corner)[3], const Weights& w, Rows& rows) {
  const V b0 = sub(sub(all(1.0), w.b1), w.b2);
  const V3 a = times(b0, corner[0]), b = times(w.b1, corner[1]), c = times(w.b2, corner[2]);
  V3 extent, position, reach;
  for (std::size_t i = 0; i < 3; ++i) {
    extent.a[i] = sub(hn::Max(corner[0][i], hn::Max(corner[1][i], corner[2][i])),
                      hn::Min(corner[0][i], hn::Min(corner[1][i], corner[2][i])));
    position.a[i] = add(add(a[i], b[i]), c[i]);
    reach.a[i] = add(add(hn::Abs(a[i]), hn::Abs(b[i])), hn::Abs(c[i]));
  }
  const V widest = mul(all(error_gamma(24)), hn::Max(extent[0], hn::Max(extent[1], extent[2])));
  const V3 n = cross(minus(corner[1], corner[0]), minus(corner[2], corner[0]));
  const V length = hn::Sqrt(dot(n, n));
  V3 normal;
  for (std::size_t i = 0; i < 3; ++i) normal.a[i] = hn::Div(n[i], length);
  const M away = hn::Gt(dot(normal, direction), all(0.0));
  for (std::size_t i = 0; i < 3; ++i) {
    hn::Store(position[i], d, rows.value[i]);
    hn::Store(add(mul(all(error_gamma(7)), reach[i]), widest), d, rows.value[3 + i]);
    hn::Store(hn::IfThenElse(away, hn::Neg(normal[i]), normal[i]), d, rows.value[6 + i]);
  }
  hn::Store(w.b1, d, rows.value[9]), hn::Store(w.b2, d, rows.value[10]);
}

inline void write(const Rows& rows, std::size_t i, std::uint32_t primitive, SurfacePoint& out) {
  const auto& r = rows.value;
  out.position = {r[0][i], r[1][i], r[2][i]}, out.position_error = {r[3][i], r[4][i], r[5][i]};
  out.normal = {r[6][i], r[7][i], r[8][i]}, out.primitive = primitive, out.barycentric = {r[9][i], r[10][i]};
}

/// Least and greatest coordinates.
struct Reach {
  V low[3] = {all(infinity), all(infinity), all(infinity)};
  V high[3] = {all(-infinity), all(-infinity), all(-infinity)};
  void grow(Aabb& bounds) const {
    for (int a = 0; a < 3; ++a) {
      bounds.min[a] = std::min(bounds.min[a], hn::GetLane(hn::MinOfLanes(d, low[a])));
      bounds.max[a] = std::max(bounds.max[a], hn::GetLane(hn::MaxOfLanes(d, high[a])));
    }
  }
};

/// The same rows for a quantised tile; others of its lanes may have been written already.
inline void write_draft(const Rows& rows, unsigned sound, const std::uint32_t* leaf, const Bvh& bvh,
                        std::size_t lane, QuantisedTile& tile, TileDraft& draft, Reach& reach) {
  constexpr hn::Rebind<float, D> half;
  std::uint8_t bytes[8] = {static_cast<std::uint8_t>(sound)};
  const M here = hn::LoadMaskBits(d, bytes);
  tile.present[lane / packet_rays] |= static_cast<std::uint16_t>(sound << (lane % packet_rays));
  for (std::size_t a = 0; a < 3; ++a) {
    const V position = hn::Load(d, rows.value[a]);
    hn::BlendedStore(position, here, d, draft.position[a] + lane);
    reach.low[a] = hn::IfThenElse(here, hn::Min(reach.low[a], position), reach.low[a]);
    reach.high[a] = hn::IfThenElse(here, hn::Max(reach.high[a], position), reach.high[a]);
    const auto normal = hn::DemoteTo(half, hn::Load(d, rows.value[6 + a]));
    hn::BlendedStore(normal, hn::LoadMaskBits(half, bytes), half, tile.normal[a] + lane);
  }
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
    if ((sound >> i & 1) != 0) tile.source[lane + i] = bvh.id_at(leaf[i]);
  }
}

/// A packet's pixels on the plane at distance one.
inline void place_packet(const View& view, int x0, int y0, std::size_t packet, double* sx, double* sy) {
  const TilePixel corner = tile_pixel(packet * packet_rays);
  for (int i = 0; i < 4; ++i) {
    const double x = (2.0 * (x0 + corner.x + i + 0.5) / view.size.width - 1.0) * view.tan_half_x;
    const double y = (1.0 - 2.0 * (y0 + corner.y + i + 0.5) / view.size.height) * view.tan_half_y;
    for (int k = 0; k < 4; ++k) sx[4 * k + i] = x, sy[4 * i + k] = y;
  }
}

LaneMask receivers_kernel(const Bvh& bvh, const View& view, int x0, int y0, int axis, const TileHits& hits,
                          const ReceiverSinks& sinks) {
  alignas(64) double sx[packet_rays], sy[packet_rays];
  alignas(64) std::int64_t at[packet_rays];
  const V3 origin{{all(view.eye.x), all(view.eye.y), all(view.eye.z)}};
  LeafPrimitive placed[packet_rays]{};  // of instances
  const bool has_instances = !bvh.instances.empty();
  const double* corners = (has_instances ? placed : bvh.primitives.data())->v.data();
  const std::uint32_t count = bvh.leaf_count();
  LaneMask left{};
  Rows rows;
  Reach reach;
  for (std::size_t p = 0; p < tile_packets; ++p) {
    const std::uint32_t* leaf = hits.leaf + p * packet_rays;
    const std::size_t corner_pixel = (p / 4 * 4) * sinks.stride + p % 4 * 4;
    unsigned known = 0, done = 0;
    for (std::size_t i = 0; i < packet_rays; ++i) {
      const bool triangle = leaf[i] < count;
      known |= static_cast<unsigned>(triangle) << i;
      at[i] = triangle ? 9 * static_cast<std::int64_t>(has_instances ? i : leaf[i]) : 0;
      if (has_instances && triangle) {
        LeafPrimitive scratch;
        placed[i] = bvh.primitive_at(leaf[i], scratch);
      }
    }
    if (known != 0) place_packet(view, x0, y0, p, sx, sy);
    for (std::size_t i = 0; i < packet_rays; i += hn::Lanes(d)) {
      if ((known >> i & ((1u << hn::Lanes(d)) - 1)) == 0) continue;
      V3 corner[3];
      for (std::size_t c = 0; c < 9; ++c)
        corner[c / 3].a[c % 3] = hn::GatherIndex(d, corners + c, hn::Load(index, at + i));
      const std::size_t lane = p * packet_rays + i;
      const V3 direction = pixel_direction(view, hn::Load(d, sx + i), hn::Load(d, sy + i));
      const Weights w = intersect(direction, origin, corner, static_cast<std::size_t>(axis));
      const unsigned sound = bits_of(w.sound) & (known >> i);
      if (sound == 0) continue;
      point_rows(direction, corner, w, rows);
      if (sinks.quantised != nullptr)
        write_draft(rows, sound, leaf + i, bvh, lane, *sinks.quantised, *sinks.draft, reach);
      for (std::size_t j = 0; j < hn::Lanes(d) && sinks.points != nullptr; ++j)
        if ((sound >> j & 1) != 0)
          write(rows, j, bvh.id_at(leaf[i + j]),
                sinks.points[corner_pixel + (i + j) / 4 * sinks.stride + (i + j) % 4]);
      done |= sound << i;
    }
    left[p] = static_cast<std::uint16_t>(~done);
  }
  if (sinks.draft != nullptr) reach.grow(sinks.draft->bounds);
  return left;
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
