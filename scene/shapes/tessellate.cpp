#include "scene/shapes/tessellate.h"

#include <fmt/core.h>

#include "scene/files/defaults.h"
#include "scene/shapes/solid.h"

namespace gnomon {
namespace {

/// A point of the outline that is turned about the local z axis, with its normal in that half-plane.
struct OutlinePoint {
  double r, z;
  Vec2 normal;  ///< along r and z, outward
};
using Outline = std::vector<OutlinePoint>;

/// Triangles between the turned points; the frame and a stretch along its axes place them.
class Turner {
 public:
  Turner(Mesh& mesh, const ShapeGeometry& geometry, const ShapeFrame& frame, const Vec3& stretch, int sectors)
      : mesh_(mesh), geometry_(geometry), frame_(frame), stretch_(stretch), sectors_(sectors) {}

  /// Outward where the outline runs upwards at its right.
  void turn(const Outline& outline) {
    const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
    for (const OutlinePoint& p : outline)
      for (int k = 0; k <= sectors_; ++k) add_corner(p, k);
    const auto row = static_cast<std::uint32_t>(sectors_) + 1;
    for (std::uint32_t i = 0; i + 1 < outline.size(); ++i)
      for (std::uint32_t k = 0; k + 1 < row; ++k) {
        const std::uint32_t a = first + i * row + k, b = a + 1, c = a + row, d = c + 1;
        if (outline[i].r > 0.0) mesh_.triangles.push_back({a, b, d});
        if (outline[i + 1].r > 0.0) mesh_.triangles.push_back({a, d, c});
      }
  }

 private:
  // The last column repeats the first with texture coordinate 1.
  void add_corner(const OutlinePoint& p, int k) {
    const double angle = 2.0 * pi * (k % sectors_) / sectors_;
    const Vec3 around(std::cos(angle), std::sin(angle), 0.0);
    const Vec3 local = stretch_ * (p.r * around + Vec3(0.0, 0.0, p.z));
    const Vec3 normal = (p.normal.x * around + Vec3(0.0, 0.0, p.normal.y)) / stretch_;
    mesh_.positions.push_back(to_world(frame_, local));
    mesh_.normals.emplace_back(glm::normalize(frame_.axes * normal));
    Vec2 uv(double(k) / sectors_, 0.0);
    if (is_solid(geometry_))
      uv.y = solid_uv(geometry_, to_world(frame_, local)).y;
    else
      uv = {1.0 - uv.x, std::acos(std::clamp(p.z, -1.0, 1.0)) / pi};
    mesh_.uvs.emplace_back(uv);
  }

  Mesh& mesh_;
  const ShapeGeometry& geometry_;
  const ShapeFrame frame_;
  const Vec3 stretch_;
  const int sectors_;
};

Outline half_circle(int rings) {
  Outline out;
  for (int i = 0; i <= rings; ++i) {
    const double angle = -0.5 * pi + pi * i / rings;
    const bool pole = i == 0 || i == rings;
    const Vec2 p(pole ? 0.0 : std::cos(angle), pole ? (i == 0 ? -1.0 : 1.0) : std::sin(angle));
    out.push_back({p.x, p.y, p});
  }
  return out;
}

Outline tube(const Torus& torus, int rings) {
  Outline out;
  for (int i = 0; i <= rings; ++i) {
    const double angle = 2.0 * pi * (i % rings) / rings;
    const Vec2 n(std::cos(angle), std::sin(angle));
    out.push_back({torus.major + torus.minor * n.x, torus.minor * n.y, n});
  }
  return out;
}

// r(z) of a quadric of revolution, between two heights.
Outline wall(const Quadric& q, double from, double to, int rings) {
  Outline out;
  for (int i = 0; i <= rings; ++i) {
    const double z = i == rings ? to : from + (to - from) * i / rings;
    const double r = std::sqrt(std::max(0.0, -(q.zz * z * z + q.z * z + q.one)));
    const Vec2 slope(2.0 * r, 2.0 * q.zz * z + q.z);
    const double length = glm::length(slope);
    out.push_back({r, z, length > 0.0 ? slope / length : Vec2(0.0, 1.0)});
  }
  return out;
}

Outline cap(double r, double z, bool upper) {
  const Vec2 normal(0.0, upper ? 1.0 : -1.0);
  return upper ? Outline{{r, z, normal}, {0.0, z, normal}} : Outline{{0.0, z, normal}, {r, z, normal}};
}

void turn_quadric(const Quadric& q, Turner& turner, int rings) {
  const double low = q.box.min.z, high = q.box.max.z;
  const bool straight = q.kind == QuadricKind::cylinder || q.kind == QuadricKind::cone;
  std::vector<Outline> walls;
  if (q.kind == QuadricKind::hyperboloid && q.one > 0.0) {
    const double apex = std::sqrt(-q.one / q.zz);
    walls = {wall(q, low, -apex, rings), wall(q, apex, high, rings)};
  } else if (q.kind == QuadricKind::hyperboloid && q.one == 0.0) {
    walls = {wall(q, low, 0.0, 1), wall(q, 0.0, high, 1)};
  } else {
    walls = {wall(q, low, high, straight ? 1 : rings)};
  }
  for (const Outline& w : walls) turner.turn(w);
  if (!q.closed) return;
  if (const double r = walls.front().front().r; r > 0.0) turner.turn(cap(r, low, false));
  if (const double r = walls.back().back().r; r > 0.0) turner.turn(cap(r, high, true));
}

}  // namespace

Mesh tessellated(const Shape& shape, int n) {
  Mesh mesh;
  mesh.name = shape.name;
  const int rings = std::max(2, n / 2);
  const auto turner = [&](const ShapeFrame& frame, const Vec3& stretch) {
    return Turner(mesh, shape.geometry, frame, stretch, n);
  };
  if (const auto* implicit = std::get_if<Implicit>(&shape.geometry)) {
    add_surface_nets(*implicit, n, mesh);
  } else if (const auto* torus = std::get_if<Torus>(&shape.geometry)) {
    turner(torus->frame, Vec3(1.0)).turn(tube(*torus, std::max(3, rings)));
  } else if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
    // Its texture turns about y, the other way round (raytrace/shapes/mask_cells.h).
    ShapeFrame frame;
    frame.origin = sphere->center;
    frame.axes = Mat3(Vec3(1, 0, 0), Vec3(0, 0, -1), Vec3(0, 1, 0));
    turner(frame, Vec3(sphere->radius)).turn(half_circle(rings));
  } else {
    const auto& quadric = std::get<Quadric>(shape.geometry);
    if (quadric.kind == QuadricKind::ellipsoid) {
      turner(quadric.frame, quadric.box.max).turn(half_circle(rings));
    } else {
      Turner about_axis = turner(quadric.frame, Vec3(1.0));
      turn_quadric(quadric, about_axis, rings);
    }
  }
  return mesh;
}

