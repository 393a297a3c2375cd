#include "raytrace/precision/exact.h"

#include "raytrace/precision/dyadic.h"

namespace gnomon::raytrace {
namespace {

// Below it products may have lost bits to underflow, and the filter's bound does not hold.
constexpr double least_permanent = 1e-270;

[[gnu::noinline, gnu::cold]] int exact_side(const Vec3& origin, const Vec3& direction, const Vec3& a,
                                            const Vec3& b) {
  const Dyadic3 o(origin);
  return dot(Dyadic3(direction), cross(Dyadic3(a) - o, Dyadic3(b) - o)).sign();
}

struct PlaneIntersection {
  Dyadic height, slope;  ///< t = height / slope
};
PlaneIntersection intersection_with_plane(const Vec3& origin, const Vec3& direction,
                                          const std::array<Vec3, 3>& c) {
  const Dyadic3 a(c[0]), normal = cross(Dyadic3(c[1]) - a, Dyadic3(c[2]) - a);
  return {dot(normal, a - Dyadic3(origin)), dot(normal, Dyadic3(direction))};
}

std::array<Vec3, 3> corners_of(const LeafPrimitive& triangle) {
  return {triangle.corner(0), triangle.corner(1), triangle.corner(2)};
}
Vec3 vector_of(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

/// Where a line in a triangle's plane, but for rounding, passes over the triangle; nothing: beside it. Both are looked at
/// along the axis that is the nearest to the normal. A corner within rounding of the line lies on it.
std::optional<Interval> stretch_along(const Vec3& origin, const Vec3& direction,
                                      const std::array<Vec3, 3>& corners) {
  const Vec3 n = glm::abs(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  const int z = n.x >= n.y ? (n.x >= n.z ? 0 : 2) : (n.y >= n.z ? 1 : 2), x = (z + 1) % 3, y = (z + 2) % 3;
  const Vec2 d(direction[x], direction[y]);
  std::array<double, 3> t, side;
  Interval out{infinity, -infinity};
  const auto add = [&](double at) { out = {std::min(out.min, at), std::max(out.max, at)}; };
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec2 c(corners[i][x] - origin[x], corners[i][y] - origin[y]);
    t[i] = glm::dot(c, d) / glm::dot(d, d), side[i] = d.x * c.y - d.y * c.x;
    if (std::abs(side[i]) <= 0x1p-46 * (std::abs(c.x) + std::abs(c.y))) side[i] = 0.0, add(t[i]);
  }
  for (std::size_t i = 0, k = 2; i < 3; k = i++)
    if (side[i] * side[k] < 0.0) add(t[i] + (t[k] - t[i]) * (side[i] / (side[i] - side[k])));
  if (!(out.min <= out.max)) return std::nullopt;
  return out;
}

/// An edge is within rounding of a corner's distance, as where one corner lies at 1e30: no side of the triangle says where
/// a ray passes it.
bool is_needle(const std::array<Vec3, 3>& c) {
  const std::array<double, 3> edge{glm::distance(c[0], c[1]), glm::distance(c[1], c[2]),
                                   glm::distance(c[2], c[0])};
  const auto [least, most] = std::minmax({edge[0], edge[1], edge[2]});
  return least < 0x1p-40 * most;
}

}  // namespace

int side_of_edge(const Vec3& origin, const Vec3& direction, const Vec3& a, const Vec3& b) {
  const Vec3 p = a - origin, q = b - origin;
  const double det = glm::dot(direction, glm::cross(p, q));
  const Vec3 d = glm::abs(direction), m = glm::abs(p), n = glm::abs(q);
  const double permanent =
      d.x * (m.y * n.z + m.z * n.y) + d.y * (m.z * n.x + m.x * n.z) + d.z * (m.x * n.y + m.y * n.x);
  // Roundings of a term: two differences, two products, the cross product's difference, two sums.
  if (std::abs(det) > error_gamma(10) * permanent && permanent > least_permanent) return det > 0.0 ? 1 : -1;
  return exact_side(origin, direction, a, b);
}

bool line_intersects(const Vec3& origin, const Vec3& direction, const std::array<Vec3, 3>& c) {
  const int u = side_of_edge(origin, direction, c[1], c[2]), v = side_of_edge(origin, direction, c[2], c[0]);
  if (u * v < 0) return false;
  const int w = side_of_edge(origin, direction, c[0], c[1]);
  if (u * w < 0 || v * w < 0) return false;
  return u != 0 || v != 0 || w != 0;  // all zero: the line lies in the plane
}

int compare_t(const Vec3& origin, const Vec3& direction, const std::array<Vec3, 3>& c, double bound) {
  if (std::isinf(bound)) return bound > 0.0 ? -1 : 1;
  const PlaneIntersection m = intersection_with_plane(origin, direction, c);
  return (m.height - Dyadic(bound) * m.slope).sign() * m.slope.sign();
}

bool starts_before(const RayFrame& ray, const LeafPrimitive& triangle) {
  return compare_t(vector_of(ray.origin), vector_of(ray.direction), corners_of(triangle), 0.0) > 0;
}

bool finish_edge_on(const RayFrame& ray, const LeafPrimitive& triangle, TriangleHit& hit) {
  const Vec3 origin = vector_of(ray.origin), direction = vector_of(ray.direction);
  const std::array<Vec3, 3> corners = corners_of(triangle);
  if (is_needle(corners)) return true;
  const PlaneIntersection m = intersection_with_plane(origin, direction, corners);
  if (m.slope.sign() == 0) return false;
  const std::optional<Interval> along = stretch_along(origin, direction, corners);
  if (along) hit.t = std::clamp(quotient(m.height, m.slope), along->min, along->max);
  return along.has_value();
}

int compare_order(const Vec3& origin, const Vec3& direction, const std::array<Vec3, 3>& a,
                  const std::array<Vec3, 3>& b) {
  const PlaneIntersection m = intersection_with_plane(origin, direction, a),
                          n = intersection_with_plane(origin, direction, b);
  return (m.height * n.slope - n.height * m.slope).sign() * m.slope.sign() * n.slope.sign();
}

double exact_t(const Vec3& origin, const Vec3& direction, const std::array<Vec3, 3>& c) {
  const PlaneIntersection m = intersection_with_plane(origin, direction, c);
  return quotient(m.height, m.slope);
}

bool ExactArithmetic::leaf(const Structures& s, const RayFrame& ray, std::uint32_t index, Hit& hit) const {
  const std::uint32_t id = s.bvh.id_at(index);
  if (s.has_shapes && !s.world->is_triangle(id)) return intersect_leaf(s, ray, index, hit);
  hit.primitive = id;
  return triangle(ray, leaf_at(s, index), hit);
}

std::optional<ExactArithmetic::Intersection> ExactArithmetic::intersect(const RayFrame& ray,
                                                                        const LeafPrimitive& triangle) {
  const ShearedTriangle s = shear(ray, triangle);
  double size = 0.0, reach = 0.0;
  for (std::size_t i = 0; i < 9; ++i) reach = std::max(reach, std::abs(triangle.v[i] - ray.origin[i % 3]));
  // A sheared coordinate is the difference of two lengths within reach and has six roundings. DBL_MIN, here
  // and in the bound, is far more than underflow takes away.
  const double error = 2.0 * error_gamma(6) * reach + DBL_MIN;
  for (std::size_t i = 0; i < 3; ++i) size += std::abs(s.x[i]) + std::abs(s.y[i]);
  const double bound = 2.0 * error * (size + error) + DBL_MIN;
  const double low = std::min({s.u, s.v, s.w}), high = std::max({s.u, s.v, s.w});
  if (low < -bound && high > bound) return std::nullopt;
  const Vec3 origin = vector_of(ray.origin), direction = vector_of(ray.direction);
  const std::array<Vec3, 3> corners = corners_of(triangle);
  const bool sure = low > bound || high < -bound;
  if (!sure && !line_intersects(origin, direction, corners)) return std::nullopt;
  TriangleHit t{};
  const double det = s.u + s.v + s.w, det_error = 4.0 * bound;
  if (!finish_triangle(ray, triangle, s, t) || std::abs(det) < 4.0 * det_error) {
    t.t = exact_t(origin, direction, corners);
    if (!(det != 0.0)) t.b1 = t.b2 = 1.0 / 3.0;  // edge-on: any point of it
  }
  t.b1 = std::clamp(t.b1, 0.0, 1.0), t.b2 = std::clamp(t.b2, 0.0, 1.0 - t.b1);
  // t is a mean of the corners' depths with weights known within det_error.
  const double z_size = std::max({std::abs(s.z[0]), std::abs(s.z[1]), std::abs(s.z[2])});
  const double spread = (2.0 * det_error / std::max(std::abs(det) - det_error, DBL_MIN) + error_gamma(16)) *
                        2.0 * z_size * std::abs(ray.shear_z);
  return Intersection{corners, Vec2(t.b1, t.b2), t.t, spread};
}

bool ExactArithmetic::triangle(const RayFrame& ray, const LeafPrimitive& triangle, Hit& hit) const {
  std::optional<Intersection> found = intersect(ray, triangle);
  if (!found) return false;
  const Vec3 origin = vector_of(ray.origin), direction = vector_of(ray.direction);
  const auto order = [&](double end) {
    if (std::abs(found->t - end) > found->spread) return found->t < end ? -1 : 1;
    return compare_t(origin, direction, found->corners, end);
  };
  if (order(given_.min) <= 0 || order(given_.max) >= 0 || !comes_first(ray, *found)) return false;
  hit.barycentric = found->barycentric, hit.t = found->t;
  found_ = *found, found_id_ = hit.primitive;
  return true;
}

double ExactArithmetic::own_t(const Structures& s, const RayFrame& ray, const Hit& hit) const {
  if (!moved_ || !s.world->is_triangle(hit.primitive)) return hit.t;
  const std::optional<Intersection> found = intersect(ray, leaf_primitive(*s.world, hit.primitive));
  return found ? found->t : hit.t;
}

// Before the nearest hit so far, whose rounded t the ray's interval ends just above; of equals the caller
// takes the lower id. Where rounding leaves the order open it is worked out exactly, and the candidate gets
// a t on the right side of the other's.
bool ExactArithmetic::comes_first(const RayFrame& ray, Intersection& candidate) const {
  const double end = ray.t.max;
  if (!(end < given_.max)) return true;
  const bool known = next_above(taken_.t) == end;
  if (std::abs(candidate.t - end) > candidate.spread + (known ? taken_.spread : 0.0))
    return candidate.t < end;
  const Vec3 origin = vector_of(ray.origin), direction = vector_of(ray.direction);
  const double nearest = std::nextafter(end, -infinity);
  const int order = known ? compare_order(origin, direction, candidate.corners, taken_.corners)
                          : compare_t(origin, direction, candidate.corners, nearest);
  if (order > 0) return false;
  const double given = candidate.t;
  candidate.t = order == 0 ? nearest : std::min(given, std::nextafter(nearest, -infinity));
  candidate.spread += std::abs(given - candidate.t);
  moved_ = moved_ || given != candidate.t;
  return true;
}

}  // namespace gnomon::raytrace
