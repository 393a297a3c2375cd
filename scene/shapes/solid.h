// Solids: the shapes that are the zero set of a function in a rigid frame, inside a local box - quadrics,
// tori and implicit surfaces. The function is less than 0 inside. What both renderers ask of them is here,
// written for any arithmetic; "local" is the solid's own frame.
//
// A closed solid is the body {f <= 0} within its box, caps included (a quadric is cut by z alone); an open
// one is the sheet {f = 0} within the box. Tori and ellipsoids are always closed.
#pragma once

#include "scene/scene.h"

namespace gnomon {

using ShapeGeometry = decltype(Shape::geometry);

inline bool is_solid(const ShapeGeometry& g) {
  return g.index() >= 2;
}

// Makers. Lengths in world units, > 0. `frame`: see each.
/// Half-axes along the frame's axes, around its origin.
Quadric make_ellipsoid(const ShapeFrame& frame, const Vec3& radii);
/// From the origin to z = height.
Quadric make_cylinder(const ShapeFrame& frame, double radius, double height, bool closed);
/// Radius at z = 0 and at z = height; either may be 0: an apex.
Quadric make_cone(const ShapeFrame& frame, double radius, double top_radius, double height, bool closed);
/// Apex at the origin, rim of that radius at z = height.
Quadric make_paraboloid(const ShapeFrame& frame, double radius, double height, bool closed);
/// Around the origin, |z| <= height / 2, rims of that radius; `waist`: the radius at z = 0, less than radius.
Quadric make_hyperboloid(const ShapeFrame& frame, double radius, double waist, double height, bool closed);
/// Two bowls, of which `gap` is the distance; less than height.
Quadric make_two_bowls(const ShapeFrame& frame, double radius, double gap, double height, bool closed);

/// Right-handed axes with the given local z.
ShapeFrame frame_along(const Vec3& origin, const Vec3& unit_z);

inline Vec3 to_local(const ShapeFrame& f, const Vec3& p) {
  return glm::transpose(f.axes) * (p - f.origin);
}
inline Vec3 to_world(const ShapeFrame& f, const Vec3& local) {
  return f.origin + f.axes * local;
}

/// These require a solid.
const ShapeFrame& frame_of(const ShapeGeometry& solid);
Aabb local_box(const ShapeGeometry& solid);
/// Axis-aligned bounds in the world.
Aabb world_box(const ShapeGeometry& solid);
/// Rays cross it an even number of times, so that it has an inside.
bool is_closed(const ShapeGeometry& solid);
/// Convex and closed.
bool is_convex(const ShapeGeometry& solid);

/// f at a local point, in any arithmetic (scene/shapes/expression.h).
template <class Number>
Number quadric_value(const Quadric& q, const Number& x, const Number& y, const Number& z) {
  const Number across = Number(q.xx) * whole_power(x, 2) + Number(q.yy) * whole_power(y, 2);
  return across + (Number(q.zz) * whole_power(z, 2) + Number(q.z) * z) + Number(q.one);
}
template <class Number>
Number torus_value(const Torus& t, const Number& x, const Number& y, const Number& z) {
  const Number around = square_root(whole_power(x, 2) + whole_power(y, 2)) - Number(t.major);
  return whole_power(around, 2) + whole_power(z, 2) - Number(t.minor * t.minor);
}
template <class Number>
Number solid_value(const ShapeGeometry& solid, const Number& x, const Number& y, const Number& z) {
  if (const auto* quadric = std::get_if<Quadric>(&solid)) return quadric_value(*quadric, x, y, z);
  if (const auto* torus = std::get_if<Torus>(&solid)) return torus_value(*torus, x, y, z);
  return evaluate(std::get<Implicit>(solid).function, x, y, z);
}

/// f and its gradient at a local point.
Differential<double, Vec3> solid_gradient(const ShapeGeometry& solid, const Vec3& local);

/// Where a local point near the surface belongs: to the surface of f (axis -1), or to the cap across `axis`
/// on the box's low or high side.
struct SolidPart {
  int axis = -1;
  bool high = false;
};
SolidPart nearest_part(const ShapeGeometry& solid, const Vec3& local);

/// Outward unit normal, in the world, at a world point on the surface.
Vec3 solid_normal(const ShapeGeometry& solid, const Vec3& position);

/// A closed solid holds the point (or it lies on the surface).
bool solid_contains(const ShapeGeometry& solid, const Vec3& position);

/// Texture coordinates at a world point on the surface. Around the local z axis: u is the angle's share of a
/// turn; v runs from the top (z = high) to the bottom by height. On an ellipsoid v runs by the angle from the
/// top, on a torus by the angle around the tube. Of an implicit surface: (x, y) across its box.
Vec2 solid_uv(const ShapeGeometry& solid, const Vec3& position);

/// The bounding box's reach from its centre along a world direction.
double reach_along(const ShapeGeometry& solid, const Vec3& direction);
/// The centre of the local box, in the world.
Vec3 solid_center(const ShapeGeometry& solid);

}  // namespace gnomon
