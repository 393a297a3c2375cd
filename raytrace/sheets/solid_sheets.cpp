#include "raytrace/sheets/column_sheets.h"

#include <algorithm>

#include "raytrace/precision/error_bounds.h"
#include "raytrace/shapes/along_ray.h"
#include "raytrace/shapes/solid.h"

namespace gnomon::raytrace {

bool hang_together(const ShapeGeometry& solid, const Vec3& a, const Vec3& b, const Vec3& direction_a,
                   const Vec3& direction_b) {
  if (is_convex(solid)) return true;
  constexpr int pieces = 8;
  const ShapeFrame& frame = frame_of(solid);
  const Vec3 p = to_local(frame, a), step = to_local(frame, b) - p;
  const Vec3 d = glm::transpose(frame.axes) * direction_a, e = glm::transpose(frame.axes) * direction_b;
  const double length = glm::length(step), rounding = error_gamma(64) * local_box(solid).diagonal();
  const auto bounds = [&](const Bounds& along, const Bounds& depth) {
    const auto at = [&](int k) {
      const Bounds direction(std::min(d[k], e[k]), std::max(d[k], e[k]));
      return Slope(Bounds(p[k]) + along * Bounds(step[k]) + depth * direction, direction);
    };
    return body_slope(solid, at(0), at(1), at(2));
  };
  // Over every place between the two, from a depth before the chord to one behind it, the rays intersect the
  // surface once: then it is one piece.
  const auto proven = [&](double reach) {
    for (int i = 0; i < pieces; ++i) {
      const Bounds along(i / double(pieces), (i + 1) / double(pieces));
      const Bounds before = bounds(along, Bounds(-reach)).value, behind = bounds(along, Bounds(reach)).value;
      const Slope whole = bounds(along, Bounds(-reach, reach));
      const bool crosses =
          (before.positive() && behind.negative()) || (before.negative() && behind.positive());
      if (!(crosses && whole.value.sure && whole.change.without_zero())) return false;
    }
    return true;
  };
  for (const double share : {0.125, 0.5, 2.0})
    if (proven(share * length + rounding)) return true;
  return false;
}

}  // namespace gnomon::raytrace
