#include "scene/shapes/solid.h"

#include <cassert>

namespace gnomon {
namespace {

Quadric around_z(QuadricKind kind, const ShapeFrame& frame, double reach, const Interval& z, bool closed) {
  Quadric q;
  q.kind = kind;
  q.frame = frame;
  q.box = {Vec3(-reach, -reach, z.min), Vec3(reach, reach, z.max)};
  q.closed = closed;
  return q;
}

double turn_of(double x, double y) {
  const double turn = std::atan2(y, x) / (2.0 * pi);
  return turn - std::floor(turn);
}

}  // namespace

// Each function is scaled by the square of a length, so that its gradient on the surface is of size 1 /
// length.
Quadric make_ellipsoid(const ShapeFrame& frame, const Vec3& radii) {
  Quadric q = around_z(QuadricKind::ellipsoid, frame, 1.0, {}, true);
  q.xx = 1.0 / (radii.x * radii.x), q.yy = 1.0 / (radii.y * radii.y), q.zz = 1.0 / (radii.z * radii.z);
  q.one = -1.0;
  q.box = {-radii, radii};
  return q;
}

Quadric make_cylinder(const ShapeFrame& frame, double radius, double height, bool closed) {
  Quadric q = around_z(QuadricKind::cylinder, frame, radius, {0.0, height}, closed);
  q.zz = 0.0, q.one = -radius * radius;
  return q;
}

Quadric make_cone(const ShapeFrame& frame, double radius, double top_radius, double height, bool closed) {
  const double slope = (top_radius - radius) / height;
  Quadric q = around_z(QuadricKind::cone, frame, std::max(radius, top_radius), {0.0, height}, closed);
  q.zz = -slope * slope, q.z = -2.0 * radius * slope, q.one = -radius * radius;
  return q;
}

Quadric make_paraboloid(const ShapeFrame& frame, double radius, double height, bool closed) {
  Quadric q = around_z(QuadricKind::paraboloid, frame, radius, {0.0, height}, closed);
  q.zz = 0.0, q.z = -radius * radius / height, q.one = 0.0;
  return q;
}

Quadric make_hyperboloid(const ShapeFrame& frame, double radius, double waist, double height, bool closed) {
  const double half = 0.5 * height;
  Quadric q = around_z(QuadricKind::hyperboloid, frame, radius, {-half, half}, closed);
  q.zz = -(radius - waist) * (radius + waist) / (half * half), q.one = -waist * waist;
  return q;
}

Quadric make_two_bowls(const ShapeFrame& frame, double radius, double gap, double height, bool closed) {
  const double half = 0.5 * height, apex = 0.5 * gap;
  Quadric q = around_z(QuadricKind::hyperboloid, frame, radius, {-half, half}, closed);
  q.zz = -radius * radius / ((half - apex) * (half + apex)), q.one = -q.zz * apex * apex;
  return q;
}

ShapeFrame frame_along(const Vec3& origin, const Vec3& unit_z) {
  ShapeFrame f;
  f.origin = origin;
  Vec3 tangent, bitangent;
  orthonormal_basis(unit_z, tangent, bitangent);
  f.axes = Mat3(tangent, bitangent, unit_z);
  return f;
}

const ShapeFrame& frame_of(const ShapeGeometry& solid) {
  if (const auto* quadric = std::get_if<Quadric>(&solid)) return quadric->frame;
  if (const auto* torus = std::get_if<Torus>(&solid)) return torus->frame;
  return std::get<Implicit>(solid).frame;
}

Aabb local_box(const ShapeGeometry& solid) {
  if (const auto* quadric = std::get_if<Quadric>(&solid)) return quadric->box;
  if (const auto* torus = std::get_if<Torus>(&solid)) {
    const Vec3 half(torus->major + torus->minor, torus->major + torus->minor, torus->minor);
    return {-half, half};
  }
  return std::get<Implicit>(solid).box;
}

double reach_along(const ShapeGeometry& solid, const Vec3& direction) {
  const Aabb box = local_box(solid);
  return glm::dot(glm::abs(glm::transpose(frame_of(solid).axes) * direction), 0.5 * box.extent());
}

Vec3 solid_center(const ShapeGeometry& solid) {
  return to_world(frame_of(solid), local_box(solid).center());
}

Aabb world_box(const ShapeGeometry& solid) {
  const Vec3 center = solid_center(solid);
  const Vec3 half(reach_along(solid, Vec3(1, 0, 0)), reach_along(solid, Vec3(0, 1, 0)),
                  reach_along(solid, Vec3(0, 0, 1)));
  return {center - half, center + half};
}

bool is_closed(const ShapeGeometry& solid) {
  if (const auto* quadric = std::get_if<Quadric>(&solid)) return quadric->closed;
  if (const auto* implicit = std::get_if<Implicit>(&solid)) return implicit->closed;
  return true;
}

bool is_convex(const ShapeGeometry& solid) {
  const auto* quadric = std::get_if<Quadric>(&solid);
  return quadric != nullptr && quadric->closed && quadric->kind != QuadricKind::hyperboloid;
}

Differential<double, Vec3> solid_gradient(const ShapeGeometry& solid, const Vec3& local) {
  using Number = Differential<double, Vec3>;
  return solid_value(solid, Number(local.x, Vec3(1, 0, 0)), Number(local.y, Vec3(0, 1, 0)),
                     Number(local.z, Vec3(0, 0, 1)));
}

SolidPart nearest_part(const ShapeGeometry& solid, const Vec3& local) {
  SolidPart part;
  const bool all_faces = std::holds_alternative<Implicit>(solid);
  const auto* quadric = std::get_if<Quadric>(&solid);
  const bool caps = quadric != nullptr ? quadric->closed && quadric->kind != QuadricKind::ellipsoid
                                       : all_faces && is_closed(solid);
  if (!caps) return part;
  const auto f = solid_gradient(solid, local);
  double nearest = std::abs(f.value) / glm::length(f.change);
  if (!std::isfinite(nearest)) nearest = infinity;
  const Aabb box = local_box(solid);
  for (int axis = all_faces ? 0 : 2; axis < 3; ++axis)
    for (const bool high : {false, true}) {
      const double distance = std::abs(local[axis] - (high ? box.max : box.min)[axis]);
      if (distance < nearest) nearest = distance, part = {axis, high};
    }
  return part;
}

Vec3 solid_normal(const ShapeGeometry& solid, const Vec3& position) {
  const ShapeFrame& frame = frame_of(solid);
  const Vec3 local = to_local(frame, position);
  const SolidPart part = nearest_part(solid, local);
  if (part.axis >= 0) return part.high ? frame.axes[part.axis] : -frame.axes[part.axis];
  const Vec3 gradient = frame.axes * solid_gradient(solid, local).change;
  const double length = glm::length(gradient);
  // An apex, or a double surface, has no normal of its own.
  return length > 0.0 && std::isfinite(length) ? gradient / length : frame.axes[2];
}

bool solid_contains(const ShapeGeometry& solid, const Vec3& position) {
  if (!is_closed(solid)) return false;
  const Vec3 p = to_local(frame_of(solid), position);
  const Aabb box = local_box(solid);
  for (int axis = 0; axis < 3; ++axis)
    if (!(p[axis] >= box.min[axis] && p[axis] <= box.max[axis])) return false;
  return solid_value(solid, p.x, p.y, p.z) <= 0.0;
}

Vec2 solid_uv(const ShapeGeometry& solid, const Vec3& position) {
  const Vec3 p = to_local(frame_of(solid), position);
  const Aabb box = local_box(solid);
  if (std::holds_alternative<Implicit>(solid))
    return {(p.x - box.min.x) / (box.max.x - box.min.x), (box.max.y - p.y) / (box.max.y - box.min.y)};
  if (const auto* torus = std::get_if<Torus>(&solid))
    return {turn_of(p.x, p.y), turn_of(std::hypot(p.x, p.y) - torus->major, p.z)};
  if (std::get<Quadric>(solid).kind == QuadricKind::ellipsoid)
    return {turn_of(p.x / box.max.x, p.y / box.max.y),
            std::acos(std::clamp(p.z / box.max.z, -1.0, 1.0)) / pi};
  return {turn_of(p.x, p.y), (box.max.z - p.z) / (box.max.z - box.min.z)};
}

}  // namespace gnomon
