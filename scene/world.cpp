#include "scene/world.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>

#include "scene/solid.h"

namespace gnomon {
namespace {

// Normals transform by the inverse transpose; a mirrored instance keeps its authored winding, so the normal
// that the right-hand rule gives may point inwards. Everything here is two-sided, so only consistency
// matters.
void put_vertex(World& world, const Mesh& mesh, const Mat4& world_from_object, const Mat3& normal_from_object,
                std::size_t base, std::size_t i) {
  world.positions[base + i] = Vec3(world_from_object * Vec4(mesh.positions[i], 1.0));
  Vec3f normal(0.0f);
  if (!mesh.normals.empty()) {
    const Vec3 n = normal_from_object * Vec3(mesh.normals[i]);
    const double length = glm::length(n);
    if (length > 0.0) normal = Vec3f(n / length);
  }
  world.normals[base + i] = normal;
  world.uvs[base + i] = mesh.uvs.empty() ? Vec2f(0.0f) : mesh.uvs[i];
  if (!mesh.colors.empty()) world.colors[base + i] = mesh.colors[i];
}

// All of its triangles, or none: neighbours stay of one orientation.
bool is_turned_round(const Scene& scene, const Mesh& mesh, const MeshInstance& instance) {
  if (!(glm::determinant(Mat3(instance.world_from_object)) < 0.0)) return false;
  if (mesh.triangle_materials.empty()) return !shows_back(scene.materials[instance.material]);
  return std::any_of(mesh.triangle_materials.begin(), mesh.triangle_materials.end(),
                     [&](std::uint32_t m) { return !shows_back(scene.materials[m]); });
}

struct Place {
  std::size_t vertex = 0, triangle = 0;
};

constexpr std::size_t at_a_time = 8192;

void put_instance(World& world, const Mesh& mesh, const MeshInstance& instance, std::uint32_t object,
                  const Place& base) {
  using Range = tbb::blocked_range<std::size_t>;
  const Mat3 normal_from_object = glm::transpose(glm::inverse(Mat3(instance.world_from_object)));
  tbb::parallel_for(Range(0, mesh.positions.size(), at_a_time), [&](const Range& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      put_vertex(world, mesh, instance.world_from_object, normal_from_object, base.vertex, i);
  });
  const auto first = static_cast<std::uint32_t>(base.vertex);
  const bool turned = is_turned_round(*world.scene, mesh, instance);
  // The left part's bounds come first: of zeros of both signs the first one stays, as in one thread.
  world.finite_bounds.grow(tbb::parallel_reduce(
      Range(0, mesh.triangles.size(), at_a_time), Aabb{},
      [&](const Range& range, Aabb bounds) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          const auto& t = mesh.triangles[i];
          const std::size_t at = base.triangle + i;
          world.triangles[at] = {first + t[0], first + t[turned ? 2 : 1], first + t[turned ? 1 : 2]};
          world.triangle_material[at] =
              mesh.triangle_materials.empty() ? instance.material : mesh.triangle_materials[i];
          world.triangle_object[at] = object;
          for (const std::uint32_t corner : t) bounds.grow(world.positions[first + corner]);
        }
        return bounds;
      },
      [](Aabb left, const Aabb& right) {
        left.grow(right);
        return left;
      }));
}

void put_instances(World& world, const Scene& scene) {
  Place end;
  bool has_colors = false;
  for (const MeshInstance& instance : scene.instances) {
    has_colors = has_colors || !scene.meshes[instance.mesh].colors.empty();
    end.vertex += scene.meshes[instance.mesh].positions.size();
    end.triangle += scene.meshes[instance.mesh].triangles.size();
  }
  world.positions.resize(end.vertex), world.normals.resize(end.vertex), world.uvs.resize(end.vertex);
  if (has_colors) world.colors.resize(end.vertex, Vec4f(1.0f));
  world.triangles.resize(end.triangle), world.triangle_material.resize(end.triangle);
  world.triangle_object.resize(end.triangle);
  Place base;
  std::uint32_t object = 0;
  for (const MeshInstance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    put_instance(world, mesh, instance, object++, base);
    base.vertex += mesh.positions.size(), base.triangle += mesh.triangles.size();
  }
}

}  // namespace

World make_world(const Scene& scene) {
  World world;
  world.scene = &scene;
  put_instances(world, scene);
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
