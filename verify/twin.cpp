#include "verify/random_scene.h"

#include <fmt/core.h>

#include <glm/gtc/matrix_transform.hpp>

#include "scene/shapes/solid.h"
#include "verify/small_world.h"

namespace gnomon::verify {
namespace {

Implicit by_expression(const ShapeFrame& frame, const Aabb& box, bool closed, const std::string& text) {
  Implicit out;
  out.frame = frame, out.box = box, out.closed = closed, out.text = text;
  if (auto parsed = parse_expression(text)) out.function = std::move(*parsed);
  return out;
}

/// About the axis, by any angle.
ShapeFrame turned_about(const ShapeFrame& frame, const Vec3& local_axis, Random& r) {
  const Mat3 turn(glm::rotate(Mat4(1.0), r.uniform(0.0, 2.0 * pi), local_axis));
  return {frame.origin, frame.axes * turn};
}

ShapeGeometry other_sphere(const Sphere& s, Random& r) {
  ShapeFrame frame{s.center, Mat3(1.0)};
  if (r.coin()) frame = turned_about(frame, r.direction(), r);
  if (r.coin()) return make_ellipsoid(frame, Vec3(s.radius));
  const Vec3 half(r.coin() ? s.radius : 1.25 * s.radius);
  const std::string form = r.coin() ? "sqrt(x^2 + y^2 + z^2) - {:.17g}" : "x^2 + y^2 + z^2 - {:.17g}^2";
  return by_expression(frame, {-half, half}, true, fmt::format(fmt::runtime(form), s.radius));
}

ShapeGeometry other_plane(const Plane& p, double reach, Random& r) {
  const Vec3 half(reach);
  const bool closed = r.coin();
  if (r.coin()) return by_expression(frame_along(p.point, p.normal), {-half, half}, closed, "z");
  const std::string text =
      fmt::format("{:.17g}*x + {:.17g}*y + {:.17g}*z", p.normal.x, p.normal.y, p.normal.z);
  return by_expression({p.point, Mat3(1.0)}, {-half, half}, closed, text);
}

ShapeGeometry other_quadric(const Quadric& q, Random& r) {
  const ShapeFrame frame = q.xx == q.yy && r.coin() ? turned_about(q.frame, Vec3(0, 0, 1), r) : q.frame;
  if (q.kind == QuadricKind::cylinder && r.coin())
    return make_cone(frame, q.box.max.x, q.box.max.x, q.box.max.z, q.closed);
  Aabb box = q.box;
  for (int axis = 0; axis < (q.kind == QuadricKind::ellipsoid ? 3 : 2); ++axis)
    box.min[axis] *= 1.5, box.max[axis] *= 1.5;
  const std::string text = fmt::format("{:.17g}*x^2 + {:.17g}*y^2 + {:.17g}*z^2 + {:.17g}*z + {:.17g}", q.xx,
                                       q.yy, q.zz, q.z, q.one);
  return by_expression(frame, box, q.closed, text);
}

ShapeGeometry other_torus(const Torus& t, Random& r) {
  const Vec3 half(1.25 * (t.major + t.minor));
  const std::string text = fmt::format("(sqrt(x^2 + y^2) - {:.17g})^2 + z^2 - {:.17g}^2", t.major, t.minor);
  return by_expression(turned_about(t.frame, Vec3(0, 0, 1), r), {-half, half}, true, text);
}

}  // namespace

Shape described_otherwise(const Shape& shape, double reach, Random& random) {
  Shape twin = shape;
  twin.name += " otherwise";
  if (const auto* s = std::get_if<Sphere>(&shape.geometry)) twin.geometry = other_sphere(*s, random);
  if (const auto* p = std::get_if<Plane>(&shape.geometry)) twin.geometry = other_plane(*p, reach, random);
  if (const auto* q = std::get_if<Quadric>(&shape.geometry)) twin.geometry = other_quadric(*q, random);
  if (const auto* t = std::get_if<Torus>(&shape.geometry)) twin.geometry = other_torus(*t, random);
  return twin;
}

Mesh quad_in_cap(const Shape& shape, Random& random) {
  const auto* q = std::get_if<Quadric>(&shape.geometry);
  if (q == nullptr || !q->closed || q->kind == QuadricKind::ellipsoid) return {};
  const ShapeFrame frame = turned_about(q->frame, Vec3(0, 0, 1), random);
  const double half = 1.5 * q->box.max.x, z = random.coin() ? q->box.min.z : q->box.max.z;
  const Vec3 corner = to_world(frame, Vec3(-half, -half, z));
  return quad(corner, 2.0 * half * frame.axes[0], 2.0 * half * frame.axes[1]);
}

void add_twin(Scene& scene, Random& random) {
  const auto count = static_cast<std::uint32_t>(scene.shapes.size());
  const Shape shape = scene.shapes[random.below(count)];
  const double reach = glm::distance(scene.camera.eye, scene.camera.target);
  const auto place = static_cast<std::ptrdiff_t>(random.below(count + 1));
  Mesh square = random.coin() ? quad_in_cap(shape, random) : Mesh{};
  if (square.triangles.empty()) {
    scene.shapes.insert(scene.shapes.begin() + place, described_otherwise(shape, reach, random));
    return;
  }
  MeshInstance instance;
  instance.mesh = static_cast<std::uint32_t>(scene.meshes.size()), instance.material = shape.material;
  scene.meshes.push_back(std::move(square));
  scene.instances.push_back(instance);
}

}  // namespace gnomon::verify
