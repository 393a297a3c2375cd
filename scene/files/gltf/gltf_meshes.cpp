#include "scene/files/gltf/gltf_meshes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <atomic>

#include "scene/base/parallel.h"
#include "scene/files/gltf/gltf_accessor.h"
#include "scene/files/validate.h"

namespace gnomon {
namespace {

using gltf::attribute;

// glTF 2.0, section 3.7.2.1; a strip's every other triangle is turned round, and its stitches are dropped.
template <class Visit>
void for_each_triangle_of_mode(int mode, const std::vector<std::uint32_t>& v, const Visit& visit) {
  if (mode == gltf::triangle_fan)
    for (std::size_t i = 1; i + 1 < v.size(); ++i) visit(v[i], v[i + 1], v[0]);
  if (mode == gltf::triangle_strip)
    for (std::size_t i = 0; i + 2 < v.size(); ++i) {
      if (v[i] == v[i + 1] || v[i + 1] == v[i + 2] || v[i] == v[i + 2]) continue;
      visit(v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]);
    }
}

/// The least index that any thread reports.
class FirstBad {
 public:
  void report(std::size_t index) {
    std::size_t known = first_.load();
    while (index < known && !first_.compare_exchange_weak(known, index)) {
    }
  }
  std::optional<std::size_t> get() const {
    const std::size_t first = first_.load();
    return first == none ? std::nullopt : std::optional(first);
  }

 private:
  static constexpr std::size_t none = ~std::size_t{0};
  std::atomic<std::size_t> first_{none};
};

bool is_placeable(const Vec3& p) {
  return std::abs(p.x) <= max_coordinate && std::abs(p.y) <= max_coordinate &&
         std::abs(p.z) <= max_coordinate;
}

Vec3 vec3(const double* v) {
  return {v[0], v[1], v[2]};
}

/// Gives primitives what others of the mesh have and they do not.
void fill_up(Mesh& mesh) {
  const std::size_t count = mesh.positions.size();
  if (!mesh.normals.empty()) mesh.normals.resize(count, Vec3f(0.0f));
  if (!mesh.uvs.empty()) mesh.uvs.resize(count, Vec2f(0.0f));
  if (!mesh.colors.empty()) mesh.colors.resize(count, Vec4f(1.0f));
}

void drop_empty(Mesh& mesh) {
  const auto is_zero = [](const auto& v) { return v == std::decay_t<decltype(v)>(0.0f); };
  if (std::all_of(mesh.normals.begin(), mesh.normals.end(), is_zero)) mesh.normals.clear();
  if (std::all_of(mesh.uvs.begin(), mesh.uvs.end(), is_zero)) mesh.uvs.clear();
  if (std::all_of(mesh.colors.begin(), mesh.colors.end(), [](const Vec4f& c) { return c == Vec4f(1.0f); }))
    mesh.colors.clear();
}

/// A vertex's joints blended: the sum of its weights times their matrices, and that of the weights alone.
struct Blend {
  Mat4 matrix{0.0};
  double weight = 0.0;
};

}  // namespace

Expected<GltfMesh> GltfMeshReader::read(std::size_t index, const GltfPose& pose) {
  const gltf::Mesh& from = model_.meshes[index];
  GltfMesh out;
  Mesh& mesh = out.mesh;
  mesh.name = from.name.empty() ? fmt::format("mesh-{}", index + 1) : from.name;
  for (std::size_t p = 0; p < from.primitives.size(); ++p) {
    const std::size_t before = mesh.triangles.size();
    if (const auto added =
            add_primitive(mesh, from.primitives[p], pose, fmt::format("meshes[{}].primitives[{}]", index, p));
        !added)
      return fail(added.error());
    const std::uint32_t material = material_of(from.primitives[p]);
    if (before == 0) out.material = material;
    if (mesh.triangles.size() > before && material != out.material)
      mesh.triangle_materials.resize(before, out.material);
    if (!mesh.triangle_materials.empty()) mesh.triangle_materials.resize(mesh.triangles.size(), material);
  }
  fill_up(mesh);
  drop_empty(mesh);
  return out;
}

