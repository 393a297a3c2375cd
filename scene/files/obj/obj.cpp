// OBJ: read by obj_text, its materials by mtl, cut into triangles by polygon.h and brought into the scene model
// here. One mesh and one instance per object or group; v of texture coordinates
// is turned over.
#include <fmt/core.h>

#include <filesystem>
#include <span>
#include <unordered_map>

#include "scene/files/formats.h"
#include "scene/files/obj/mtl.h"
#include "scene/files/obj/obj_text.h"
#include "scene/files/obj/obj_textures.h"
#include "scene/files/path_status.h"
#include "scene/files/polygon.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace {

Error obj_error(const std::string& file, std::string reason) {
  Error error{ErrorKind::bad_input, std::move(reason)};
  error.file = file;
  return error;
}

// Reads material libraries beside the OBJ file. A missing one is a note.
class LibraryReader {
 public:
  LibraryReader(const std::string& folder, const LoadOptions& options) : folder_(folder), options_(options) {}
  MtlLibrary all;

  /// Nothing, or why it cannot be used.
  Expected<std::string> read(const std::string& name) {
    const auto path = resolve_path(folder_, name, options_);
    if (!path) {
      Error error = path.error();
      error.field = "mtllib";
      return fail(std::move(error));
    }
    const auto bytes = read_file(*path);
    if (!bytes && file_kind_or_none(*path) == FileKind::file) return fail(bytes.error());
    if (!bytes) return bytes.error().reason;
    if (bytes->find('\0') != std::string::npos) return "it is not UTF-8 text";
    auto library = parse_mtl(*bytes, *path);
    if (!library) return fail(library.error());
    for (MtlMaterial& material : library->materials) {
      numbers_.try_emplace(material.name, static_cast<int>(all.materials.size()));
      all.materials.push_back(std::move(material));
    }
    all.notes.insert(all.notes.end(), library->notes.begin(), library->notes.end());
    all.warnings.merge(library->warnings);
    return std::string();
  }

  int find(const std::string& name) const {
    const auto found = numbers_.find(name);
    return found == numbers_.end() ? -1 : found->second;
  }

 private:
  const std::string& folder_;
  const LoadOptions& options_;
  std::map<std::string, int> numbers_;  ///< of materials, by name
};

struct CornerHash {
  std::size_t operator()(const std::array<int, 3>& c) const {
    std::uint64_t h = static_cast<std::uint32_t>(c[0]);
    h = h * 0x9e3779b97f4a7c15u + static_cast<std::uint32_t>(c[1]);
    h = h * 0x9e3779b97f4a7c15u + static_cast<std::uint32_t>(c[2]);
    return static_cast<std::size_t>(h ^ (h >> 29));
  }
};

// Gathers the vertices of one object: a vertex is a (position, texture coordinate, normal) that its faces
// use.
class MeshGatherer {
 public:
  explicit MeshGatherer(const ObjText& text) : from_(text) {}

  Mesh gather(const ObjShape& shape, std::uint32_t default_material) {
    const auto faces = std::span(from_.faces).subspan(shape.first_face, shape.faces);
    const std::size_t corners = faces.back().first + faces.back().corners - faces.front().first;
    mesh_.name = shape.name;
    known_.reserve(std::min(corners, from_.positions.size()));
    mesh_.triangles.reserve(corners / 3), mesh_.triangle_materials.reserve(corners / 3);
    for (const ObjFace& face : faces)
      add_face(std::span(from_.corners).subspan(face.first, face.corners),
               face.material < 0 ? default_material : static_cast<std::uint32_t>(face.material));
    if (!has_uvs_) mesh_.uvs.clear();
    if (!has_normals_) mesh_.normals.clear();
    return std::move(mesh_);
  }

