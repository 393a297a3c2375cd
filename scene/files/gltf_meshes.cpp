#include "scene/files/gltf_meshes.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <numeric>

#include "scene/files/gltf_accessor.h"
#include "scene/files/validate.h"

namespace gnomon {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

// glTF 2.0, section 3.7.2.1; a strip's every other triangle is turned round, and its stitches are dropped.
std::vector<Triangle> assemble(int mode, const std::vector<std::uint32_t>& v) {
  std::vector<Triangle> out;
  if (mode == TINYGLTF_MODE_TRIANGLES)
    for (std::size_t i = 0; i + 2 < v.size(); i += 3) out.push_back({v[i], v[i + 1], v[i + 2]});
  if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
    for (std::size_t i = 1; i + 1 < v.size(); ++i) out.push_back({v[i], v[i + 1], v[0]});
  if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
    for (std::size_t i = 0; i + 2 < v.size(); ++i) {
      if (v[i] == v[i + 1] || v[i + 1] == v[i + 2] || v[i] == v[i + 2]) continue;
      out.push_back({v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
    }
  return out;
}

class GltfMeshReader {
 public:
  GltfMeshReader(const tinygltf::Model& model, const TexcoordSets& sets, std::uint32_t default_material,
                 const std::string& file)
      : model_(model), sets_(sets), default_material_(default_material), file_(file) {}

  Expected<GltfMeshes> run(Scene& scene) {
    std::vector<Mesh> meshes;
    for (std::size_t m = 0; m < model_.meshes.size(); ++m) {
      const tinygltf::Mesh& from = model_.meshes[m];
      Mesh mesh;
      mesh.name = from.name.empty() ? fmt::format("mesh-{}", m + 1) : from.name;
      for (std::size_t p = 0; p < from.primitives.size(); ++p) {
        const auto added =
            add_primitive(mesh, from.primitives[p], fmt::format("meshes[{}].primitives[{}]", m, p));
        if (!added) return fail(added.error());
      }
      drop_empty(mesh);
      meshes.push_back(std::move(mesh));
    }
    add_notes(scene);
    return GltfMeshes{std::move(meshes), skipped_ > 0};
  }

 private:
  tl::unexpected<Error> error(std::string field, std::string reason) const {
    return fail(Error{ErrorKind::bad_input, std::move(reason), file_, 0, 0, std::move(field)});
  }

  static int attribute(const tinygltf::Primitive& primitive, const std::string& name) {
    const auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? -1 : found->second;
  }

  Expected<void> add_primitive(Mesh& mesh, const tinygltf::Primitive& primitive, const std::string& path) {
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode < TINYGLTF_MODE_TRIANGLES) {
      ++skipped_;
      return {};
    }
    const int position = attribute(primitive, "POSITION");
    if (position < 0) {
      ++without_position_;
      return {};
    }
    if (attribute(primitive, "COLOR_0") >= 0) has_colors_ = true;
    if (!primitive.targets.empty()) has_targets_ = true;
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    const AccessorData positions = read_accessor(model_, position);
    if (const auto added = add_positions(mesh, positions, path); !added) return added;
    add_normals(mesh, primitive, positions.count);
    add_uvs(mesh, primitive, positions.count);
    return add_triangles(mesh, primitive, mode, base, positions.count, path);
  }

  Expected<void> add_positions(Mesh& mesh, const AccessorData& positions, const std::string& path) {
    for (std::size_t i = 0; i < positions.count; ++i) {
      const Vec3 p = positions.vec3(i);
      if (!(std::abs(p.x) <= max_coordinate && std::abs(p.y) <= max_coordinate &&
            std::abs(p.z) <= max_coordinate))
        return error(fmt::format("{}.attributes.POSITION[{}]", path, i),
                     fmt::format("position (got [{:g}, {:g}, {:g}], allowed up to {:g} in magnitude)", p.x,
                                 p.y, p.z, max_coordinate));
      mesh.positions.push_back(p);
    }
    return {};
  }

  // Normals and texture coordinates that are missing or not finite are zero: flat, and the texture's corner.
  void add_normals(Mesh& mesh, const tinygltf::Primitive& primitive, std::size_t count) {
    const std::size_t begin = mesh.normals.size();
    mesh.normals.resize(begin + count, Vec3f(0.0f));
    const int accessor = attribute(primitive, "NORMAL");
    if (accessor < 0) return;
    const AccessorData normals = read_accessor(model_, accessor);
    for (std::size_t i = 0; i < std::min(count, normals.count); ++i) {
      const Vec3f n(normals.vec3(i));
      if (std::isfinite(glm::dot(n, n)))
        mesh.normals[begin + i] = n;
      else
        ++bad_attributes_;
    }
  }

  void add_uvs(Mesh& mesh, const tinygltf::Primitive& primitive, std::size_t count) {
    const std::size_t begin = mesh.uvs.size();
    mesh.uvs.resize(begin + count, Vec2f(0.0f));
    const int set = primitive.material < 0 ? 0 : sets_[static_cast<std::size_t>(primitive.material)];
    const int accessor = attribute(primitive, fmt::format("TEXCOORD_{}", set));
    if (accessor < 0) return;
    const AccessorData uvs = read_accessor(model_, accessor);
    for (std::size_t i = 0; i < std::min(count, uvs.count); ++i) {
      const Vec2f uv(uvs.vec2(i));
      if (std::isfinite(uv.x) && std::isfinite(uv.y))
        mesh.uvs[begin + i] = uv;
      else
        ++bad_attributes_;
    }
  }

  Expected<void> add_triangles(Mesh& mesh, const tinygltf::Primitive& primitive, int mode, std::uint32_t base,
                               std::size_t count, const std::string& path) {
    std::vector<std::uint32_t> vertices(count);
    std::iota(vertices.begin(), vertices.end(), 0u);
    if (primitive.indices >= 0) {
      const AccessorData indices = read_accessor(model_, primitive.indices);
      vertices.clear();
      for (std::size_t i = 0; i < indices.count; ++i) {
        const double index = indices.values[i * indices.components];
        if (!(index >= 0.0) || index >= static_cast<double>(count))
          return error(fmt::format("{}.indices[{}]", path, i),
                       fmt::format("vertex index out of range (got {:g}, allowed 0 to {})", index,
                                   static_cast<std::int64_t>(count) - 1));
        vertices.push_back(static_cast<std::uint32_t>(index));
      }
    }
    if (mode == TINYGLTF_MODE_TRIANGLES) lost_vertices_ += vertices.size() % 3;
    const std::uint32_t material =
        primitive.material < 0 ? default_material_ : static_cast<std::uint32_t>(primitive.material);
    for (const Triangle& t : assemble(mode, vertices)) {
      mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
      mesh.triangle_materials.push_back(material);
    }
    return {};
  }

  static void drop_empty(Mesh& mesh) {
    const auto is_zero = [](const auto& v) { return v == std::decay_t<decltype(v)>(0.0f); };
    if (std::all_of(mesh.normals.begin(), mesh.normals.end(), is_zero)) mesh.normals.clear();
    if (std::all_of(mesh.uvs.begin(), mesh.uvs.end(), is_zero)) mesh.uvs.clear();
  }

  void add_notes(Scene& scene) const {
    const auto note = [&](std::string text) { scene.notes.push_back(std::move(text)); };
    if (skipped_ > 0)
      note(fmt::format("{} primitive(s) of points or lines were skipped: only triangles are drawn.",
                       skipped_));
    if (without_position_ > 0)
      note(fmt::format("{} primitive(s) without POSITION were skipped.", without_position_));
    if (bad_attributes_ > 0)
      note(fmt::format("{} normals or texture coordinates are not finite and count as missing.",
                       bad_attributes_));
    if (lost_vertices_ > 0)
      note(fmt::format("{} vertices at the ends of triangle lists do not make a triangle.", lost_vertices_));
    if (has_colors_) note("Vertex colours are not used.");
    if (has_targets_) note("Morph targets are not applied.");
  }

  const tinygltf::Model& model_;
  const TexcoordSets& sets_;
  std::uint32_t default_material_;
  const std::string& file_;
  std::size_t skipped_ = 0, without_position_ = 0, bad_attributes_ = 0, lost_vertices_ = 0;
  bool has_colors_ = false, has_targets_ = false;
};

}  // namespace

Expected<GltfMeshes> read_gltf_meshes(Scene& scene, const tinygltf::Model& model, const TexcoordSets& sets,
                                      std::uint32_t default_material, const std::string& file) {
  return GltfMeshReader(model, sets, default_material, file).run(scene);
}

}  // namespace gnomon
