#include "app/verify/rational.h"

#include <gmpxx.h>

#include <algorithm>

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

}  // namespace gnomon::verify
