// Receivers on infinite planes: the double kernels of raytrace/shapes/intersect.h and raytrace/precision/ray_offset.h,
// operation for operation, several pixels at a time.

#if defined(GNOMON_RAYTRACE_PACKETS_PLANE_POINTS_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_PLANE_POINTS_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_PLANE_POINTS_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_PLANE_POINTS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "raytrace/kernels.h"
#include "raytrace/packets/receiver_writer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE::doubles {

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
  return {{on_plane, error, facing(normal, away), all(0.0), all(0.0), hn::Set(Ids(), id)},
          hn::And(hn::Gt(t, all(1e-200)), hn::Lt(t, all(1e200)))};
}

/// Holds the planes that as many pixels see as there are lanes.
class PlanesSeen {
 public:
  explicit PlanesSeen(const Structures& s) : s_(s) {}

  /// Bits of those that see one.
  unsigned lanes(const std::uint32_t* leaf) const {
    const auto first = hn::Set(ids, first_plane);
    const auto count = hn::Set(ids, static_cast<std::uint32_t>(s_.planes.size()));
    return mask_bits(
        ids, hn::Lt(hn::Sub(hn::Load(ids, leaf), first), count));  // what is no plane wraps round to more
  }
  /// Writes the receivers of the `asked`, which see planes; returns those that are sure.
  unsigned put(const View& view, const V3& direction, const std::uint32_t* leaf, unsigned asked,
               std::size_t lane, ReceiverWriter& writer) const {
    unsigned done = 0;
    for (unsigned left = asked; left != 0;) {
      const std::uint32_t one = leaf[std::countr_zero(left)];
      const unsigned same = mask_bits(ids, hn::Eq(hn::Load(ids, leaf), hn::Set(ids, one))) & left;
      left &= ~same;
      const std::uint32_t id = s_.planes[one - first_plane];
      const auto found = points_on(std::get<Plane>(s_.world->shape(id).geometry), id, view, direction);
      const unsigned sure = bits_of(found.ahead) & same;
      if (sure != 0) writer.put(found.points, sure, lane);
      done |= sure;
    }
    return done;
  }

 private:
  static constexpr Ids ids{};
  const Structures& s_;
};

}  // namespace gnomon::raytrace::HWY_NAMESPACE::doubles
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