 private:
  void add_face(std::span<const ObjCorner> corners, std::uint32_t material) {
    vertices_.clear();
    for (const ObjCorner& corner : corners) vertices_.push_back(vertex(corner));
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      mesh_.triangles.push_back({vertices_[a], vertices_[b], vertices_[c]});
      mesh_.triangle_materials.push_back(material);
    };
    if (corners.size() == 3) return add(0, 1, 2);  // most of them
    std::vector<Vec3> positions;
    for (const std::uint32_t v : vertices_) positions.push_back(mesh_.positions[v]);
    for (const auto& t : triangulate_polygon(positions)) add(t[0], t[1], t[2]);
  }

  std::uint32_t vertex(const ObjCorner& corner) {
    const auto [found, is_new] = known_.try_emplace({corner.position, corner.texcoord, corner.normal},
                                                    static_cast<std::uint32_t>(mesh_.positions.size()));
    if (!is_new) return found->second;
    const auto at = [](const auto& all, int index) { return all[static_cast<std::size_t>(index)]; };
    mesh_.positions.push_back(at(from_.positions, corner.position));
    mesh_.normals.push_back(corner.normal < 0 ? Vec3f(0.0f) : at(from_.normals, corner.normal));
    if (!from_.colors.empty()) mesh_.colors.push_back(linear_color(at(from_.colors, corner.position), 1.0f));
    const auto uv = corner.texcoord < 0 ? glm::dvec2(0.0, 1.0) : at(from_.texcoords, corner.texcoord);
    mesh_.uvs.emplace_back(uv.x, 1.0 - uv.y);
    has_normals_ |= corner.normal >= 0, has_uvs_ |= corner.texcoord >= 0;
    return found->second;
  }

  const ObjText& from_;
  Mesh mesh_;
  std::unordered_map<std::array<int, 3>, std::uint32_t, CornerHash> known_;
  std::vector<std::uint32_t> vertices_;  // of the face at hand
  bool has_uvs_ = false, has_normals_ = false;
};

void note_skipped(Scene& scene, const ObjText& text) {
  if (text.small_faces > 0)
    scene.notes.push_back(
        fmt::format("{} face(s) with fewer than three corners were skipped (the first in line {}).",
                    text.small_faces, text.first_small_face_line));
  if (text.points + text.lines > 0)
    scene.notes.push_back(fmt::format("{} point(s) and {} line(s) were skipped: only triangles are drawn.",
                                      text.points, text.lines));
}

// Undefined materials and the like.
void note_warnings(Scene& scene, const std::set<std::string>& warnings) {
  constexpr std::size_t most = 10;
  std::size_t count = 0;
  for (const std::string& warning : warnings)
    if (count++ < most) scene.notes.push_back(printable(warning, 200));
  if (count > most) scene.notes.push_back(fmt::format("... and {} more of the kind.", count - most));
}

// The one material of all of the mesh's triangles, which then needs no list of them; else anything.
std::uint32_t extract_only_material(Mesh& mesh) {
  auto& of_triangles = mesh.triangle_materials;
  const std::uint32_t material = of_triangles.front();
  if (std::all_of(of_triangles.begin(), of_triangles.end(), [&](std::uint32_t m) { return m == material; }))
    of_triangles = {};
  return material;
}

// The name of the file's only unnamed object.
std::string object_name(const std::string& name, const std::string& file, std::size_t index) {
  if (!name.empty()) return name;
  const std::string stem = std::filesystem::path(file).stem().string();
  return index == 0 ? stem : fmt::format("{}-{}", stem, index + 1);
}

}  // namespace

Expected<LoadedFile> read_obj(std::string_view bytes, const std::string& file, const std::string& folder,
                              const LoadOptions& options) {
  LibraryReader libraries(folder, options);
  const auto parsed = parse_obj(bytes, file,
                                {[&](const std::string& name) { return libraries.read(name); },
                                 [&](const std::string& name) { return libraries.find(name); }});
  if (!parsed) {
    Error error = parsed.error();
    if (error.file.empty()) error.file = file;
    return fail(std::move(error));
  }
  LoadedFile loaded;
  loaded.is_model = true;
  Scene& scene = loaded.scene;
  scene.notes = libraries.all.notes;
  libraries.all.warnings.insert(parsed->warnings.begin(), parsed->warnings.end());
  note_warnings(scene, libraries.all.warnings);
  if (const auto added = add_obj_materials(scene, libraries.all.materials, folder, options); !added) {
    Error error = added.error();
    if (error.file.empty()) error.file = file;
    return fail(std::move(error));
  }
  const auto default_material = static_cast<std::uint32_t>(scene.materials.size());
  scene.materials.push_back(model_material("default", !parsed->colors.empty()));
  std::size_t triangles = 0;
  for (const ObjShape& shape : parsed->shapes) {
    Mesh mesh = MeshGatherer(*parsed).gather(shape, default_material);
    if (mesh.triangles.empty()) continue;
    triangles += mesh.triangles.size();
    const auto index = static_cast<std::uint32_t>(scene.meshes.size());
    mesh.name = object_name(mesh.name, file, index);
    scene.instances.push_back({mesh.name, index, Mat4(1.0), extract_only_material(mesh)});
    scene.meshes.push_back(std::move(mesh));
  }
  note_skipped(scene, *parsed);
  if (triangles == 0) return fail(obj_error(file, "the file has no triangles"));
  return loaded;
}

}  // namespace gnomon
