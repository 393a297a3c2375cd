// Meshes, instances and shapes of a JSON scene.
#include <fmt/core.h>

#include <algorithm>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/files/json/json_generate.h"
#include "scene/files/json/json_parts.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace {

// ---- meshes ----

std::vector<Vec3> read_vectors(const JsonNode& list) {
  std::vector<Vec3> out;
  for (const JsonNode& node : list.as_array()) out.push_back(node.as_vec3());
  return out;
}

void check_count(const JsonNode& list, std::size_t got, std::size_t vertices) {
  if (got != vertices)
    list.error(fmt::format("one per vertex is needed (got {}, allowed {})", got, vertices));
}

std::array<std::uint32_t, 3> read_triangle(const JsonNode& node, std::size_t vertices) {
  std::array<std::uint32_t, 3> triangle{};
  const auto corners = node.as_array(3);
  const NumberRange range{0.0, static_cast<double>(vertices) - 1.0, false, false, true};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double index = corners[i].as_number(range);
    if (node.errors().first) return {};
    triangle[i] = static_cast<std::uint32_t>(index);
  }
  return triangle;
}

Mesh read_listed_mesh(const JsonObject& object) {
  Mesh mesh;
  const auto vertices = object.require("vertices");
  const auto triangles = object.require("triangles");
  if (!vertices || !triangles) return mesh;
  mesh.positions = read_vectors(*vertices);
  if (triangles->is(JsonValue::Type::array) && triangles->value().items.empty())
    triangles->error("is empty (allowed: at least one triangle)");
  for (const JsonNode& node : triangles->as_array()) {
    mesh.triangles.push_back(read_triangle(node, mesh.positions.size()));
    if (node.errors().first) return {};
  }
  if (const auto normals = object.find("normals")) {
    for (const Vec3& n : read_vectors(*normals)) mesh.normals.emplace_back(n);
    check_count(*normals, mesh.normals.size(), mesh.positions.size());
  }
  if (const auto uvs = object.find("uvs")) {
    for (const JsonNode& node : uvs->as_array()) mesh.uvs.emplace_back(node.as_vec2());
    check_count(*uvs, mesh.uvs.size(), mesh.positions.size());
  }
  if (const auto colors = object.find("colors")) {
    for (const JsonNode& node : colors->as_array())
      mesh.colors.emplace_back(node.as_color(unit_interval), 1.0f);
    check_count(*colors, mesh.colors.size(), mesh.positions.size());
  }
  return mesh;
}

std::uint32_t add_mesh(Scene& scene, Mesh mesh) {
  scene.meshes.push_back(std::move(mesh));
  return static_cast<std::uint32_t>(scene.meshes.size() - 1);
}

NamedMesh read_generated_mesh(SceneReader& reader, const JsonNode& node, const std::string& name) {
  auto model = generate_from_json<GeneratedModel>(node, &generate);
  if (!model) return {};
  NamedMesh named;
  for (GeneratedPart& part : model->parts) {
    part.mesh.name = model->parts.size() == 1 ? name : fmt::format("{}/{}", name, part.name);
    named.parts.push_back({part.name, add_mesh(reader.scene, std::move(part.mesh)), Mat4(1.0), no_id, false});
  }
  return named;
}

// The instances of a model file are the parts of the mesh.
NamedMesh read_mesh_file(SceneReader& reader, const JsonNode& node) {
  const std::string path = reader.resolve(node);
  if (reader.failed()) return {};
  if (lower_extension(path) == ".json") {
    node.error("is a scene, not a model (use include)");
    return {};
  }
  const auto bytes = read_file(path);
  auto loaded =
      bytes ? read_by_extension(*bytes, path, reader.options, reader.includes) : fail(bytes.error());
  if (!loaded) {
    reader.adopt(node, loaded.error());
    return {};
  }
  Scene& model = loaded->scene;
  if (!model.lights.empty())
    reader.scene.notes.push_back(
        fmt::format("The {} light(s) of {} are not used: it is a mesh here.", model.lights.size(), path));
  const std::vector<MeshInstance> instances = std::move(model.instances);
  const MergeOffsets offsets = merge_scene(reader.scene, std::move(model), false);
  NamedMesh named;
  for (const MeshInstance& part : instances)
    named.parts.push_back({part.name, part.mesh + offsets.mesh, part.world_from_object,
                           part.material + offsets.material, true});
  return named;
}

