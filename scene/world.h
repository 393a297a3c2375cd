// The scene as both renderers draw it: triangles in world space, in double precision. Primitives have one
// numbering: triangles 0 … T-1 (instance by instance), then shapes T … T+S-1. Objects are numbered the same way:
// instances first, then shapes. Meshes are never copied. Where a mesh stands once, or is small, its corners are
// moved into the world once (it is *flattened*); an instance that is *kept* has its corners computed when they
// are asked for. Both ways give the same bits, so whoever asks for corners need not know which it is.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene/base/ranges.h"
#include "scene/scene.h"

namespace gnomon {

/// Where a vertex of a mesh lies in the world. Everywhere the same operations in the same order.
inline Vec3 placed_vertex(const Mat4& world_from_object, const Vec3& p) {
  return Vec3(world_from_object * Vec4(p, 1.0));
}

/// One instance in the world; its number is that in Scene::instances.
struct WorldPart {
  const Mesh* mesh = nullptr;
  const Vec3* positions = nullptr;  ///< in the world, of the mesh's vertices; null: the instance is kept
  Mat4 world_from_object{1.0};
  Mat3 normal_from_object{1.0};
  std::uint32_t first_vertex = 0, first_triangle = 0, material = 0;
  /// Tells that the second and the third corner of every triangle change places. They do so in a mirrored instance with
  /// single-sided materials. Their front is then again the side from which they run counter-clockwise.
  bool turned = false;
  Aabb bounds;  ///< of the triangles' corners, in the world

  bool kept() const { return positions == nullptr; }
  /// Mirrored, its corners as the mesh has them: they run clockwise as seen from a triangle's front, and the
  /// right-hand rule gives normals that point to its back.
  bool is_inside_out() const { return !turned && glm::determinant(Mat3(world_from_object)) < 0.0; }
  std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(mesh->triangles.size()); }
  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(mesh->positions.size()); }
  /// By the mesh's own numbers.
  Vec3 position(std::size_t vertex) const {
    return kept() ? placed_vertex(world_from_object, mesh->positions[vertex]) : positions[vertex];
  }
  std::array<std::uint32_t, 3> triangle(std::size_t number) const {
    const auto& t = mesh->triangles[number];
    return turned ? std::array{t[0], t[2], t[1]} : t;
  }
  std::array<Vec3, 3> corners(std::size_t number) const {
    const auto t = triangle(number);
    return {position(t[0]), position(t[1]), position(t[2])};
  }
  /// Unit length; zero where the mesh has none.
  Vec3f normal(std::size_t vertex) const;
  Vec4f color(std::size_t vertex) const { return mesh->colors.empty() ? Vec4f(1.0f) : mesh->colors[vertex]; }
  std::uint32_t material_of(std::size_t triangle) const {
    return mesh->triangle_materials.empty() ? material : mesh->triangle_materials[triangle];
  }
};

/// Consecutive triangles of a part.
struct TriangleBlock {
  static constexpr std::uint32_t most = 1024, most_of_kept = 65536;
  std::uint32_t part = 0, first = 0, count = 0;  ///< first: by the part's own numbers
  Aabb bounds;                                   ///< of the triangles' corners, in the world
};

struct World {
  const Scene* scene = nullptr;  ///< meshes, materials, textures, lights; must outlive the World
  std::vector<WorldPart> parts;
  std::vector<TriangleBlock> blocks;      ///< of the parts, in their order
  Ranges triangle_ranges, vertex_ranges;  ///< of the parts
  std::span<const Shape> shapes;          ///< in world space already

  Aabb finite_bounds;  ///< of everything but planes
  /// The middle of all that is finite, about which lamps turn.
  Vec3 middle() const { return finite_bounds.empty() ? Vec3(0.0) : finite_bounds.center(); }

