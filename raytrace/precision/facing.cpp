#include "raytrace/precision/facing.h"

#include "raytrace/precision/error_bounds.h"
#include "raytrace/precision/exact.h"

namespace gnomon::raytrace {

bool is_back(const World& world, const Vec3& direction, std::uint32_t triangle) {
  const auto [a, b, c] = world.corners(triangle);
  return side_of_edge(a, direction, b, c) > 0;
}

Facing facing_of(const double* v, const Vec3& eye) {
  const Vec3 a(v[0], v[1], v[2]);
  const Vec3 d = a - eye, p = Vec3(v[3], v[4], v[5]) - a, q = Vec3(v[6], v[7], v[8]) - a;
  const double det = glm::dot(d, glm::cross(p, q));
  const Vec3 e = glm::abs(d), m = glm::abs(p), n = glm::abs(q);
  const double permanent =
      e.x * (m.y * n.z + m.z * n.y) + e.y * (m.z * n.x + m.x * n.z) + e.z * (m.x * n.y + m.y * n.x);
  // Roundings of a term: three differences, two products, the cross product's difference, two sums. What underflows
  // is far below the second bound.
  if (!(std::abs(det) > error_gamma(12) * permanent && permanent > 1e-270)) return Facing::ambiguous;
  return det > 0.0 ? Facing::back : Facing::front;
}

}  // namespace gnomon::raytrace
