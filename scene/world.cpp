#include "scene/world.h"

#include "scene/solid.h"

namespace gnomon {
namespace {

// Normals transform by the inverse transpose; a mirrored instance keeps its authored winding, so the normal
// that the right-hand rule gives may point inwards. Everything here is two-sided, so only consistency
// matters.
void append_instance(World& world, const Mesh& mesh, const MeshInstance& instance, std::uint32_t object) {
  const auto base = static_cast<std::uint32_t>(world.positions.size());
  const Mat3 normal_from_object = glm::transpose(glm::inverse(Mat3(instance.world_from_object)));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3 p = Vec3(instance.world_from_object * Vec4(mesh.positions[i], 1.0));
    world.positions.push_back(p);
    Vec3f normal(0.0f);
    if (!mesh.normals.empty()) {
      const Vec3 n = normal_from_object * Vec3(mesh.normals[i]);
      const double length = glm::length(n);
      if (length > 0.0) normal = Vec3f(n / length);
    }
    world.normals.push_back(normal);
    world.uvs.push_back(mesh.uvs.empty() ? Vec2f(0.0f) : mesh.uvs[i]);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    world.triangles.push_back({base + t[0], base + t[1], base + t[2]});
    world.triangle_material.push_back(mesh.triangle_materials.empty() ? instance.material
                                                                      : mesh.triangle_materials[i]);
    world.triangle_object.push_back(object);
    for (const std::uint32_t corner : t) world.finite_bounds.grow(world.positions[base + corner]);
  }
}

}  // namespace

World make_world(const Scene& scene) {
  World world;
  world.scene = &scene;
  std::uint32_t object = 0;
  for (const MeshInstance& instance : scene.instances)
    append_instance(world, scene.meshes[instance.mesh], instance, object++);
  world.shapes = scene.shapes;
  for (const Shape& shape : scene.shapes) {
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
      world.finite_bounds.grow(sphere->center - Vec3(sphere->radius));
      world.finite_bounds.grow(sphere->center + Vec3(sphere->radius));
    } else if (is_solid(shape.geometry)) {
      world.finite_bounds.grow(world_box(shape.geometry));
    }
  }
  return world;
}

std::uint32_t World::object_of(std::uint32_t primitive) const {
  if (is_triangle(primitive)) return triangle_object[primitive];
  return static_cast<std::uint32_t>(scene->instances.size()) + (primitive - triangle_count());
}

Vec3 geometric_normal(const World& world, std::uint32_t primitive, const Vec3& position) {
  if (world.is_triangle(primitive)) {
    const auto [a, b, c] = world.corners(primitive);
    const Vec3 n = glm::cross(b - a, c - a);
    const double length = glm::length(n);
    return length > 0.0 ? n / length : Vec3(0.0);
  }
  const auto& geometry = world.shape(primitive).geometry;
  if (const auto* sphere = std::get_if<Sphere>(&geometry)) return glm::normalize(position - sphere->center);
  if (is_solid(geometry)) return solid_normal(geometry, position);
  return std::get<Plane>(geometry).normal;
}

}  // namespace gnomon