NamedMesh read_mesh(SceneReader& reader, const JsonObject& object, const std::string& name) {
  const std::string_view source = object.exactly_one({"file", "vertices", "generate"});
  if (source.empty()) return {};
  if (source != "vertices")
    for (const std::string_view key : {"triangles", "normals", "uvs", "colors"})
      object.forbid(key, fmt::format("cannot stand beside {}", source));
  if (reader.failed()) return {};
  if (source == "file") return read_mesh_file(reader, *object.find("file"));
  if (source == "generate") return read_generated_mesh(reader, *object.find("generate"), name);
  Mesh mesh = read_listed_mesh(object);
  mesh.name = name;
  return {{{name, add_mesh(reader.scene, std::move(mesh)), Mat4(1.0), no_id, false}}, false};
}

// ---- instances ----

// A line of the file makes no more than the ray tracer's and the rasterizer's indices have room for.
constexpr std::size_t max_repeated_triangles = std::size_t{1} << 26;

Mat4 read_matrix(const JsonNode& node) {
  Mat4 matrix(1.0);
  const auto rows = node.as_array(4);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto cells = rows[r].as_array(4);
    for (std::size_t c = 0; c < cells.size(); ++c)
      matrix[static_cast<int>(c)][static_cast<int>(r)] = cells[c].as_number(coordinate_range);
  }
  if (node.errors().first) return matrix;
  if (glm::row(matrix, 3) != Vec4(0.0, 0.0, 0.0, 1.0)) rows[3].error("the last row must be [0, 0, 0, 1]");
  if (is_singular(Mat3(matrix)))
    node.error("is singular: it flattens the mesh (allowed: an invertible matrix)");
  return matrix;
}

Mat4 read_rotation(const JsonNode& node) {
  const JsonObject object(node, {"axis", "degrees"});
  const auto axis = object.require("axis");
  const auto degrees = object.require("degrees");
  if (!axis || !degrees) return Mat4(1.0);
  const double angle = degrees->as_number(coordinate_range);
  return glm::rotate(Mat4(1.0), angle * pi / 180.0, axis->as_direction());
}

}  // namespace

Mat4 read_rotations(const JsonNode& node) {
  if (!node.is(JsonValue::Type::array)) return read_rotation(node);
  Mat4 all(1.0);
  for (const JsonNode& one : node.as_array()) all = read_rotation(one) * all;
  return all;
}

