#include "verify/rational.h"

#include <gmpxx.h>

#include <algorithm>

#include "scene/shapes/solid.h"

namespace gnomon::verify {

namespace {

struct Rational3 {
  mpq_class x, y, z;
  explicit Rational3(const Vec3& v) : x(v.x), y(v.y), z(v.z) {}
  Rational3(mpq_class a, mpq_class b, mpq_class c) : x(std::move(a)), y(std::move(b)), z(std::move(c)) {}
};
Rational3 operator-(const Rational3& a, const Rational3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
mpq_class dot(const Rational3& a, const Rational3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Rational3 cross(const Rational3& a, const Rational3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct Meeting {
  mpq_class det = 0, t = 0, inside = -1;
};
Meeting moeller_trumbore(const Rational3& origin, const Rational3& direction, const std::array<Vec3, 3>& c) {
  const Rational3 a(c[0]), edge1 = Rational3(c[1]) - a, edge2 = Rational3(c[2]) - a, s = origin - a;
  const Rational3 p = cross(direction, edge2), q = cross(s, edge1);
  Meeting m;
  m.det = dot(edge1, p);
  if (m.det == 0) return m;
  const mpq_class u = dot(s, p) / m.det, v = dot(direction, q) / m.det, w = 1 - u - v;
  m.t = dot(edge2, q) / m.det;
  m.inside = std::min(u, std::min(v, w));
  return m;
}

Rational3 exact_place(const World& world, const raytrace::SurfacePoint& point) {
  const auto c = world.corners(point.primitive);
  const mpq_class b1(point.barycentric.x), b2(point.barycentric.y), b0 = 1 - b1 - b2;
  const auto mean = [&](int axis) -> mpq_class {
    return b0 * mpq_class(c[0][axis]) + b1 * mpq_class(c[1][axis]) + b2 * mpq_class(c[2][axis]);
  };
  return {mean(0), mean(1), mean(2)};
}

/// -1: surely apart, 1: surely blocked, 0: ask the rationals. Scenes of about unit size.
int double_guess(const Vec3& origin, const Vec3& direction, const std::array<Vec3, 3>& c) {
  constexpr double margin = 1e-6;
  const Vec3 edge1 = c[1] - c[0], edge2 = c[2] - c[0], s = origin - c[0];
  const Vec3 p = glm::cross(direction, edge2), q = glm::cross(s, edge1);
  const double det = glm::dot(edge1, p);
  if (std::abs(det) < 1e-4) return 0;
  const double u = glm::dot(s, p) / det, v = glm::dot(direction, q) / det, t = glm::dot(edge2, q) / det;
  const double least = std::min({u, v, 1.0 - u - v, t, 1.0 - t});
  return least > margin ? 1 : least < -margin ? -1 : 0;
}

}  // namespace

RationalTriangle rational_triangle(const Vec3& origin, const Vec3& direction,
                                   const std::array<Vec3, 3>& corners) {
  const Meeting m = moeller_trumbore(Rational3(origin), Rational3(direction), corners);
  return {m.det != 0 && m.inside >= 0, m.t > 0, m.inside.get_d(), m.det.get_d()};
}

int rational_order(const Vec3& origin, const Vec3& direction, const std::array<Vec3, 3>& one,
                   const std::array<Vec3, 3>& other) {
  const Rational3 o(origin), d(direction);
  return cmp(moeller_trumbore(o, d, one).t, moeller_trumbore(o, d, other).t);
}

bool rationally_shadowed(const World& world, const raytrace::SurfacePoint& point, const Vec3& light) {
  const Vec3 way = light - point.position;
  for (std::uint32_t id = 0; id < world.triangle_count(); ++id) {
    if (id == point.primitive) continue;
    const auto corners = world.corners(id);
    const int guess = double_guess(point.position, way, corners);
    if (guess > 0) return true;
    if (guess < 0) continue;
    const Rational3 x = exact_place(world, point);
    const Meeting m = moeller_trumbore(x, Rational3(light) - x, corners);
    if (m.det != 0 && m.inside >= 0 && m.t > 0 && m.t < 1) return true;
  }
  return false;
}

namespace {

/// The foot of the stored position.
Rational3 place_on_plane(const Plane& plane, const raytrace::SurfacePoint& point) {
  const Rational3 n(plane.normal), x(point.position);
  const mpq_class height = dot(n, x - Rational3(plane.point)) / dot(n, n);
  return {x.x - height * n.x, x.y - height * n.y, x.z - height * n.z};
}

/// The way from a point to a light: x + s d, 0 < s < 1, or without end.
struct Way {
  Rational3 x, d;
  bool ends;
  Rational3 at(const mpq_class& s) const { return {x.x + s * d.x, x.y + s * d.y, x.z + s * d.z}; }
  bool holds(const mpq_class& s) const { return s > 0 && (!ends || s < 1); }
};

bool meets(const Way& way, const std::array<Vec3, 3>& corners) {
  const Meeting m = moeller_trumbore(way.x, way.d, corners);
  return m.det != 0 && m.inside >= 0 && way.holds(m.t);
}

bool meets(const Way& way, const Plane& plane) {
  const Rational3 n(plane.normal);
  const mpq_class slope = dot(n, way.d);
  return slope != 0 && way.holds(dot(n, Rational3(plane.point) - way.x) / slope);
}

/// The least value of |x + s d - center|^2 - r^2 on the way tells, where both ends are outside; a way with
/// one end inside crosses the surface once.
bool meets(const Way& way, const Sphere& sphere) {
  const Rational3 center(sphere.center);
  const mpq_class reach = mpq_class(sphere.radius) * sphere.radius;
  const auto power = [&](const mpq_class& s) -> mpq_class {
    const Rational3 offset = way.at(s) - center;
    return dot(offset, offset) - reach;
  };
  const bool from_inside = power(0) < 0;
  if (from_inside) return !way.ends || power(1) > 0;
  if (way.ends && power(1) < 0) return true;
  const mpq_class middle = dot(center - way.x, way.d) / dot(way.d, way.d);
  return way.holds(middle) && power(middle) <= 0;
}

}  // namespace

std::optional<bool> rationally_shadowed(const World& world, const raytrace::SurfacePoint& point,
                                        const Light& light) {
  const auto* own_plane = world.is_triangle(point.primitive)
                              ? nullptr
                              : std::get_if<Plane>(&world.shape(point.primitive).geometry);
  if (own_plane == nullptr && !world.is_triangle(point.primitive)) return std::nullopt;
  const bool ends = light.type != LightType::directional;
  const Rational3 zero(Vec3(0.0));
  const Rational3 x = own_plane != nullptr ? place_on_plane(*own_plane, point) : exact_place(world, point);
  const Way way{x, ends ? Rational3(light.position) - x : zero - Rational3(light.direction), ends};
  bool unknown = false;
  for (std::uint32_t id = 0; id < world.primitive_count(); ++id) {
    if (id == point.primitive) continue;
    const auto* shape = world.is_triangle(id) ? nullptr : &world.shape(id).geometry;
    if (shape != nullptr && is_solid(*shape)) {
      unknown = true;
      continue;
    }
    const bool met = shape == nullptr      ? meets(way, world.corners(id))
                     : shape->index() == 0 ? meets(way, std::get<Sphere>(*shape))
                                           : meets(way, std::get<Plane>(*shape));
    if (met && !world.is_masked(id)) return true;
    unknown = unknown || met;
  }
  return unknown ? std::nullopt : std::optional(false);
}

}  // namespace gnomon::verify
