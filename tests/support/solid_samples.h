// One solid of every kind, for tests; and their functions in 128-bit floating point, written out again.
#pragma once

#include <gtest/gtest.h>

#include "raytrace/shapes/intersect.h"
#include "scene/shapes/solid.h"
#include "verify/quad.h"

namespace gnomon::test {

inline raytrace::RayFrame frame_of_ray(const Ray& ray) {
  return *raytrace::make_ray_frame(ray);
}

inline Shape solid(std::string name, ShapeGeometry geometry) {
  Shape shape;
  shape.name = std::move(name);
  shape.geometry = std::move(geometry);
  return shape;
}

inline Shape implicit(std::string name, const std::string& function, const Aabb& box, bool closed = false) {
  Implicit implicit;
  implicit.box = box;
  implicit.text = function;
  implicit.closed = closed;
  auto parsed = parse_expression(function);
  EXPECT_TRUE(parsed) << function;
  if (parsed) implicit.function = std::move(*parsed);
  return solid(std::move(name), std::move(implicit));
}

inline ShapeFrame tilted_frame(double size = 1.0, const Vec3& at = Vec3(0.0)) {
  ShapeFrame frame = frame_along(Vec3(0.0), glm::normalize(Vec3(0.3, 0.9, -0.2)));
  frame.origin = at - 0.5 * size * frame.axes[2];
  return frame;
}

/// Makes solids of size about `size` around `at`.
inline std::vector<Shape> solid_samples(double size = 1.0, const Vec3& at = Vec3(0.0)) {
  const ShapeFrame base = tilted_frame(size, at);
  ShapeFrame middle = base;
  middle.origin = at;
  const double s = size;
  std::vector<Shape> out{
      solid("ellipsoid", make_ellipsoid(middle, s * Vec3(0.9, 0.5, 0.7))),
      solid("cylinder", make_cylinder(base, 0.6 * s, s, true)),
      solid("open cylinder", make_cylinder(base, 0.6 * s, s, false)),
      solid("cone", make_cone(base, 0.8 * s, 0.0, s, true)),
      solid("open cut cone", make_cone(base, 0.4 * s, 0.8 * s, s, false)),
      solid("paraboloid", make_paraboloid(base, 0.8 * s, s, true)),
      solid("open paraboloid", make_paraboloid(base, 0.8 * s, s, false)),
      solid("hyperboloid", make_hyperboloid(middle, 0.8 * s, 0.3 * s, 1.4 * s, true)),
      solid("open hyperboloid", make_hyperboloid(middle, 0.8 * s, 0.3 * s, 1.4 * s, false)),
      solid("double cone", make_hyperboloid(middle, 0.7 * s, 0.0, 1.4 * s, true)),
      solid("two bowls", make_two_bowls(middle, 0.7 * s, 0.2 * s, 1.6 * s, true)),
      solid("torus", Torus{middle, 0.7 * s, 0.25 * s}),
  };
  if (size == 1.0) {
    const Aabb box{Vec3(-1.0), Vec3(1.0)};
    out.push_back(implicit("gyroid", "sin(4*x)*cos(4*y) + sin(4*y)*cos(4*z) + sin(4*z)*cos(4*x)", box));
    out.push_back(implicit(
        "thick gyroid", "abs(sin(4*x)*cos(4*y) + sin(4*y)*cos(4*z) + sin(4*z)*cos(4*x)) - 0.3", box, true));
    out.push_back(implicit("heart", "(2*x^2 + y^2 + z^2 - 0.5)^3 - x^2*z^3/5 - y^2*z^3*2", box));
    for (std::size_t i = 12; i < out.size(); ++i) std::get<Implicit>(out[i].geometry).frame = middle;
  }
  return out;
}

namespace quad_arithmetic {
using verify::Quad;

inline Quad power(Quad v, int n) {
  Quad r = 1;
  for (int i = 0; i < n; ++i) r *= v;
  return r;
}
// Newton's correction of the double's value, from the double's own derivative.
inline Quad root(Quad v) {
  Quad r = std::sqrt(static_cast<double>(v));
  for (int i = 0; i < 3 && r > 0; ++i) r = (r + v / r) / 2;
  return r;
}
// Taylor's series about the double: sin(a + b) with |b| < 1e-16.
inline Quad sine(Quad v) {
  const auto a = static_cast<long double>(v);
  const Quad b = v - Quad(a);
  return Quad(std::sin(a)) + b * Quad(std::cos(a));
}
inline Quad cosine(Quad v) {
  const auto a = static_cast<long double>(v);
  const Quad b = v - Quad(a);
  return Quad(std::cos(a)) - b * Quad(std::sin(a));
}

inline Quad value(const Expression& e, Quad x, Quad y, Quad z) {
  std::vector<Quad> at;
  for (const ExpressionStep& s : e.steps) {
    const auto a = [&] { return at[s.a]; };
    const auto b = [&] { return at[s.b]; };
    switch (s.op) {
      case ExpressionOp::constant:
        at.push_back(s.value);
        break;
      case ExpressionOp::x:
        at.push_back(x);
        break;
      case ExpressionOp::y:
        at.push_back(y);
        break;
      case ExpressionOp::z:
        at.push_back(z);
        break;
      case ExpressionOp::negate:
        at.push_back(-a());
        break;
      case ExpressionOp::add:
        at.push_back(a() + b());
        break;
      case ExpressionOp::subtract:
        at.push_back(a() - b());
        break;
      case ExpressionOp::multiply:
        at.push_back(a() * b());
        break;
      case ExpressionOp::divide:
        at.push_back(a() / b());
        break;
      case ExpressionOp::whole_power:
        at.push_back(power(a(), s.exponent));
        break;
      case ExpressionOp::square_root:
        at.push_back(root(a()));
        break;
      case ExpressionOp::absolute:
        at.push_back(a() < 0 ? -a() : a());
        break;
      case ExpressionOp::sine:
        at.push_back(sine(a()));
        break;
      case ExpressionOp::cosine:
        at.push_back(cosine(a()));
        break;
      default:
        ADD_FAILURE() << "the samples do not use this";
        at.push_back(0);
    }
  }
  return at.back();
}
}  // namespace quad_arithmetic

/// f, without scene/shapes/solid.h: circles and slabs as a textbook writes them.
inline verify::Quad quad_value(const ShapeGeometry& solid, verify::Quad x, verify::Quad y, verify::Quad z) {
  using namespace quad_arithmetic;  // NOLINT(google-build-using-namespace)
  if (const auto* torus = std::get_if<Torus>(&solid)) {
    const Quad g =
        x * x + y * y + z * z + Quad(torus->major) * torus->major - Quad(torus->minor) * torus->minor;
    return g * g - 4 * Quad(torus->major) * torus->major * (x * x + y * y);
  }
  if (const auto* implicit = std::get_if<Implicit>(&solid)) return value(implicit->function, x, y, z);
  const auto& q = std::get<Quadric>(solid);
  return Quad(q.xx) * x * x + Quad(q.yy) * y * y + Quad(q.zz) * z * z + Quad(q.z) * z + Quad(q.one);
}

}  // namespace gnomon::test