  std::uint32_t triangle_count() const { return triangle_ranges.size(); }
  std::uint32_t vertex_count() const { return vertex_ranges.size(); }
  std::uint32_t primitive_count() const {
    return triangle_count() + static_cast<std::uint32_t>(shapes.size());
  }
  bool is_triangle(std::uint32_t primitive) const { return primitive < triangle_count(); }
  const Shape& shape(std::uint32_t primitive) const { return shapes[primitive - triangle_count()]; }
  std::uint32_t material_of(std::uint32_t primitive) const {
    if (!is_triangle(primitive)) return shape(primitive).material;
    const WorldPart& part = part_of(primitive);
    return part.material_of(primitive - part.first_triangle);
  }
  std::uint32_t object_of(std::uint32_t primitive) const {
    return is_triangle(primitive) ? triangle_ranges.of(primitive)
                                  : static_cast<std::uint32_t>(parts.size()) + (primitive - triangle_count());
  }
  /// Whether shadow rays may pass where they hit it: its material has an alpha mask, or casts no shadow.
  bool is_masked(std::uint32_t primitive) const {
    const Material& material = scene->materials[material_of(primitive)];
    return material.alpha_mode == AlphaMode::mask || !material.casts_shadow;
  }
  bool casts_shadow(std::uint32_t primitive) const {
    return scene->materials[material_of(primitive)].casts_shadow;
  }
  bool receives_shadow(std::uint32_t primitive) const {
    return scene->materials[material_of(primitive)].receives_shadow;
  }
  /// Returns the part that a triangle belongs to.
  const WorldPart& part_of(std::uint32_t triangle) const { return parts[triangle_ranges.of(triangle)]; }
  /// The numbers of a triangle's vertices.
  std::array<std::uint32_t, 3> triangle(std::uint32_t number) const {
    const WorldPart& part = part_of(number);
    const auto t = part.triangle(number - part.first_triangle);
    return {part.first_vertex + t[0], part.first_vertex + t[1], part.first_vertex + t[2]};
  }
  std::array<Vec3, 3> corners(std::uint32_t triangle) const {
    const WorldPart& part = part_of(triangle);
    return part.corners(triangle - part.first_triangle);
  }
  Vec3 position(std::uint32_t vertex) const {
    const WorldPart& part = parts[vertex_ranges.of(vertex)];
    return part.position(vertex - part.first_vertex);
  }
  /// Returns the vertex's normal, as WorldPart::normal does.
  Vec3f normal(std::uint32_t vertex) const {
    const WorldPart& part = parts[vertex_ranges.of(vertex)];
    return part.normal(vertex - part.first_vertex);
  }
  /// Zero where the mesh has none.
  Vec2f uv(std::uint32_t vertex) const {
    const WorldPart& part = parts[vertex_ranges.of(vertex)];
    return part.mesh->uvs.empty() ? Vec2f(0.0f) : part.mesh->uvs[vertex - part.first_vertex];
  }
  /// White where the mesh has none.
  Vec4f color(std::uint32_t vertex) const {
    const WorldPart& part = parts[vertex_ranges.of(vertex)];
    return part.color(vertex - part.first_vertex);
  }
  bool has_colors() const;
  bool has_normals() const;  ///< of length above zero
  bool keeps_instances() const;

  /// The positions of flattened parts that are not those of their mesh; shared by copies of this.
  std::vector<std::shared_ptr<const std::vector<Vec3>>> moved;
};

/// What becomes of instances.
enum class InstanceChoice : std::uint8_t {
  automatic,  ///< as plan_instances() finds best
  keep,       ///< all that can be; those of meshes that stand once as well
  flatten
};

/// What keeping a scene's instances is about.
struct InstancePlan {
  bool keep = false;            ///< whether the instances of repeated meshes are worth keeping
  std::uint64_t instances = 0;  ///< of meshes that stand more than once and are not small
  std::uint64_t meshes = 0;     ///< those meshes
  std::uint64_t triangles = 0;  ///< of those instances
  std::uint64_t mesh_triangles = 0;
  std::uint64_t flat_bytes = 0;  ///< that flattening these instances would take, in both renderers together
  std::uint64_t kept_bytes = 0;  ///< that keeping them takes
};
InstancePlan plan_instances(const Scene& scene);

World make_world(const Scene& scene, InstanceChoice choice = InstanceChoice::automatic);
/// A mesh alone, where it is; the scene is for its materials.
World make_world(const Scene& scene, const Mesh& mesh);

/// All of them, by their numbers: for those who hand the world to somebody else.
std::vector<Vec3> positions_of(const World& world);
std::vector<std::array<std::uint32_t, 3>> triangles_of(const World& world);

/// Geometric normal of a primitive at a point on it, unit length. Of a shape it points outwards, of a
/// triangle it follows the right-hand rule (zero for a degenerate triangle). That says nothing about what is
/// outside where a part is mirrored.
Vec3 geometric_normal(const World& world, std::uint32_t primitive, const Vec3& position);
Vec3 geometric_normal(const std::array<Vec3, 3>& corners);
/// Returns the normal that points out, but of a triangle to its front (scene/scene.h, shows_back), mirrored or not.
Vec3 outward_normal(const World& world, std::uint32_t primitive, const Vec3& position);
/// Whether rays can hit a triangle: it is finite and has an area.
bool has_surface(const std::array<Vec3, 3>& corners);

}  // namespace gnomon
