// OBJ and MTL: checked by obj_check, parsed by tinyobjloader, cut into triangles by polygon.h and
// brought into the scene model here. One mesh and one instance per object or group; v of texture coordinates
// is turned over.
#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <filesystem>
#include <span>
#include <sstream>
#include <unordered_map>

#include "scene/files/formats.h"
#include "scene/files/mtl_options.h"
#include "scene/files/obj_check.h"
#include "scene/files/obj_materials.h"
#include "scene/files/polygon.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace {

Error obj_error(const std::string& file, std::string reason) {
  Error error{ErrorKind::bad_input, std::move(reason)};
  error.file = file;
  return error;
}

// The first non-empty line of a library's message, without its end.
std::string first_line(const std::string& message) {
  std::istringstream lines(message);
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) return line;
  return "unknown reason";
}

// Reads material libraries beside the OBJ file. A missing one is a note.
class LibraryReader : public tinyobj::MaterialReader {
 public:
  LibraryReader(const std::string& folder, const LoadOptions& options) : folder_(folder), options_(options) {}
  std::vector<std::string> notes;
  std::set<std::string> without_diffuse;
  std::optional<Error> error;

  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* names, std::string* warnings, std::string* errors) override {
    const auto path = resolve_path(folder_, name, options_);
    if (!path) {
      error = path.error();
      error->field = "mtllib";
      return false;
    }
    const auto text = read_file(*path);
    if (!text) {
      notes.push_back(
          fmt::format("The material library {} cannot be used ({}); its materials are neutral grey.",
                      printable(name), text.error().reason));
      return false;
    }
    note_missing_diffuse(*text);
    std::istringstream stream(plain_mtl(*text, notes));
    tinyobj::LoadMtl(names, materials, &stream, warnings, errors);
    return true;
  }

 private:
  // tinyobjloader gives such materials black.
  void note_missing_diffuse(const std::string& text) {
    std::istringstream lines(text);
    std::string current;
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string key, value;
      words >> key >> value;
      if (key == "newmtl") without_diffuse.insert(current = value);
      if (key == "Kd") without_diffuse.erase(current);
    }
  }

  const std::string& folder_;
  const LoadOptions& options_;
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
  explicit MeshGatherer(const tinyobj::attrib_t& attributes) : from_(attributes) {}

  Mesh gather(const tinyobj::shape_t& shape, std::uint32_t default_material) {
    const auto& m = shape.mesh;
    mesh_.name = shape.name;
    const std::size_t corners_in_all = m.indices.size();
    known_.reserve(std::min(corners_in_all, from_.vertices.size() / 3));
    mesh_.triangles.reserve(corners_in_all / 3), mesh_.triangle_materials.reserve(corners_in_all / 3);
    std::size_t corner = 0;
    for (std::size_t face = 0; face < m.num_face_vertices.size(); ++face) {
      const std::size_t corners = m.num_face_vertices[face];
      const int material = m.material_ids[face];
      if (corners >= 3)
        add_face(std::span(m.indices).subspan(corner, corners),
                 material < 0 ? default_material : static_cast<std::uint32_t>(material));
      corner += corners;
    }
    if (!has_uvs_) mesh_.uvs.clear();
    if (!has_normals_) mesh_.normals.clear();
    return std::move(mesh_);
  }

 private:
  void add_face(std::span<const tinyobj::index_t> corners, std::uint32_t material) {
    vertices_.clear();
    for (const tinyobj::index_t& corner : corners) vertices_.push_back(vertex(corner));
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      mesh_.triangles.push_back({vertices_[a], vertices_[b], vertices_[c]});
      mesh_.triangle_materials.push_back(material);
    };
    if (corners.size() == 3) return add(0, 1, 2);  // most of them
    std::vector<Vec3> positions;
    for (const std::uint32_t v : vertices_) positions.push_back(mesh_.positions[v]);
    for (const auto& t : triangulate_polygon(positions)) add(t[0], t[1], t[2]);
  }

  std::uint32_t vertex(const tinyobj::index_t& index) {
    const auto [found, is_new] =
        known_.try_emplace({index.vertex_index, index.texcoord_index, index.normal_index},
                           static_cast<std::uint32_t>(mesh_.positions.size()));
    if (!is_new) return found->second;
    const auto* p = &from_.vertices[3 * static_cast<std::size_t>(index.vertex_index)];
    mesh_.positions.emplace_back(p[0], p[1], p[2]);
    Vec3f normal(0.0f);
    if (index.normal_index >= 0) {
      const auto* n = &from_.normals[3 * static_cast<std::size_t>(index.normal_index)];
      normal = Vec3f(Vec3(n[0], n[1], n[2]));
      has_normals_ = true;
    }
    Vec2f uv(0.0f);
    if (index.texcoord_index >= 0) {
      const auto* t = &from_.texcoords[2 * static_cast<std::size_t>(index.texcoord_index)];
      uv = Vec2f(Vec2(t[0], 1.0 - t[1]));
      has_uvs_ = true;
    }
    mesh_.normals.push_back(normal);
    mesh_.uvs.push_back(uv);
    return found->second;
  }

  const tinyobj::attrib_t& from_;
  Mesh mesh_;
  std::unordered_map<std::array<int, 3>, std::uint32_t, CornerHash> known_;
  std::vector<std::uint32_t> vertices_;  // of the face at hand
  bool has_uvs_ = false, has_normals_ = false;
};