namespace {

Mat4 read_transform(const JsonObject& object) {
  if (const auto matrix = object.find("matrix")) {
    for (const std::string_view key : {"translate", "rotate", "scale"})
      object.forbid(key, "cannot stand beside matrix");
    return read_matrix(*matrix);
  }
  Mat4 world(1.0);
  if (const auto translate = object.find("translate")) world = glm::translate(world, translate->as_vec3());
  if (const auto rotate = object.find("rotate")) world *= read_rotations(*rotate);
  if (const auto scale = object.find("scale")) {
    const Vec3 factors = scale->as_scale3();
    if (factors.x == 0.0 || factors.y == 0.0 || factors.z == 0.0)
      scale->wrong("flattens the mesh", "factors that are not 0");
    world = glm::scale(world, factors);
  }
  return world;
}

NamedMesh* find_mesh(SceneReader& reader, const JsonNode& name) {
  const std::string text = name.as_string();
  const auto found = reader.names.meshes.find(text);
  if (found != reader.names.meshes.end()) return &found->second;
  std::vector<std::string_view> names;
  for (const auto& entry : reader.names.meshes) names.push_back(entry.first);
  name.error(fmt::format("no such mesh (got \"{}\", allowed {}){}", printable(text),
                         names.empty() ? "none: there are no meshes" : list_names(names),
                         suggestion(text, names)));
  return nullptr;
}

struct PartMaterials {
  std::optional<std::uint32_t> every;
  std::map<std::string, std::uint32_t, std::less<>> by_part;
};

PartMaterials read_part_materials(SceneReader& reader, const JsonObject& object, const NamedMesh& mesh) {
  PartMaterials out;
  if (const auto material = object.find("material")) out.every = find_material(reader, *material);
  const auto map = object.find("materials");
  if (!map) return out;
  if (!map->is(JsonValue::Type::object))
    map->wrong("wrong type", "an object of part names and material names");
  std::vector<std::string_view> parts;
  for (const MeshPart& part : mesh.parts) parts.push_back(part.name);
  for (const JsonMember& member : map->value().members) {
    const JsonNode node(map->errors(), member.value,
                        fmt::format("{}.{}", map->path(), printable(member.key)));
    if (std::find(parts.begin(), parts.end(), member.key) == parts.end())
      reader.errors.add(member.key_begin, node.path(),
                        fmt::format("no such part (got \"{}\", allowed {}){}", printable(member.key),
                                    list_names(parts), suggestion(member.key, parts)));
    out.by_part[member.key] = find_material(reader, node);
  }
  return out;
}

// The mesh without materials of its own, for an instance that gives another.
std::uint32_t plain_mesh(SceneReader& reader, std::uint32_t mesh) {
  if (reader.scene.meshes[mesh].triangle_materials.empty()) return mesh;
  const auto [found, is_new] = reader.plain_meshes.try_emplace(mesh, 0u);
  if (is_new) {
    Mesh copy = reader.scene.meshes[mesh];
    copy.triangle_materials.clear();
    found->second = add_mesh(reader.scene, std::move(copy));
  }
  return found->second;
}

void place_part(SceneReader& reader, const JsonNode& node, const MeshPart& part,
                const PartMaterials& materials, MeshInstance instance) {
  instance.mesh = part.mesh;
  instance.world_from_object = instance.world_from_object * part.mesh_from_part;
  const auto given = materials.by_part.find(part.name);
  if (given != materials.by_part.end() || materials.every) {
    instance.material = given != materials.by_part.end() ? given->second : *materials.every;
    instance.mesh = plain_mesh(reader, part.mesh);
  } else if (part.has_own_material) {
    instance.material = part.material == no_id ? 0 : part.material;
  } else {
    return node.error(fmt::format("material is missing for part \"{}\" (give material or materials)",
                                  printable(part.name)));
  }
  reader.scene.instances.push_back(std::move(instance));
}

void place_parts(SceneReader& reader, const JsonNode& node, const NamedMesh& mesh,
                 const PartMaterials& materials, MeshInstance instance) {
  const std::string name = instance.name;
  for (const MeshPart& part : mesh.parts) {
    if (reader.failed()) return;
    if (mesh.parts.size() > 1) instance.name = fmt::format("{}/{}", name, part.name);
    place_part(reader, node, part, materials, instance);
  }
}

void check_triangles(const SceneReader& reader, const JsonNode& repeat, const NamedMesh& mesh,
                     std::size_t copies) {
  std::size_t triangles = 0;
  for (const MeshPart& part : mesh.parts) triangles += reader.scene.meshes[part.mesh].triangles.size();
  if (triangles * copies > max_repeated_triangles)
    repeat.error(fmt::format("makes too many triangles (got {}, allowed up to {})", triangles * copies,
                             max_repeated_triangles));
}

void place_instances(SceneReader& reader, const JsonNode& node, const JsonObject& object,
                     const NamedMesh& mesh, const PartMaterials& materials, MeshInstance instance) {
  const auto repeat = object.find("repeat");
  if (!repeat) return place_parts(reader, node, mesh, materials, instance);
  const std::vector<RepeatedPlace> places = read_repeat(*repeat);
  if (!reader.failed()) check_triangles(reader, *repeat, mesh, places.size());
  const MeshInstance model = instance;
  for (std::size_t i = 0; i < places.size() && !reader.failed(); ++i) {
    instance.name = fmt::format("{}-{}", model.name, i + 1);
    instance.world_from_object =
        glm::translate(Mat4(1.0), places[i].offset) * model.world_from_object * places[i].own;
    place_parts(reader, node, mesh, materials, instance);
  }
}

ShadowFlags read_shadow_flags(const JsonObject& object) {
  return {object.boolean("casts_shadow", true), object.boolean("receives_shadow", true)};
}

void read_instance(SceneReader& reader, const JsonNode& node) {
  const JsonObject object(node, {"name", "mesh", "material", "materials", "translate", "rotate", "scale",
                                 "matrix", "repeat", "casts_shadow", "receives_shadow"});
  const ShadowFlags flags = read_shadow_flags(object);
  const auto mesh_name = object.require("mesh");
  if (reader.failed()) return;
  NamedMesh* mesh = find_mesh(reader, *mesh_name);
  if (!mesh) return;
  mesh->used = true;
  MeshInstance instance;
  instance.name = object.string("name", mesh_name->value().text);
  instance.world_from_object = read_transform(object);
  const PartMaterials materials = read_part_materials(reader, object, *mesh);
  const std::size_t first = reader.scene.instances.size();
  place_instances(reader, node, object, *mesh, materials, instance);
  for (std::size_t i = first; i < reader.scene.instances.size() && !reader.failed(); ++i)
    reader.shadow_variants.apply(flags, reader.scene, reader.scene.instances[i]);
}

// ---- shapes ----

Sphere read_sphere(const JsonNode& node) {
  const JsonObject object(node, {"center", "radius"});
  Sphere sphere;
  if (const auto center = object.require("center")) sphere.center = center->as_vec3();
  if (const auto radius = object.require("radius"))
    sphere.radius = radius->as_number({0.0, max_coordinate, true});
  return sphere;
}

Plane read_plane(const JsonNode& node) {
  const JsonObject object(node, {"point", "normal"});
  Plane plane;
  if (const auto point = object.require("point")) plane.point = point->as_vec3();
  if (const auto normal = object.require("normal")) plane.normal = normal->as_direction();
  return plane;
}

Shape read_shape(SceneReader& reader, const JsonNode& node) {
  const std::vector<std::string_view> kinds{"sphere",     "plane",       "ellipsoid", "cylinder", "cone",
                                            "paraboloid", "hyperboloid", "torus",     "implicit"};
  std::vector<std::string_view> keys{"name", "material", "casts_shadow", "receives_shadow"};
  keys.insert(keys.end(), kinds.begin(), kinds.end());
  const JsonObject object(node, keys);
  Shape shape;
  const std::string_view kind = object.exactly_one(kinds);
  if (kind == "sphere")
    shape.geometry = read_sphere(*object.find("sphere"));
  else if (kind == "plane")
    shape.geometry = read_plane(*object.find("plane"));
  else if (!kind.empty())
    shape.geometry = read_solid(kind, *object.find(kind));
  shape.name = object.string("name", fmt::format("{}-{}", kind, reader.scene.shapes.size() + 1));
  if (const auto material = object.require("material")) shape.material = find_material(reader, *material);
  const ShadowFlags flags = read_shadow_flags(object);
  if (!reader.failed()) shape.material = reader.shadow_variants.material(flags, reader.scene, shape.material);
  return shape;
}

}  // namespace

void read_meshes(SceneReader& reader, const JsonNode& list) {
  for (const JsonNode& node : list.as_array()) {
    const JsonObject object(
        node, {"name", "file", "vertices", "triangles", "normals", "uvs", "colors", "generate"});
    const auto name = object.require("name");
    if (!name || reader.failed()) return;
    const std::string text = name->as_string();
    if (reader.names.meshes.contains(text))
      return name->error(fmt::format("another mesh has this name (got \"{}\")", printable(text)));
    reader.names.meshes[text] = read_mesh(reader, object, text);
    if (reader.failed()) return;
  }
}

void read_instances(SceneReader& reader, const JsonNode& list) {
  for (const JsonNode& node : list.as_array()) {
    read_instance(reader, node);
    if (reader.failed()) return;
  }
}

void read_shapes(SceneReader& reader, const JsonNode& list) {
  for (const JsonNode& node : list.as_array()) {
    Shape shape = read_shape(reader, node);
    if (reader.failed()) return;
    reader.scene.shapes.push_back(std::move(shape));
  }
}

}  // namespace gnomon
