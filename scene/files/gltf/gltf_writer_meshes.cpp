// Meshes, one primitive for each material, and a node for each instance.
#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>

#include "scene/files/gltf/gltf_writer_parts.h"

namespace gnomon::gltf_writer {
namespace {

constexpr int vertex_target = 34962, index_target = 34963;
constexpr int type_float = 5126, type_short = 5123, type_int = 5125;

/// Triangles of one material (of the mesh's own; no_id: the instance's) that become one primitive.
struct Group {
  std::uint32_t material = no_id;
  bool flat = false;  ///< has no normals: a corner of each of them has none
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A primitive but for its material, and the mesh's own material, if it has one.
struct Primitive {
  Json json;
  std::uint32_t material = no_id;
};

bool is_flat(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  return mesh.normals.empty() ||
         std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return mesh.normals[v] == Vec3f(0.0f); });
}

std::vector<Group> groups_of(const Mesh& mesh) {
  std::vector<Group> groups;
  std::map<std::pair<std::uint32_t, bool>, std::size_t> known;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t material = mesh.triangle_materials.empty() ? no_id : mesh.triangle_materials[i];
    const bool flat = is_flat(mesh, mesh.triangles[i]);
    const auto [at, is_new] = known.try_emplace({material, flat}, groups.size());
    if (is_new) groups.push_back({material, flat, {}});
    groups[at->second].triangles.push_back(mesh.triangles[i]);
  }
  return groups;
}

/// Our vertices that a group's primitive has, in their order: all of them where it is the only group.
std::vector<std::uint32_t> vertices_of(const Mesh& mesh, const Group& group) {
  const bool all = group.triangles.size() == mesh.triangles.size();
  std::vector<char> used(mesh.positions.size(), all ? 1 : 0);
  for (const auto& t : group.triangles)
    for (const std::uint32_t v : t) used[v] = 1;
  std::vector<std::uint32_t> out;
  for (std::uint32_t v = 0; v < used.size(); ++v)
    if (used[v] != 0) out.push_back(v);
  return out;
}

