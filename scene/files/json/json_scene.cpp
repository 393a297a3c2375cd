// The top level of a JSON scene: version, camera, picture settings and includes.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "scene/files/json/json_parts.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace {

constexpr std::string_view schema_name = "gnomon/scene/1";
constexpr NumberRange sample_range{1.0, max_samples, false, false, true};

// The offset of a member of an object, for errors that are found after reading.
std::size_t offset_of(const JsonValue& object, std::string_view key) {
  const JsonMember* member = object.find(key);
  return member ? member->value.begin : object.begin;
}

std::string canonical(const std::string& path) {
  std::error_code error;
  const auto real = std::filesystem::weakly_canonical(path, error);
  return error ? path : real.string();
}

void check_cycle(SceneReader& reader, const JsonNode& node, const std::string& path) {
  const auto& open = reader.includes.open;
  const auto found = std::find(open.begin(), open.end(), canonical(path));
  if (found != open.end()) {
    std::string chain;
    for (auto it = found; it != open.end(); ++it)
      chain += std::filesystem::path(*it).filename().string() + " -> ";
    node.error(fmt::format("the files include each other ({}{})", chain,
                           std::filesystem::path(path).filename().string()));
  }
  if (++reader.includes.total > max_includes)
    node.error(fmt::format("too many included files (allowed {})", max_includes));
}

// Names of the included file's materials become names of ours.
void adopt_names(SceneReader& reader, const JsonNode& node, FileNames&& names, const MergeOffsets& offsets) {
  for (const auto& [name, material] : names.materials)
    if (!reader.names.materials.emplace(name, material + offsets.material).second)
      node.error(fmt::format("the file has a material \"{}\", and so has another", printable(name)));
  for (auto& [name, mesh] : names.meshes) {
    mesh.used = true;
    for (MeshPart& part : mesh.parts) {
      part.mesh += offsets.mesh;
      if (part.material != no_id) part.material += offsets.material;
    }
    if (!reader.names.meshes.emplace(name, std::move(mesh)).second)
      node.error(fmt::format("the file has a mesh \"{}\", and so has another", printable(name)));
  }
}

/// What an included file says of the whole picture is the including file's to say.
void note_unused_settings(const Scene& included, bool has_camera, const std::string& path,
                          std::vector<std::string>& notes) {
  const Scene usual;
  std::vector<std::string_view> unused;
  const auto check = [&](bool differs, std::string_view name) {
    if (differs) unused.push_back(name);
  };
  check(has_camera, "camera");
  check(included.ambient != usual.ambient, "ambient light");
  check(included.background != usual.background, "background");
  check(included.exposure != usual.exposure, "exposure");
  check(included.max_depth != usual.max_depth, "recursion limit");
  check(included.glossy_samples != usual.glossy_samples, "glossy samples");
  check(included.indirect_samples != usual.indirect_samples, "indirect samples");
  for (const std::string_view name : unused)
    notes.push_back(fmt::format("The {} of the included file {} {} not used.", name, path,
                                name.ends_with("samples") ? "are" : "is"));
}

void read_include(SceneReader& reader, const JsonNode& node, bool with_lights) {
  const std::string path = reader.resolve(node);
  if (reader.failed()) return;
  check_cycle(reader, node, path);
  if (reader.failed()) return;
  const auto bytes = read_file(path);
  if (!bytes) return reader.adopt(node, bytes.error());
  auto loaded = read_by_extension(*bytes, path, reader.options, reader.includes);
  if (!loaded) return reader.adopt(node, loaded.error());
  note_unused_settings(loaded->scene, loaded->has_camera, path, reader.scene.notes);
  if (loaded->scene.lights.empty() && loaded->why_none != LoadedFile{}.why_none)
    reader.why_none = loaded->why_none;
  if (!with_lights && !loaded->scene.lights.empty()) {
    reader.why_none = "the included lights are left out";
    loaded->scene.lights.clear();
  }
  const MergeOffsets offsets = merge_scene(reader.scene, std::move(loaded->scene), true);
  adopt_names(reader, node, std::move(loaded->names), offsets);
}