tl::unexpected<Error> GltfMeshReader::error(std::string field, std::string reason) const {
  return fail(Error{ErrorKind::bad_input, std::move(reason), file_, 0, 0, std::move(field)});
}

GltfAccessor GltfMeshReader::accessor(int index) const {
  return {model_, data_, index};
}

Expected<void> GltfMeshReader::add_primitive(Mesh& mesh, const gltf::Primitive& primitive,
                                             const GltfPose& pose, std::string path) {
  if (primitive.mode < gltf::triangles) {
    ++skipped_;
    return {};
  }
  const int position = attribute(primitive.attributes, "POSITION");
  if (position < 0) {
    ++without_position_;
    return {};
  }
  const Part part{primitive, std::move(path), mesh.positions.size(),
                  model_.accessors[static_cast<std::size_t>(position)].count};
  if (const auto added = add_positions(mesh, part); !added) return added;
  add_normals(mesh, part);
  add_uvs(mesh, part);
  add_colors(mesh, part);
  if (!pose.weights.empty() || !pose.joints.empty())  // which change normals as well
    mesh.normals.resize(part.first + part.count, Vec3f(0.0f));
  apply_targets(mesh, part, pose.weights);
  apply_skin(mesh, part, pose.joints);
  if (const auto sound = check_positions(mesh, part); !sound) return sound;
  return add_triangles(mesh, part);
}

Expected<void> GltfMeshReader::add_positions(Mesh& mesh, const Part& part) const {
  if (part.first + part.count >= no_id)
    return error(part.path, fmt::format("the mesh has too many vertices (got {}, allowed {})",
                                        part.first + part.count, no_id - 1));
  mesh.positions.resize(mesh.positions.size() + part.count);
  accessor(attribute(part.primitive.attributes, "POSITION")).for_each([&](std::size_t i, const double* v) {
    mesh.positions[part.first + i] = vec3(v);
  });
  return {};
}

Expected<void> GltfMeshReader::check_positions(const Mesh& mesh, const Part& part) const {
  const std::size_t bad =
      first_where(part.count, [&](std::size_t i) { return !is_placeable(mesh.positions[part.first + i]); });
  if (bad == part.count) return {};
  const Vec3& p = mesh.positions[part.first + bad];
  return error(fmt::format("{}.attributes.POSITION[{}]", part.path, bad),
               fmt::format("position (got [{:g}, {:g}, {:g}], allowed up to {:g} in magnitude)", p.x, p.y,
                           p.z, max_coordinate));
}

// Normals and texture coordinates that are missing or not finite are zero: flat, and the texture's corner.
void GltfMeshReader::add_normals(Mesh& mesh, const Part& part) {
  const int index = attribute(part.primitive.attributes, "NORMAL");
  if (index < 0) return;
  mesh.normals.resize(part.first + part.count, Vec3f(0.0f));
  std::atomic<std::size_t> bad = 0;
  accessor(index).for_each([&](std::size_t i, const double* v) {
    const Vec3f n(vec3(v));
    if (i >= part.count) return;
    if (std::isfinite(glm::dot(n, n)))
      mesh.normals[part.first + i] = n;
    else
      ++bad;
  });
  bad_attributes_ += bad;
}

void GltfMeshReader::add_uvs(Mesh& mesh, const Part& part) {
  const int material = part.primitive.material;
  const int set = material < 0 ? 0 : sets_[static_cast<std::size_t>(material)];
  const int index = attribute(part.primitive.attributes, fmt::format("TEXCOORD_{}", set));
  if (index < 0) return;
  mesh.uvs.resize(part.first + part.count, Vec2f(0.0f));
  std::atomic<std::size_t> bad = 0;
  accessor(index).for_each([&](std::size_t i, const double* v) {
    const Vec2f uv(static_cast<float>(v[0]), static_cast<float>(v[1]));
    if (i >= part.count) return;
    if (std::isfinite(uv.x) && std::isfinite(uv.y))
      mesh.uvs[part.first + i] = uv;
    else
      ++bad;
  });
  bad_attributes_ += bad;
}

