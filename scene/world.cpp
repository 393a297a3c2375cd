#include "scene/world.h"

#include <algorithm>

#include "scene/base/parallel.h"
#include "scene/shapes/solid.h"

namespace gnomon {
namespace {

constexpr std::size_t at_a_time = 8192;

/// True when each(i) is for all of 0 … count-1.
template <class Each>
bool all_of_many(std::size_t count, const Each& each) {
  return parallel_reduce(
      count, at_a_time, true,
      [&](std::size_t first, std::size_t last, bool so_far) {
        for (std::size_t i = first; i < last && so_far; ++i) so_far = each(i);
        return so_far;
      },
      [](bool a, bool b) { return a && b; });
}

bool all_below(const Vec3& v, double limit) {
  return std::abs(v.x) < limit && std::abs(v.y) < limit && std::abs(v.z) < limit;  // false for NaN
}

/// Whether moving the mesh by its instance's matrix gives the mesh's own bits. So it does where the matrix is the identity, and
/// no coordinate is one that the arithmetic changes (-0 becomes 0, infinity becomes NaN).
bool stays_in_place(const WorldPart& part) {
  if (part.world_from_object != Mat4(1.0)) return false;
  const auto& positions = part.mesh->positions;
  return all_of_many(positions.size(), [&](std::size_t i) {
    const Vec3& p = positions[i];
    const auto stays = [](double x) { return std::isfinite(x) && !(x == 0.0 && std::signbit(x)); };
    return stays(p.x) && stays(p.y) && stays(p.z);
  });
}

/// Never null, so that a mesh without vertices is not taken for a kept one.
const Vec3* start_of(const std::vector<Vec3>& positions) {
  static constexpr Vec3 none(0.0);
  return positions.empty() ? &none : positions.data();
}

void flatten(World& world, WorldPart& part) {
  if (stays_in_place(part)) {
    part.positions = start_of(part.mesh->positions);
    return;
  }
  const auto moved = std::make_shared<std::vector<Vec3>>(part.mesh->positions.size());
  parallel_for(moved->size(), at_a_time, [&](std::size_t i) {
    (*moved)[i] = placed_vertex(part.world_from_object, part.mesh->positions[i]);
  });
  part.positions = start_of(*moved);
  world.moved.push_back(moved);
}

/// Cuts the parts into blocks, and finds the bounds of these, of the parts and of all together.
void make_blocks(World& world) {
  for (std::uint32_t p = 0; p < world.parts.size(); ++p) {
    const WorldPart& part = world.parts[p];
    const std::uint32_t count = part.triangle_count();
    const std::uint32_t most = part.kept() ? TriangleBlock::most_of_kept : TriangleBlock::most;
    for (std::uint32_t first = 0; first < count; first += std::min(most, count - first))
      world.blocks.push_back({p, first, std::min(most, count - first), {}});
  }
  parallel_for(world.blocks.size(), [&](std::size_t b) {
    TriangleBlock& block = world.blocks[b];
    for (std::uint32_t i = 0; i < block.count; ++i)
      for (const Vec3& corner : world.parts[block.part].corners(block.first + i)) block.bounds.grow(corner);
  });
  for (const TriangleBlock& block : world.blocks) world.parts[block.part].bounds.grow(block.bounds);
  for (const WorldPart& part : world.parts) world.finite_bounds.grow(part.bounds);
}

/// Beyond these sizes the boxes of a shared tree, which are floats, could overflow on their way into the world.
constexpr double largest_coordinate = 1e15;

bool is_tame(const Mesh& mesh) {
  return all_of_many(mesh.positions.size(),
                     [&](std::size_t i) { return all_below(mesh.positions[i], largest_coordinate); });
}

/// A kept instance shares its mesh's tree, so each of its triangles must be one that rays can hit just when that of
/// the mesh is. Rounding may take a triangle's area.
bool can_be_kept(const WorldPart& part) {
  if (part.turned) return false;  // the tree's corners are in the mesh's order
  for (int c = 0; c < 4; ++c)
    if (!all_below(Vec3(part.world_from_object[c]), largest_coordinate)) return false;
  if (Vec4(part.world_from_object[0][3], part.world_from_object[1][3], part.world_from_object[2][3],
           part.world_from_object[3][3]) != Vec4(0.0, 0.0, 0.0, 1.0))
    return false;
  const Mesh& mesh = *part.mesh;
  return all_of_many(part.triangle_count(), [&](std::size_t i) {
    const auto& t = mesh.triangles[i];
    const std::array<Vec3, 3> corners = part.corners(i);
    return has_surface(corners) ==
               has_surface({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]}) &&
           all_below(corners[0], largest_coordinate) && all_below(corners[1], largest_coordinate) &&
           all_below(corners[2], largest_coordinate);
  });
}

/// Instances of meshes with fewer triangles are not worth a tree of their own.
constexpr std::size_t few_triangles = 64;

// All of its triangles, or none: neighbours stay of one orientation.
bool is_turned_round(const Scene& scene, const Mesh& mesh, const MeshInstance& instance) {
  if (!(glm::determinant(Mat3(instance.world_from_object)) < 0.0)) return false;
  if (mesh.triangle_materials.empty()) return !shows_back(scene.materials[instance.material]);
  return std::any_of(mesh.triangle_materials.begin(), mesh.triangle_materials.end(),
                     [&](std::uint32_t m) { return !shows_back(scene.materials[m]); });
}

std::vector<std::uint32_t> uses_of_meshes(const Scene& scene) {
  std::vector<std::uint32_t> uses(scene.meshes.size());
  for (const MeshInstance& instance : scene.instances) ++uses[instance.mesh];
  return uses;
}

/// Tells of each mesh whether its instances are to be kept where they can be.
std::vector<char> kept_meshes(const Scene& scene, InstanceChoice choice) {
  std::vector<char> kept(scene.meshes.size(), 0);
  if (choice == InstanceChoice::flatten ||
      (choice == InstanceChoice::automatic && !plan_instances(scene).keep))
    return kept;
  const std::vector<std::uint32_t> uses = uses_of_meshes(scene);
  const bool all = choice == InstanceChoice::keep;
  for (std::size_t m = 0; m < kept.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    kept[m] = uses[m] > (all ? 0 : 1) && mesh.triangles.size() >= (all ? 1 : few_triangles) && is_tame(mesh);
  }
  return kept;
}

void number_parts(World& world) {
  std::vector<std::uint32_t> vertices{0}, triangles{0};
  for (WorldPart& part : world.parts) {
    part.first_vertex = vertices.back(), part.first_triangle = triangles.back();
    vertices.push_back(part.first_vertex + part.vertex_count());
    triangles.push_back(part.first_triangle + part.triangle_count());
  }
  world.vertex_ranges = Ranges(std::move(vertices)), world.triangle_ranges = Ranges(std::move(triangles));
}

void make_parts(World& world, const std::vector<char>& kept) {
  const Scene& scene = *world.scene;
  world.parts.reserve(scene.instances.size());
  for (const MeshInstance& instance : scene.instances) {
    WorldPart part;
    part.mesh = &scene.meshes[instance.mesh];
    part.world_from_object = instance.world_from_object;
    // A mirrored instance of two-sided materials keeps its authored winding, so the normal that the right-hand rule
    // gives points inwards: who needs the outer side asks outward_normal().
    part.normal_from_object = glm::transpose(glm::inverse(Mat3(instance.world_from_object)));
    part.material = instance.material;
    part.turned = is_turned_round(scene, *part.mesh, instance);
    world.parts.push_back(part);
  }
  number_parts(world);
  std::vector<char> flat(world.parts.size());
  parallel_for(world.parts.size(), [&](std::size_t i) {
    flat[i] = kept[scene.instances[i].mesh] == 0 || !can_be_kept(world.parts[i]);
  });
  for (std::size_t i = 0; i < world.parts.size(); ++i)
    if (flat[i] != 0) flatten(world, world.parts[i]);
  make_blocks(world);
}

}  // namespace