void check_schema(const JsonObject& top) {
  const auto node = top.require("schema");
  if (node && node->as_string() != schema_name)
    node->wrong("not a scene of this version", fmt::format("\"{}\"", schema_name));
}

void read_settings(SceneReader& reader, const JsonObject& top) {
  Scene& scene = reader.scene;
  scene.name = top.string("name", scene.name);
  top.string("description");  // for people
  scene.ambient = top.color("ambient", scene.ambient);
  scene.background = top.color("background", scene.background);
  if (const auto node = top.find("exposure")) scene.exposure = node->as_number({0.0, max_radiance, true});
  scene.max_depth =
      static_cast<int>(top.number("max_depth", scene.max_depth, {0.0, 64.0, false, false, true}));
  const auto samples = [&](std::string_view key, int& field) {
    const auto node = top.find(key);
    if (!node) return;
    const JsonObject object(*node, {"samples"});
    if (const auto count = object.require("samples"))
      field = static_cast<int>(count->as_number(sample_range));
  };
  if (const auto node = top.find("settings")) {
    if (!node->is(JsonValue::Type::object)) node->wrong("not an object", "options and their values");
    for (const JsonMember& member : node->value().members) node->child(member.key)->as_string();
  }
  samples("glossy", scene.glossy_samples);
  samples("indirect", scene.indirect_samples);
}

void note_unused_meshes(SceneReader& reader) {
  for (const auto& [name, mesh] : reader.names.meshes)
    if (!mesh.used)
      reader.scene.notes.push_back(fmt::format("The mesh '{}' is not used by any instance.", name));
}

NamedCamera read_named_camera(SceneReader& reader, const JsonNode& node,
                              const std::vector<NamedCamera>& before) {
  NamedCamera named = read_camera(reader, node);
  if (named.name.empty()) node.error("a camera of the list needs a name, for --camera");
  for (const NamedCamera& other : before)
    if (other.name == named.name)
      node.error(fmt::format("another camera has this name (got \"{}\")", printable(named.name)));
  return named;
}

LoadedPath read_named_path(const JsonNode& node, const std::vector<LoadedPath>& before) {
  const JsonObject object(node, {"name", "camera", "lights"});
  LoadedPath path;
  if (const auto name = object.require("name")) path.name = name->as_string();
  for (const LoadedPath& other : before)
    if (other.name == path.name)
      node.error(fmt::format("another path has this name (got \"{}\")", printable(path.name)));
  read_path_keys(object, path);
  return path;
}

void read_paths(SceneReader& reader, const JsonNode& list, std::vector<LoadedPath>& paths) {
  for (const JsonNode& node : list.as_array()) {
    if (reader.failed()) return;
    paths.push_back(read_named_path(node, paths));
    for (const auto& [name, keys] : paths.back().lights)
      if (std::none_of(reader.scene.lights.begin(), reader.scene.lights.end(),
                       [&name = name](const Light& light) { return light.name == name; }))
        node.error(fmt::format("the scene has no light \"{}\"", printable(name)));
  }
}

// The order matters: what is named must be known before it is used.
std::vector<NamedCamera> read_top(SceneReader& reader, const JsonNode& root, std::vector<LoadedPath>& paths) {
  const JsonObject top(
      root, {"$schema",    "schema",   "name",      "description", "camera",   "cameras",        "lights",
             "materials",  "meshes",   "instances", "shapes",      "include",  "include_lights", "ambient",
             "background", "exposure", "max_depth", "glossy",      "indirect", "settings",       "paths"});
  check_schema(top);
  read_settings(reader, top);
  const bool with_lights = top.boolean("include_lights", true);
  if (const auto list = top.find("include"))
    for (const JsonNode& node : list->as_array())
      if (!reader.failed()) read_include(reader, node, with_lights);
  if (const auto list = top.find("materials")) read_materials(reader, *list);
  if (const auto list = top.find("meshes")) read_meshes(reader, *list);
  if (const auto list = top.find("instances")) read_instances(reader, *list);
  if (const auto list = top.find("shapes")) read_shapes(reader, *list);
  if (const auto list = top.find("lights")) read_lights(reader, *list);
  if (const auto list = top.find("paths")) read_paths(reader, *list, paths);
  note_unused_meshes(reader);
  if (reader.scene.instances.empty() && reader.scene.shapes.empty())
    root.error("the scene shows nothing (needs instances, shapes or include)");
  std::vector<NamedCamera> cameras;
  if (const auto camera = top.find("camera")) {
    cameras.push_back(read_camera(reader, *camera));
    if (cameras.front().name.empty()) cameras.front().name = "camera";
  }
  if (const auto list = top.find("cameras"))
    for (const JsonNode& node : list->as_array())
      if (!reader.failed()) cameras.push_back(read_named_camera(reader, node, cameras));
  return cameras;
}

}  // namespace

