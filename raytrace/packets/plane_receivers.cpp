#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packets/plane_receivers.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "raytrace/packets/plane_receivers.h"
#include "raytrace/packets/tile.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::CappedTag<double, 8>;
using Several = hn::Vec<Doubles>;
constexpr Doubles eight;

struct PlaneVector {
  Several a[3];
};

// In the order of glm's operations.
inline Several plane_dot(const Vec3& x, const PlaneVector& y) {
  return hn::Add(hn::Add(hn::Mul(hn::Set(eight, x.x), y.a[0]), hn::Mul(hn::Set(eight, x.y), y.a[1])),
                 hn::Mul(hn::Set(eight, x.z), y.a[2]));
}

/// scene/camera.cpp's pixel_ray.
inline PlaneVector plane_direction(const View& view, Several sx, Several sy) {
  PlaneVector sum;
  for (int a = 0; a < 3; ++a)
    sum.a[a] = hn::Add(hn::Add(hn::Set(eight, view.forward[a]), hn::Mul(sx, hn::Set(eight, view.right[a]))),
                       hn::Mul(sy, hn::Set(eight, view.up[a])));
  const Several squared =
      hn::Add(hn::Add(hn::Mul(sum.a[0], sum.a[0]), hn::Mul(sum.a[1], sum.a[1])), hn::Mul(sum.a[2], sum.a[2]));
  const Several scale = hn::Div(hn::Set(eight, 1.0), hn::Sqrt(squared));
  for (Several& v : sum.a) v = hn::Mul(scale, v);
  return sum;
}

struct alignas(64) PlaneRows {
  double position[3][8], error[3][8], away[8];
};

/// intersect_plane, plane_point and the side of the viewer; the bits of the rays that intersect the plane.
/// Those kernels scale the ray by a power of two, which changes no bit of a t that is far from overflow.
inline unsigned intersects_plane(const Plane& plane, const View& view, const PlaneVector& direction,
                                 PlaneRows& rows) {
  double height = 0.0;
  for (int a = 0; a < 3; ++a) height += plane.normal[a] * (plane.point[a] - view.eye[a]);
  const Several slope = plane_dot(plane.normal, direction);
  const Several t = hn::Div(hn::Set(eight, height), slope);
  const auto ahead = hn::And(hn::Gt(t, hn::Set(eight, 1e-200)), hn::Lt(t, hn::Set(eight, 1e200)));
  PlaneVector near, offset, reach;
  const Vec3 normal_size = glm::abs(plane.normal), point_size = glm::abs(plane.point);
  for (int a = 0; a < 3; ++a) {
    near.a[a] = hn::Add(hn::Set(eight, view.eye[a]), hn::Mul(t, direction.a[a]));
    offset.a[a] = hn::Sub(near.a[a], hn::Set(eight, plane.point[a]));
    reach.a[a] = hn::Add(hn::Abs(near.a[a]), hn::Set(eight, point_size[a]));
  }
  const Several above = plane_dot(plane.normal, offset);
  const Several distance_error = hn::Mul(hn::Set(eight, error_gamma(8)), plane_dot(normal_size, reach));
  for (int a = 0; a < 3; ++a) {
    const Several on_plane = hn::Sub(near.a[a], hn::Mul(above, hn::Set(eight, plane.normal[a])));
    hn::Store(on_plane, eight, rows.position[a]);
    hn::Store(hn::Add(hn::Mul(distance_error, hn::Set(eight, normal_size[a])),
                      hn::Mul(hn::Set(eight, error_gamma(2)), hn::Abs(on_plane))),
              eight, rows.error[a]);
  }
  hn::Store(slope, eight, rows.away);
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(eight, ahead, bytes);
  return bytes[0];
}

LaneMask plane_receivers_kernel(const Structures& s, const View& view, const TileRect& rect,
                                const TileHits& hits, const LaneMask& asked, SurfacePoint* points) {
  LaneMask written{};
  PlaneRows rows;
  alignas(64) double sx[8], sy[8];
  for (std::size_t lane = 0; lane < tile_rays; lane += hn::Lanes(eight)) {
    const std::size_t packet = lane / packet_rays, shift = lane % packet_rays;
    unsigned left = 0;
    for (std::size_t i = 0; i < hn::Lanes(eight); ++i) {
      const std::uint32_t leaf = hits.leaf[lane + i];
      const bool plane = leaf >= first_plane && leaf - first_plane < s.planes.size();
      left |= static_cast<unsigned>(plane) << i;
    }
    left &= static_cast<unsigned>(asked[packet]) >> shift;
    if (left == 0) continue;
    for (std::size_t i = 0; i < hn::Lanes(eight); ++i) {
      const TilePixel place = tile_pixel(lane + i);
      sx[i] = (2.0 * (rect.x0 + place.x + 0.5) / view.size.width - 1.0) * view.tan_half_x;
      sy[i] = (1.0 - 2.0 * (rect.y0 + place.y + 0.5) / view.size.height) * view.tan_half_y;
    }
    const PlaneVector direction = plane_direction(view, hn::Load(eight, sx), hn::Load(eight, sy));
    while (left != 0) {
      const std::uint32_t leaf = hits.leaf[lane + static_cast<std::size_t>(std::countr_zero(left))];
      unsigned same = 0;
      for (std::size_t i = 0; i < hn::Lanes(eight); ++i)
        same |= static_cast<unsigned>(hits.leaf[lane + i] == leaf) << i;
      same &= left, left &= ~same;
      const std::uint32_t id = s.planes[leaf - first_plane];
      const Plane& plane = std::get<Plane>(s.world->shape(id).geometry);
      const unsigned hit = intersects_plane(plane, view, direction, rows) & same;
      for (unsigned bits = hit; bits != 0; bits &= bits - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(bits));
        const TilePixel place = tile_pixel(lane + i);
        SurfacePoint& out = points[16 * place.y + place.x];
        out.position = {rows.position[0][i], rows.position[1][i], rows.position[2][i]};
        out.position_error = {rows.error[0][i], rows.error[1][i], rows.error[2][i]};
        out.normal = rows.away[i] > 0.0 ? -plane.normal : plane.normal;
        out.primitive = id, out.barycentric = Vec2(0.0);
      }
      written[packet] |= static_cast<std::uint16_t>(hit << shift);
    }
  }
  return written;
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(plane_receivers_kernel);

LaneMask find_plane_receivers(const Structures& structures, const View& view, const TileRect& rect,
                              const TileHits& hits, const LaneMask& asked, SurfacePoint* points) {
  if (structures.planes.empty()) return {};
  return HWY_DYNAMIC_DISPATCH(plane_receivers_kernel)(structures, view, rect, hits, asked, points);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