// glTF 2.0, section 3.7.2.1: linear, of three or four components in [0, 1]. What is missing or not finite is white.
void GltfMeshReader::add_colors(Mesh& mesh, const Part& part) {
  const int index = attribute(part.primitive.attributes, "COLOR_0");
  if (index < 0) return;
  if (part.primitive.material >= 0) coloured_.insert(static_cast<std::uint32_t>(part.primitive.material));
  mesh.colors.resize(part.first + part.count, Vec4f(1.0f));
  const GltfAccessor from = accessor(index);
  std::atomic<std::size_t> bad = 0;
  from.for_each([&](std::size_t i, const double* v) {
    const Vec4f color(Vec4(vec3(v), from.components() > 3 ? v[3] : 1.0));
    if (i >= part.count) return;
    if (std::isfinite(glm::dot(color, color)))
      mesh.colors[part.first + i] = glm::clamp(color, 0.0f, 1.0f);
    else
      ++bad;
  });
  bad_attributes_ += bad;
}

// glTF 2.0, section 3.7.2.2: the displacements of the targets, weighted, are added.
void GltfMeshReader::apply_targets(Mesh& mesh, const Part& part, const std::vector<double>& weights) const {
  const auto& targets = part.primitive.targets;
  for (std::size_t t = 0; t < std::min(targets.size(), weights.size()); ++t) {
    if (weights[t] == 0.0) continue;
    const auto add = [&](const char* name, auto&& put) {
      const int index = gltf::attribute(targets[t], name);
      if (index < 0) return;
      accessor(index).for_each([&](std::size_t i, const double* v) {
        if (i < part.count) put(part.first + i, weights[t] * vec3(v));
      });
    };
    add("POSITION", [&](std::size_t i, const Vec3& by) { mesh.positions[i] += by; });
    add("NORMAL", [&](std::size_t i, const Vec3& by) {
      const Vec3f moved = mesh.normals[i] + Vec3f(by);
      if (std::isfinite(glm::dot(moved, moved))) mesh.normals[i] = moved;
    });
  }
}

// glTF 2.0, section 3.7.3.3. Weights are taken relative to their sum; a vertex without any stays where it is
// stored.
void GltfMeshReader::apply_skin(Mesh& mesh, const Part& part, const std::vector<Mat4>& joints) {
  if (joints.empty()) return;
  std::vector<Blend> blends(part.count);
  for (int set = 0;; ++set) {
    const int indices = attribute(part.primitive.attributes, fmt::format("JOINTS_{}", set));
    const int weights = attribute(part.primitive.attributes, fmt::format("WEIGHTS_{}", set));
    if (indices < 0 || weights < 0) break;
    const GltfAccessor weight = accessor(weights);
    const std::size_t known = std::min(part.count, weight.count());
    accessor(indices).for_each([&](std::size_t i, const double* joint) {
      if (i >= known) return;
      std::array<double, 4> share{};
      weight.read(i, i + 1, share.data());
      for (std::size_t c = 0; c < 4; ++c) {
        if (!(share[c] > 0.0) || !(joint[c] >= 0.0 && joint[c] < static_cast<double>(joints.size())))
          continue;
        blends[i].matrix += share[c] * joints[static_cast<std::size_t>(joint[c])];
        blends[i].weight += share[c];
      }
    });
  }
  parallel_for(part.count, [&](std::size_t i) {
    if (!(blends[i].weight > 0.0)) return;
    const Mat4 matrix = blends[i].matrix / blends[i].weight;
    Vec3& position = mesh.positions[part.first + i];
    position = Vec3(matrix * Vec4(position, 1.0));
    const Mat3 m(matrix);
    // The cofactors: the inverse transpose times the determinant, and no division by zero.
    const Mat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    const Vec3 normal = cofactors * Vec3(mesh.normals[part.first + i]);
    const double length = glm::length(normal);
    mesh.normals[part.first + i] =
        length > 0.0 && std::isfinite(length) ? Vec3f(normal / length) : Vec3f(0.0f);
  });
  unbound_ += static_cast<std::size_t>(
      std::count_if(blends.begin(), blends.end(), [](const Blend& b) { return !(b.weight > 0.0); }));
}