InstancePlan plan_instances(const Scene& scene) {
  // Bytes that a triangle takes in the tracer's and the comparison's structures (190, measured on five million) and in
  // the rasterizer's buffers (80, where triangles share no vertices); and what an instance takes in all of them.
  constexpr std::uint64_t flat_triangle = 190 + 80, kept_instance = 1024;
  constexpr std::uint64_t small = std::uint64_t{512} << 20;  // flattened scenes are traced faster
  InstancePlan plan;
  const std::vector<std::uint32_t> uses = uses_of_meshes(scene);
  for (std::size_t m = 0; m < uses.size(); ++m) {
    const std::uint64_t triangles = scene.meshes[m].triangles.size();
    if (uses[m] < 2 || triangles < few_triangles) continue;
    ++plan.meshes, plan.mesh_triangles += triangles;
    plan.instances += uses[m], plan.triangles += uses[m] * triangles;
  }
  plan.flat_bytes = plan.triangles * flat_triangle;
  plan.kept_bytes = plan.mesh_triangles * flat_triangle + plan.instances * kept_instance;
  plan.keep = plan.flat_bytes > plan.kept_bytes && plan.flat_bytes > small;
  return plan;
}

World make_world(const Scene& scene, InstanceChoice choice) {
  World world;
  world.scene = &scene;
  make_parts(world, kept_meshes(scene, choice));
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

World make_world(const Scene& scene, const Mesh& mesh) {
  World world;
  world.scene = &scene;
  WorldPart part;
  part.mesh = &mesh, part.positions = start_of(mesh.positions);
  world.parts.push_back(part);
  number_parts(world);
  make_blocks(world);
  return world;
}

bool World::has_colors() const {
  return std::any_of(parts.begin(), parts.end(),
                     [](const WorldPart& part) { return !part.mesh->colors.empty(); });
}

bool World::has_normals() const {
  return std::any_of(parts.begin(), parts.end(), [](const WorldPart& part) {
    return !all_of_many(part.mesh->normals.size(),
                        [&](std::size_t i) { return part.normal(i) == Vec3f(0.0f); });
  });
}

bool World::keeps_instances() const {
  return std::any_of(parts.begin(), parts.end(), [](const WorldPart& part) { return part.kept(); });
}

std::vector<Vec3> positions_of(const World& world) {
  std::vector<Vec3> out(world.vertex_count());
  for (const WorldPart& part : world.parts)
    for (std::uint32_t v = 0; v < part.vertex_count(); ++v) out[part.first_vertex + v] = part.position(v);
  return out;
}

std::vector<std::array<std::uint32_t, 3>> triangles_of(const World& world) {
  std::vector<std::array<std::uint32_t, 3>> out(world.triangle_count());
  for (std::uint32_t t = 0; t < out.size(); ++t) out[t] = world.triangle(t);
  return out;
}

// Normals transform by the inverse transpose.
Vec3f WorldPart::normal(std::size_t vertex) const {
  if (mesh->normals.empty()) return Vec3f(0.0f);
  const Vec3 n = normal_from_object * Vec3(mesh->normals[vertex]);
  const double length = glm::length(n);
  return length > 0.0 ? Vec3f(n / length) : Vec3f(0.0f);
}

Vec3 geometric_normal(const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vec3 n = glm::cross(b - a, c - a);
  const double length = glm::length(n);
  return length > 0.0 ? n / length : Vec3(0.0);
}

bool has_surface(const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vec3 n = glm::cross(b - a, c - a);
  const double size2 = glm::dot(n, n);
  if (size2 > 1e-280 && size2 < 1e280) return true;  // and so all is finite: the common case, without a root
  const auto finite = [](const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  return finite(a) && finite(b) && finite(c) && geometric_normal(corners) != Vec3(0.0);
}

Vec3 geometric_normal(const World& world, std::uint32_t primitive, const Vec3& position) {
  if (world.is_triangle(primitive)) return geometric_normal(world.corners(primitive));
  const auto& geometry = world.shape(primitive).geometry;
  if (const auto* sphere = std::get_if<Sphere>(&geometry)) return glm::normalize(position - sphere->center);
  if (is_solid(geometry)) return solid_normal(geometry, position);
  return std::get<Plane>(geometry).normal;
}

Vec3 outward_normal(const World& world, std::uint32_t primitive, const Vec3& position) {
  const Vec3 normal = geometric_normal(world, primitive, position);
  return world.is_triangle(primitive) && world.part_of(primitive).is_inside_out() ? -normal : normal;
}

}  // namespace gnomon
