#include "raytrace/shapes/inside.h"

#include <optional>

#include "raytrace/shapes/intersect.h"
#include "scene/shapes/closed_mesh.h"
#include "scene/shapes/solid.h"

namespace gnomon::raytrace {
namespace {

// Directions that no modeller chose: points of a spiral on the sphere.
Vec3 direction_of(int attempt) {
  const double z = 0.9 * std::cos(1.3 + 2.4 * attempt), turn = 0.7 + 2.399963229728653 * attempt;
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

/// Crossings ahead of the point; none when the ray comes upon an edge, a corner or a triangle's own plane.
std::optional<std::uint64_t> crossings(const World& world, std::uint32_t first, std::uint32_t count,
                                       const RayFrame& ray) {
  std::uint64_t crossed = 0;
  for (std::uint32_t id = first; id < first + count; ++id) {
    const auto [a, b, c] = world.corners(id);
    const LeafPrimitive triangle{{a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z}};
    const ShearedTriangle s = shear(ray, triangle);
    const bool below = s.u < 0.0 || s.v < 0.0 || s.w<0.0, above = s.u> 0.0 || s.v > 0.0 || s.w > 0.0;
    if (below && above) continue;
    TriangleHit hit;
    if (s.u == 0.0 || s.v == 0.0 || s.w == 0.0 || !finish_triangle(ray, triangle, s, hit))
      return std::nullopt;
    crossed += hit.t > 0.0 ? 1 : 0;
  }
  return crossed;
}

}  // namespace

InsideTest::InsideTest(const World& world)
    : world_(&world), objects_(world.scene->instances.size() + world.shapes.size()) {
  for (std::uint32_t id = 0; id < world.primitive_count(); ++id) {
    Object& object = objects_[world.object_of(id)];
    if (object.count++ == 0) object.first = id;
    if (!world.is_triangle(id)) continue;
    for (const Vec3& corner : world.corners(id)) object.box.grow(corner);
  }
  for (Object& object : objects_) {
    if (object.count == 0) continue;
    if (world.is_triangle(object.first)) {
      const WorldPart& part = world.part_of(object.first);
      const std::span<const MeshTriangle> triangles(part.mesh->triangles);
      if (!part.kept()) {
        object.closed = open_edges({part.positions, part.vertex_count()}, triangles) == 0;
        continue;
      }
      std::vector<Vec3> positions(part.vertex_count());
      for (std::uint32_t v = 0; v < positions.size(); ++v) positions[v] = part.position(v);
      object.closed = open_edges(positions, triangles) == 0;
      continue;
    }
    const ShapeGeometry& geometry = world.shape(object.first).geometry;
    object.closed =
        std::holds_alternative<Sphere>(geometry) || (is_solid(geometry) && gnomon::is_closed(geometry));
  }
}

bool InsideTest::contains(std::uint32_t object, const Vec3& point) const {
  const Object& o = objects_[object];
  if (!o.closed) return false;
  if (world_->is_triangle(o.first)) return mesh_contains(o, point);
  const ShapeGeometry& geometry = world_->shape(o.first).geometry;
  if (is_solid(geometry)) return solid_contains(geometry, point);
  const auto& sphere = std::get<Sphere>(geometry);
  const Vec3 offset = point - sphere.center;
  return glm::dot(offset, offset) <= sphere.radius * sphere.radius;
}

bool InsideTest::mesh_contains(const Object& object, const Vec3& point) const {
  for (int axis = 0; axis < 3; ++axis)
    if (!(point[axis] >= object.box.min[axis] && point[axis] <= object.box.max[axis])) return false;
  constexpr int attempts = 32;  // one in some 1e15 rays intersects an edge by chance
  for (int attempt = 0; attempt < attempts; ++attempt) {
    const std::optional<RayFrame> ray = make_ray_frame({point, direction_of(attempt)});
    if (!ray) return false;
    if (const auto count = crossings(*world_, object.first, object.count, *ray)) return *count % 2 == 1;
  }
  return false;  // a point on an edge of the mesh, seen edge-on from everywhere
}

}  // namespace gnomon::raytrace