Scene cut_planes(Scene scene) {
  Aabb bounds = scene_bounds(scene);
  bounds.grow(scene.camera.eye);
  bounds.grow(scene.camera.target);
  const auto half = static_cast<float>(bounds.diagonal());
  for (const Shape& shape : scene.shapes) {
    const auto* plane = std::get_if<Plane>(&shape.geometry);
    if (plane == nullptr) continue;
    Vec3 tangent, bitangent;
    orthonormal_basis(plane->normal, tangent, bitangent);
    const Vec3 middle(glm::dot(tangent, bounds.center() - plane->point),
                      glm::dot(bitangent, bounds.center() - plane->point), 0.0);
    Mesh mesh;
    mesh.name = shape.name;
    for (const Vec2f corner :
         {Vec2f(-half, -half), Vec2f(half, -half), Vec2f(half, half), Vec2f(-half, half)}) {
      mesh.positions.emplace_back(corner, 0.0);
      mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
      mesh.uvs.push_back(corner + Vec2f(middle));
    }
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    const Vec3 center = plane->point + middle.x * tangent + middle.y * bitangent;
    const Mat4 world_from_object(Vec4(tangent, 0.0), Vec4(bitangent, 0.0), Vec4(plane->normal, 0.0),
                                 Vec4(center, 1.0));
    scene.instances.push_back(
        {shape.name, static_cast<std::uint32_t>(scene.meshes.size()), world_from_object, shape.material});
    scene.meshes.push_back(std::move(mesh));
    scene.notes.push_back(
        fmt::format("The infinite plane '{}' ends as a square with sides of {:.4g}, which "
                    "shadow maps have to cover.",
                    shape.name, 2.0 * static_cast<double>(half)));
  }
  std::erase_if(scene.shapes, [](const Shape& s) { return std::holds_alternative<Plane>(s.geometry); });
  return scene;
}

Scene tessellate_shapes(Scene scene, int n) {
  std::vector<Shape> kept;
  int turned = 0;
  for (Shape& shape : scene.shapes) {
    if (std::holds_alternative<Plane>(shape.geometry)) {
      kept.push_back(std::move(shape));
      continue;
    }
    scene.instances.push_back(
        {shape.name, static_cast<std::uint32_t>(scene.meshes.size()), Mat4(1.0), shape.material});
    scene.meshes.push_back(tessellated(shape, n));
    ++turned;
  }
  scene.shapes = std::move(kept);
  if (turned > 0)
    scene.notes.push_back(fmt::format("{} exact shape{} made of triangles (--tessellate {}).", turned,
                                      turned == 1 ? " is" : "s are", n));
  return scene;
}

}  // namespace gnomon