void note_skipped(Scene& scene, const ObjSurvey& survey) {
  if (survey.small_faces > 0)
    scene.notes.push_back(
        fmt::format("{} face(s) with fewer than three corners were skipped (the first in line {}).",
                    survey.small_faces, survey.first_small_face_line));
  if (survey.points + survey.lines > 0)
    scene.notes.push_back(fmt::format("{} point(s) and {} line(s) were skipped: only triangles are drawn.",
                                      survey.points, survey.lines));
  if (survey.has_vertex_colors) scene.notes.push_back("Vertex colours are not used.");
}

// Undefined materials and the like.
void note_warnings(Scene& scene, const std::set<std::string>& warnings) {
  constexpr std::size_t most = 10;
  std::size_t count = 0;
  for (const std::string& warning : warnings)
    if (count++ < most) scene.notes.push_back(printable(warning, 200));
  if (count > most) scene.notes.push_back(fmt::format("... and {} more of the kind.", count - most));
}

// The name of the file's only unnamed object.
std::string object_name(const std::string& name, const std::string& file, std::size_t index) {
  if (!name.empty()) return name;
  const std::string stem = std::filesystem::path(file).stem().string();
  return index == 0 ? stem : fmt::format("{}-{}", stem, index + 1);
}

struct ParsedObj {
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::set<std::string> warnings;  ///< the library's own, once each
};

Expected<ParsedObj> parse(const std::string& text, const std::string& file, LibraryReader& libraries) {
  ParsedObj parsed;
  std::string warnings, errors;
  std::istringstream stream(text);
  const bool done = tinyobj::LoadObj(&parsed.attributes, &parsed.shapes, &parsed.materials, &warnings,
                                     &errors, &stream, &libraries,
                                     /*triangulate=*/false, /*default_vcols_fallback=*/false);
  if (libraries.error) {
    libraries.error->file = file;
    return fail(*libraries.error);
  }
  if (!done) return fail(obj_error(file, first_line(errors)));
  std::istringstream lines(warnings);
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) parsed.warnings.insert(line);
  return parsed;
}

}  // namespace

Expected<LoadedFile> read_obj(std::string_view bytes, const std::string& file, const std::string& folder,
                              const LoadOptions& options) {
  std::string text(bytes);
  blank_continuations_and_comments(text);
  const auto survey = check_obj(text, file);
  if (!survey) return fail(survey.error());
  LibraryReader libraries(folder, options);
  const auto parsed = parse(text, file, libraries);
  if (!parsed) return fail(parsed.error());

  LoadedFile loaded;
  loaded.is_model = true;
  Scene& scene = loaded.scene;
  scene.notes = libraries.notes;
  note_warnings(scene, parsed->warnings);
  if (const auto added =
          add_obj_materials(scene, parsed->materials, libraries.without_diffuse, folder, options);
      !added) {
    Error error = added.error();
    if (error.file.empty()) error.file = file;
    return fail(std::move(error));
  }
  const auto default_material = static_cast<std::uint32_t>(scene.materials.size());
  scene.materials.push_back(model_material("default"));
  std::size_t triangles = 0;
  for (const tinyobj::shape_t& shape : parsed->shapes) {
    Mesh mesh = MeshGatherer(parsed->attributes).gather(shape, default_material);
    if (mesh.triangles.empty()) continue;
    triangles += mesh.triangles.size();
    const auto index = static_cast<std::uint32_t>(scene.meshes.size());
    mesh.name = object_name(mesh.name, file, index);
    scene.instances.push_back({mesh.name, index, Mat4(1.0), default_material});
    scene.meshes.push_back(std::move(mesh));
  }
  note_skipped(scene, *survey);
  if (triangles == 0) return fail(obj_error(file, "the file has no triangles"));
  return loaded;
}

}  // namespace gnomon