template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::size_t add_accessor(File& file, std::size_t view, int component, std::size_t count, const char* type) {
  return file.add("accessors",
                  {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
}

std::size_t add_positions(File& file, const std::vector<Vec3f>& positions) {
  Vec3f low(positions.front()), high(positions.front());
  for (const Vec3f& p : positions) low = glm::min(low, p), high = glm::max(high, p);
  const std::size_t accessor = add_accessor(file, file.add_view(bytes_of(positions), vertex_target),
                                            type_float, positions.size(), "VEC3");
  file.json["accessors"][accessor]["min"] = array(Vec3(low));
  file.json["accessors"][accessor]["max"] = array(Vec3(high));
  return accessor;
}

/// 65535 itself would begin a new primitive (glTF 2.0, section 3.7.2.1).
std::size_t add_indices(File& file, const std::vector<std::uint32_t>& indices, std::size_t vertices) {
  if (vertices > 65535)
    return add_accessor(file, file.add_view(bytes_of(indices), index_target), type_int, indices.size(),
                        "SCALAR");
  const std::vector<std::uint16_t> small(indices.begin(), indices.end());
  return add_accessor(file, file.add_view(bytes_of(small), index_target), type_short, small.size(), "SCALAR");
}

/// glTF wants normals of length one.
Vec3f unit_normal(const Vec3f& n) {
  constexpr float rounding = 1e-6f;
  return std::abs(glm::dot(n, n) - 1.0f) <= rounding ? n : Vec3f(glm::normalize(Vec3(n)));
}

Primitive add_group(File& file, const Mesh& mesh, const Group& group, const Vec3& offset) {
  const std::vector<std::uint32_t> vertices = vertices_of(mesh, group);
  std::vector<std::uint32_t> place(mesh.positions.size(), no_id), indices;
  std::vector<Vec3f> positions, normals;
  std::vector<Vec2f> uvs;
  std::vector<Vec4f> colors;
  for (const std::uint32_t v : vertices) {
    place[v] = static_cast<std::uint32_t>(positions.size());
    positions.emplace_back(mesh.positions[v] - offset);
    if (!group.flat) {
      // A vertex that no triangle uses may have none.
      const Vec3f n = mesh.normals[v] == Vec3f(0.0f) ? Vec3f(0.0f, 0.0f, 1.0f) : mesh.normals[v];
      normals.push_back(unit_normal(n));
    }
    if (!mesh.uvs.empty()) uvs.push_back(mesh.uvs[v]);
    if (!mesh.colors.empty()) colors.push_back(mesh.colors[v]);
  }
  for (const auto& t : group.triangles)
    for (const std::uint32_t v : t) indices.push_back(place[v]);
  Json attributes{{"POSITION", add_positions(file, positions)}};
  if (!normals.empty())
    attributes["NORMAL"] = add_accessor(file, file.add_view(bytes_of(normals), vertex_target), type_float,
                                        normals.size(), "VEC3");
  if (!uvs.empty())
    attributes["TEXCOORD_0"] =
        add_accessor(file, file.add_view(bytes_of(uvs), vertex_target), type_float, uvs.size(), "VEC2");
  if (!colors.empty())
    attributes["COLOR_0"] =
        add_accessor(file, file.add_view(bytes_of(colors), vertex_target), type_float, colors.size(), "VEC4");
  return {{{"attributes", std::move(attributes)}, {"indices", add_indices(file, indices, positions.size())}},
          group.material};
}

/// What is taken from all positions before they become floats, and given to the nodes instead: a mesh that
/// lies far from its origin keeps its digits.
Vec3 offset_of(const Mesh& mesh) {
  Aabb bounds;
  bool exact = true;
  for (const Vec3& p : mesh.positions) {
    bounds.grow(p);
    exact = exact && Vec3(Vec3f(p)) == p;
  }
  constexpr double worth_it = 4.0;  // two bits are won
  const Vec3 center = bounds.center(), half = 0.5 * bounds.extent();
  const auto largest = [](const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
  return exact || largest(center) <= worth_it * largest(half) ? Vec3(0.0) : Vec3(Vec3f(center));
}

/// glTF's matrices are a translation, a rotation and a scale (3.5.3.1): their columns are at right angles.
bool is_sheared(const Mat3& m) {
  constexpr double rounding = 1e-6;
  for (int a = 0; a < 3; ++a) {
    const Vec3 &x = m[a], &y = m[(a + 1) % 3];
    if (std::abs(glm::dot(x, y)) > rounding * glm::length(x) * glm::length(y)) return true;
  }
  return false;
}

/// The mesh with the instance's shear in it, and turned where that mirrors: the node's matrix no longer says so.
Mesh sheared(Mesh mesh, const Mat3& linear) {
  const Mat3 of_normals = glm::transpose(glm::inverse(linear));
  for (Vec3& p : mesh.positions) p = linear * p;
  for (Vec3f& n : mesh.normals)
    if (n != Vec3f(0.0f)) n = Vec3f(glm::normalize(of_normals * Vec3(n)));
  if (glm::determinant(linear) < 0.0)
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

class InstanceWriter {
 public:
  InstanceWriter(File& file, const Scene& scene) : file_(file), scene_(scene) {}

  void run() {
    for (const MeshInstance& instance : scene_.instances) {
      if (scene_.meshes[instance.mesh].triangles.empty()) continue;
      is_sheared(Mat3(instance.world_from_object)) ? add_sheared(instance) : add_shared(instance);
    }
    if (sheared_ > 0)
      file_.notes.push_back(fmt::format("{} sheared instance{} a mesh of its own: glTF's nodes cannot shear.",
                                        sheared_, sheared_ == 1 ? " has" : "s have each"));
  }

 private:
  struct Shared {
    Vec3 offset{0.0};
    std::vector<Primitive> primitives;
    std::map<std::uint32_t, std::size_t> gltf_mesh;  // of an instance's material
  };

  Shared geometry(const Mesh& mesh) {
    Shared shared;
    shared.offset = offset_of(mesh);
    for (const Group& group : groups_of(mesh))
      shared.primitives.push_back(add_group(file_, mesh, group, shared.offset));
    return shared;
  }

  std::size_t add_mesh(const std::string& name, const Shared& shared, std::uint32_t material) {
    Json primitives = Json::array();
    for (const Primitive& primitive : shared.primitives) {
      primitives.push_back(primitive.json);
      primitives.back()["material"] = primitive.material == no_id ? material : primitive.material;
    }
    Json mesh{{"primitives", std::move(primitives)}};
    if (!name.empty()) mesh["name"] = name;
    return file_.add("meshes", std::move(mesh));
  }

  void add_node(const MeshInstance& instance, std::size_t mesh, const Mat4& matrix) {
    Json node{{"mesh", mesh}};
    if (!instance.name.empty()) node["name"] = instance.name;
    if (matrix != Mat4(1.0)) node["matrix"] = array(matrix);
    file_.add("nodes", std::move(node));
  }

  void add_shared(const MeshInstance& instance) {
    const Mesh& mesh = scene_.meshes[instance.mesh];
    const auto [at, is_new] = shared_.try_emplace(instance.mesh);
    if (is_new) at->second = geometry(mesh);
    Shared& shared = at->second;
    const std::uint32_t material = mesh.triangle_materials.empty() ? instance.material : no_id;
    const auto [known, first] = shared.gltf_mesh.try_emplace(material, 0);
    if (first) known->second = add_mesh(mesh.name, shared, material);
    Mat4 matrix = instance.world_from_object;
    if (shared.offset != Vec3(0.0)) matrix[3] = matrix * Vec4(shared.offset, 1.0);
    add_node(instance, known->second, matrix);
  }

  void add_sheared(const MeshInstance& instance) {
    ++sheared_;
    const Mesh mesh = sheared(scene_.meshes[instance.mesh], Mat3(instance.world_from_object));
    const Shared shared = geometry(mesh);
    Mat4 matrix(1.0);
    matrix[3] = instance.world_from_object[3] + Vec4(shared.offset, 0.0);
    add_node(instance, add_mesh(mesh.name, shared, instance.material), matrix);
  }

  File& file_;
  const Scene& scene_;
  std::map<std::uint32_t, Shared> shared_;
  std::size_t sheared_ = 0;
};

}  // namespace

void write_instances(File& file, const Scene& scene) {
  InstanceWriter(file, scene).run();
}

}  // namespace gnomon::gltf_writer
