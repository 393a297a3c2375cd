#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packets/plane_receivers.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "raytrace/packets/double_lanes-inl.h"
#include "raytrace/packets/plane_receivers.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {
using namespace doubles;

struct alignas(64) PlaneRows {
  double position[3][8], error[3][8], away[8];
};

/// intersect_plane, plane_point and the side of the viewer; the bits of the rays that intersect the plane.
/// Those kernels scale the ray by a power of two, which changes no bit of a t that is far from overflow.
inline unsigned intersects_plane(const Plane& plane, const View& view, const V3& direction, PlaneRows& rows) {
  double height = 0.0;
  for (int a = 0; a < 3; ++a) height += plane.normal[a] * (plane.point[a] - view.eye[a]);
  const V3 normal = all(plane.normal), normal_size = all(glm::abs(plane.normal));
  const V slope = dot(normal, direction);
  const V t = hn::Div(all(height), slope);
  const M ahead = hn::And(hn::Gt(t, all(1e-200)), hn::Lt(t, all(1e200)));
  const V3 near = plus(all(view.eye), times(t, direction));
  const V above = dot(normal, minus(near, all(plane.point)));
  const V3 reach = plus(size_of(near), all(glm::abs(plane.point)));
  const V distance_error = hn::Mul(all(error_gamma(8)), dot(normal_size, reach));
  const V3 on_plane = minus(near, times(above, normal));
  const V3 error = plus(times(distance_error, normal_size), times(all(error_gamma(2)), size_of(on_plane)));
  store(on_plane, rows.position), store(error, rows.error);
  hn::Store(slope, d, rows.away);
  return bits_of(ahead);
}

LaneMask plane_receivers_kernel(const Structures& s, const View& view, const TileRect& rect,
                                const TileHits& hits, const LaneMask& asked, SurfacePoint* points) {
  LaneMask written{};
  PlaneRows rows;
  const PixelPlane pixels(view, rect.x0, rect.y0);
  for (std::size_t lane = 0; lane < tile_rays; lane += hn::Lanes(d)) {
    const std::size_t packet = lane / packet_rays, shift = lane % packet_rays;
    unsigned left = 0;
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
      const std::uint32_t leaf = hits.leaf[lane + i];
      const bool plane = leaf >= first_plane && leaf - first_plane < s.planes.size();
      left |= static_cast<unsigned>(plane) << i;
    }
    left &= static_cast<unsigned>(asked[packet]) >> shift;
    if (left == 0) continue;
    const V3 direction = pixel_direction(view, hn::Load(d, pixels.x + lane), hn::Load(d, pixels.y + lane));
    while (left != 0) {
      const std::uint32_t leaf = hits.leaf[lane + static_cast<std::size_t>(std::countr_zero(left))];
      unsigned same = 0;
      for (std::size_t i = 0; i < hn::Lanes(d); ++i)
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
  if (structures.planes.empty() || asked == LaneMask{}) return {};
  return HWY_DYNAMIC_DISPATCH(plane_receivers_kernel)(structures, view, rect, hits, asked, points);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