void SceneReader::adopt(const JsonNode& node, Error error) {
  if (errors.first) return;
  if (error.file.empty() && error.kind == ErrorKind::bad_input) return node.error(error.reason);
  // An error inside the other file speaks for itself; one about the file as such belongs to the line that
  // names it.
  if (error.kind != ErrorKind::bad_input || error.line > 0 || !error.field.empty())
    errors.first = std::move(error);
  else
    node.error(fmt::format("{}: {}", error.file, error.reason));
}

std::string SceneReader::resolve(const JsonNode& named) {
  const std::string name = named.as_string();
  if (failed()) return {};
  if (name.empty() || name.find('\0') != std::string::npos) {
    named.wrong("not a path", "the path of a file");
    return {};
  }
  const auto path = resolve_path(folder, name, options);
  if (path) return *path;
  named.error(path.error().reason);
  return {};
}

NamedCamera read_camera(SceneReader& reader, const JsonNode& node) {
  const JsonObject object(node, {"name", "eye", "target", "up", "vertical_fov_degrees", "orthographic_height",
                                 "samples_per_pixel"});
  NamedCamera named{object.string("name", ""), {}};
  Camera& camera = named.camera;
  if (const auto eye = object.require("eye")) camera.eye = eye->as_vec3();
  if (const auto target = object.require("target")) camera.target = target->as_vec3();
  if (const auto up = object.find("up")) camera.up = up->as_vec3();
  if (const auto height = object.find("orthographic_height")) {
    camera.orthographic_height = height->as_number({0.0, 1e12, true, false});
    if (object.find("vertical_fov_degrees"))
      height->error("does not go with vertical_fov_degrees: an orthographic camera has no angle");
  } else {
    camera.vertical_fov = object.number("vertical_fov_degrees", 40.0, {0.0, 180.0, true, true}) * pi / 180.0;
  }
  camera.samples_per_pixel = static_cast<int>(object.number("samples_per_pixel", 1.0, sample_range));
  if (reader.failed()) return named;
  if (const auto defect = find_camera_defect(camera)) {
    const std::string key = defect->field.substr(defect->field.find('.') + 1);
    reader.errors.add(offset_of(node.value(), key), defect->field, defect->reason);
  }
  return named;
}

Expected<LoadedFile> read_json_scene(std::string_view text, const std::string& file,
                                     const std::string& folder, const LoadOptions& options,
                                     IncludeState& includes) {
  const auto document = parse_json(text, file);
  if (!document) return fail(document.error());
  JsonErrors errors{*document};
  LoadedFile loaded;
  loaded.scene.name = std::filesystem::path(file).stem().string();
  includes.open.push_back(canonical(file));
  SceneReader reader{errors, loaded.scene, folder, options, includes};
  loaded.cameras = read_top(reader, JsonNode(errors, document->root, ""), loaded.paths);
  loaded.has_camera = !loaded.cameras.empty();
  loaded.names = std::move(reader.names);
  if (!reader.why_none.empty()) loaded.why_none = reader.why_none;
  includes.open.pop_back();
  if (errors.first) return fail(std::move(*errors.first));
  return loaded;
}

}  // namespace gnomon
