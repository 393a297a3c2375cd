// 128-bit arithmetic for oracles: 113 bits of mantissa, so that what is computed from doubles is right far
// beyond the last place of a double. Textbook formulas on purpose: they share nothing with the tracer's.
#pragma once

#include <cmath>

#include "scene/math.h"

namespace gnomon::verify {

using Quad __attribute__((mode(TF))) = float;  // __float128, or long double where that has 113 bits

struct Quad3 {
  Quad x, y, z;
  explicit Quad3(const Vec3& v) : x(v.x), y(v.y), z(v.z) {}
  Quad3(Quad a, Quad b, Quad c) : x(a), y(b), z(c) {}
};
inline Quad3 operator-(const Quad3& a, const Quad3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Quad dot(const Quad3& a, const Quad3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Quad3 cross(const Quad3& a, const Quad3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Newton from the double's root: twice the digits each time.
inline Quad root(Quad v) {
  if (!(v > 0)) return 0;
  Quad r = std::sqrt(static_cast<double>(v));
  for (int i = 0; i < 2 && r > 0; ++i) r = (r + v / r) / 2;
  return r;
}
inline Quad magnitude(Quad v) {
  return v < 0 ? -v : v;
}

/// A line against a sphere: b^2 - a c (negative: no roots) and the roots in ascending order.
struct QuadRoots {
  Quad discriminant, a, near = 0, far = 0;
};
inline QuadRoots line_sphere(const Vec3& origin, const Vec3& direction, const Vec3& center, double radius) {
  const Quad3 o = Quad3(origin) - Quad3(center), d(direction);
  const Quad a = dot(d, d), b = dot(o, d), c = dot(o, o) - Quad(radius) * Quad(radius);
  QuadRoots roots{b * b - a * c, a};
  if (roots.discriminant < 0) return roots;
  const Quad r = root(roots.discriminant);
  roots.near = (-b - r) / a, roots.far = (-b + r) / a;
  return roots;
}

/// Moeller-Trumbore: t and the smallest barycentric weight; parallel: det == 0.
struct QuadTriangle {
  Quad det = 0, t = 0, inside = -1;
};
inline QuadTriangle line_triangle(const Vec3& origin, const Vec3& direction, const Vec3& a, const Vec3& b,
                                  const Vec3& c) {
  const Quad3 e1 = Quad3(b) - Quad3(a), e2 = Quad3(c) - Quad3(a), d(direction), s = Quad3(origin) - Quad3(a);
  const Quad3 p = cross(d, e2), q = cross(s, e1);
  QuadTriangle r;
  r.det = dot(e1, p);
  if (r.det == 0) return r;
  const Quad u = dot(s, p) / r.det, v = dot(d, q) / r.det;
  r.t = dot(e2, q) / r.det;
  r.inside = std::min({u, v, 1 - u - v});
  return r;
}

}  // namespace gnomon::verify