/// Calls put(i, vertex) for every vertex in the order of the primitive's indices, or without these in its own.
template <class Put>
Expected<void> GltfMeshReader::for_each_index(const Part& part, const Put& put) const {
  if (part.primitive.indices < 0) {
    for (std::size_t i = 0; i < part.count; ++i) put(i, static_cast<std::uint32_t>(i));
    return {};
  }
  const GltfAccessor indices = accessor(part.primitive.indices);
  FirstBad bad;
  indices.for_each([&](std::size_t i, const double* index) {
    if (*index >= 0.0 && *index < static_cast<double>(part.count))
      put(i, static_cast<std::uint32_t>(*index));
    else
      bad.report(i);
  });
  const auto first = bad.get();
  if (!first) return {};
  std::array<double, 16> got{};
  indices.read(*first, *first + 1, got.data());
  return error(fmt::format("{}.indices[{}]", part.path, *first),
               fmt::format("vertex index out of range (got {:g}, allowed 0 to {})", got[0],
                           static_cast<std::int64_t>(part.count) - 1));
}

Expected<void> GltfMeshReader::add_triangles(Mesh& mesh, const Part& part) {
  const int mode = part.primitive.mode;
  const std::size_t count =
      part.primitive.indices < 0 ? part.count : accessor(part.primitive.indices).count();
  const auto base = static_cast<std::uint32_t>(part.first);
  if (mode == gltf::triangles) {
    const std::size_t first = mesh.triangles.size(), whole = count / 3 * 3;
    mesh.triangles.resize(first + count / 3);
    const auto read = for_each_index(part, [&](std::size_t i, std::uint32_t v) {
      if (i < whole) mesh.triangles[first + i / 3][i % 3] = base + v;
    });
    if (!read) return read;
    lost_vertices_ += count % 3;
  } else {
    std::vector<std::uint32_t> vertices(count);
    const auto read = for_each_index(part, [&](std::size_t i, std::uint32_t v) { vertices[i] = base + v; });
    if (!read) return read;
    for_each_triangle_of_mode(mode, vertices, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      mesh.triangles.push_back({a, b, c});
    });
  }
  return {};
}

std::uint32_t GltfMeshReader::material_of(const gltf::Primitive& primitive) const {
  return primitive.material < 0 ? default_material_ : static_cast<std::uint32_t>(primitive.material);
}

void GltfMeshReader::add_notes(Scene& scene) const {
  const auto note = [&](std::string text) { scene.notes.push_back(std::move(text)); };
  if (skipped_ > 0)
    note(fmt::format("{} primitive(s) of points or lines were skipped: only triangles are drawn.", skipped_));
  if (without_position_ > 0)
    note(fmt::format("{} primitive(s) without POSITION were skipped.", without_position_));
  if (bad_attributes_ > 0)
    note(fmt::format("{} normals, texture coordinates or colours are not finite and count as missing.",
                     bad_attributes_));
  // They are times the diffuse colour, which a metal has none of.
  std::vector<std::string> metals;
  for (const std::uint32_t index : coloured_)
    if (const Material& m = scene.materials[index]; m.diffuse == Vec3f(0.0f) && m.specular != Vec3f(0.0f))
      metals.push_back(m.name);
  if (!metals.empty())
    note(fmt::format("The vertices' colours of metals are not used (material{} {}).",
                     metals.size() > 1 ? "s" : "", fmt::join(metals, ", ")));
  if (lost_vertices_ > 0)
    note(fmt::format("{} vertices at the ends of triangle lists do not make a triangle.", lost_vertices_));
  if (unbound_ > 0)
    note(fmt::format("{} vertices of skinned meshes have no joint: they stay where they are stored.",
                     unbound_));
}

}  // namespace gnomon
