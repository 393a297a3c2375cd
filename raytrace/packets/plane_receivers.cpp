#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packets/plane_receivers.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "raytrace/kernels.h"
#include "raytrace/packets/plane_receivers.h"
#include "raytrace/packets/receiver_writer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {
using namespace doubles;
using Leaf = hn::Rebind<std::uint32_t, D>;
constexpr Leaf leaves;

struct PlanePoints {
  Points points;
  M ahead;  ///< where the rays intersect the plane
};

/// intersect_plane, plane_point and the side of the viewer. Those kernels scale the ray by a power of two, which changes no
/// bit of a t that is far from overflow.
inline PlanePoints points_on(const Plane& plane, std::uint32_t id, const View& view, const V3& direction) {
  double height = 0.0;
  for (int a = 0; a < 3; ++a) height += plane.normal[a] * (plane.point[a] - view.eye[a]);
  const V3 normal = all(plane.normal), normal_size = all(glm::abs(plane.normal));
  const V slope = dot(normal, direction);
  const V t = hn::Div(all(height), slope);
  const V3 near = plus(all(view.eye), times(t, direction));
  const V above = dot(normal, minus(near, all(plane.point)));
  const V3 reach = plus(size_of(near), all(glm::abs(plane.point)));
  const V distance_error = hn::Mul(all(error_gamma(8)), dot(normal_size, reach));
  const V3 on_plane = minus(near, times(above, normal));
  const V3 error = plus(times(distance_error, normal_size), times(all(error_gamma(2)), size_of(on_plane)));
  const M away = hn::Gt(slope, all(0.0));
  PlanePoints found{{on_plane, error, facing(normal, away), all(0.0), all(0.0), {}},
                    hn::And(hn::Gt(t, all(1e-200)), hn::Lt(t, all(1e200)))};
  std::fill_n(found.points.ids, 8, id);
  return found;
}

LaneMask plane_receivers_kernel(const Structures& s, const View& view, const TileRect& rect,
                                const TileHits& hits, const LaneMask& asked, const ReceiverSinks& sinks) {
  LaneMask still = asked;
  const PixelPlane pixels(view, rect.x0, rect.y0);
  ReceiverWriter writer(sinks);
  const auto first = hn::Set(leaves, first_plane);
  const auto count = hn::Set(leaves, static_cast<std::uint32_t>(s.planes.size()));
  for (std::size_t lane = 0; lane < tile_rays; lane += hn::Lanes(d)) {
    const std::size_t packet = lane / packet_rays, shift = lane % packet_rays;
    const auto leaf = hn::Load(leaves, hits.leaf + lane);
    const auto on_plane = hn::Lt(hn::Sub(leaf, first), count);  // what is no plane wraps round to more
    unsigned left = mask_bits(leaves, on_plane) & static_cast<unsigned>(asked[packet]) >> shift;
    if (left == 0) continue;
    const V3 direction = pixel_direction(view, hn::Load(d, pixels.x + lane), hn::Load(d, pixels.y + lane));
    while (left != 0) {
      const std::uint32_t one = hits.leaf[lane + static_cast<std::size_t>(std::countr_zero(left))];
      const unsigned same = mask_bits(leaves, hn::Eq(leaf, hn::Set(leaves, one))) & left;
      left &= ~same;
      const std::uint32_t id = s.planes[one - first_plane];
      const auto found = points_on(std::get<Plane>(s.world->shape(id).geometry), id, view, direction);
      const unsigned hit = bits_of(found.ahead) & same;
      if (hit == 0) continue;
      writer.put(found.points, hit, lane);
      still[packet] &= static_cast<std::uint16_t>(~(hit << shift));
    }
  }
  writer.finish();
  return still;
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(plane_receivers_kernel);

LaneMask store_plane_receivers(const Structures& structures, const View& view, const TileRect& rect,
                               const TileHits& hits, const LaneMask& asked, const ReceiverSinks& sinks) {
  return HWY_DYNAMIC_DISPATCH(plane_receivers_kernel)(structures, view, rect, hits, asked, sinks);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
