// From a path or a name to a whole, checked scene.
#include "scene/load.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <filesystem>
#include <future>
#include <map>
#include <new>

#include "scene/base/threads.h"
#include "scene/files/defaults.h"
#include "scene/files/encodings.h"
#include "scene/files/formats.h"
#include "scene/files/json/json_reader.h"
#include "scene/files/mapped_file.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/validate.h"

namespace gnomon {
namespace {

struct FormatInput {
  std::string_view bytes;
  const std::string& path;
  std::string folder;
  const LoadOptions& options;
  IncludeState& includes;
};
struct FormatRow : SceneFormat {
  Expected<LoadedFile> (*read)(const FormatInput&);
};
using In = const FormatInput&;
constexpr auto by_gltf = [](In in) { return read_gltf(in.bytes, in.path, in.folder, in.options); };
constexpr auto by_assimp = [](In in) { return read_foreign(in.bytes, in.path, in.folder, in.options); };
/// Every format that is read, and how.
constexpr FormatRow formats[] = {
    {{".json"}, [](In in) { return read_json_scene(in.bytes, in.path, in.folder, in.options, in.includes); }},
    {{".gltf"}, by_gltf},
    {{".glb"}, by_gltf},
    {{".obj"}, [](In in) { return read_obj(in.bytes, in.path, in.folder, in.options); }},
    {{".ply"}, [](In in) { return read_ply(in.bytes, in.path); }},
    {{".stl", true}, by_assimp},
    {{".fbx", true}, by_assimp},
    {{".dae", true}, by_assimp},
    {{".3ds", true}, by_assimp},
    {{".x3d", true}, by_assimp},
    {{".3mf", true}, by_assimp}};

std::size_t camera_index(const std::vector<NamedCamera>& cameras, const std::string& wanted) {
  for (std::size_t i = 0; i < cameras.size(); ++i)
    if (cameras[i].name == wanted) return i;
  std::size_t index = 0;
  const char* const last = wanted.data() + wanted.size();
  const auto [end, status] = std::from_chars(wanted.data(), last, index);
  return end == last && status == std::errc() ? index : cameras.size();
}

/// The camera that was asked for, or the first; a note says which of several.
Expected<void> choose_camera(LoadedFile& loaded, const LoadOptions& options) {
  const std::string& wanted = options.camera;
  const std::vector<NamedCamera>& cameras = loaded.cameras;
  std::vector<std::string_view> names;
  for (const NamedCamera& camera : cameras) names.push_back(camera.name);
  if (cameras.empty()) {
    if (wanted.empty()) return {};
    return fail(ErrorKind::usage,
                fmt::format("--camera: the scene has no camera of its own (got {})", printable(wanted)));
  }
  const std::size_t index = wanted.empty() ? 0 : camera_index(cameras, wanted);
  if (index >= cameras.size())
    return fail(ErrorKind::usage,
                fmt::format("--camera: the scene has no such camera (got {}, allowed {}, or 0 to {}){}",
                            printable(wanted), fmt::join(names, ", "), cameras.size() - 1,
                            suggestion(wanted, names)));
  loaded.scene.camera = cameras[index].camera;
  loaded.has_camera = true;
  for (LoadedPath& path : loaded.paths)
    if (index < path.cameras.size()) path.camera = std::move(path.cameras[index]);
  if (cameras.size() > 1 && options.cameras == nullptr)
    loaded.scene.notes.push_back(fmt::format("The camera {} is used; --camera takes {}, or 0 to {}.",
                                             cameras[index].name, fmt::join(names, ", "),
                                             cameras.size() - 1));
  return {};
}

/// Looks at all of the file's cameras where they are asked for.
std::optional<Error> find_camera_defect(Scene& scene, const LoadOptions& options) {
  if (options.cameras == nullptr) return std::nullopt;
  const Camera own = scene.camera;
  std::optional<Error> defect;
  for (const NamedCamera& each : *options.cameras) {
    scene.camera = each.camera;
    if (!defect) defect = find_setting_defect(scene);
  }
  scene.camera = own;
  return defect;
}

/// `sha256`: of the file's bytes.
Expected<Scene> complete(Expected<LoadedFile> loaded, const std::string& path,
                         std::future<std::string> sha256, const LoadOptions& options) {
  if (!loaded) {
    Error error = loaded.error();
    if (error.file.empty()) error.file = path;
    return fail(std::move(error));
  }
  if (const auto chosen = choose_camera(*loaded, options); !chosen) return fail(chosen.error());
  // Indices and coordinates are checked before anything follows them; defaults leave meshes as they are.
  if (auto defect = find_geometry_defect(loaded->scene)) {
    defect->file = path;
    return fail(std::move(*defect));
  }
  if (options.paths != nullptr) {
    std::erase_if(loaded->paths, [](const LoadedPath& each) {
      return !each.moves_camera() && each.lights.empty() && !each.objects_until;
    });
    options.paths->assign(loaded->paths.begin(), loaded->paths.end());
  }
  if (options.cameras != nullptr) *options.cameras = loaded->cameras;
  Scene scene = add_defaults(std::move(*loaded));
  scene.path = path;
  scene.sha256 = sha256.get();
  if (scene.name.empty()) scene.name = std::filesystem::path(path).stem().string();
  if (auto defect = find_setting_defect(scene)) {
    defect->file = path;
    return fail(std::move(*defect));
  }
  if (auto defect = find_camera_defect(scene, options); defect) {
    defect->file = path;
    return fail(std::move(*defect));
  }
  return scene;
}

/// On a thread of its own where that is worth one.
std::future<std::string> hash_beside(std::string_view bytes) {
  constexpr std::size_t large = std::size_t{1} << 19;
  const auto hash = [bytes] { return sha256_hex(bytes); };
  return bytes.size() < large ? std::async(std::launch::deferred, hash) : in_background(hash);
}

Error unknown_name(const std::string& name) {
  std::vector<std::string_view> names;
  for (const BuiltinScene& scene : builtin_scenes()) names.push_back(scene.name);
  // No name of a scene is too long for a file's, but what was given may be.
  if (const FileKind kind = file_kind_or_none(name); kind != FileKind::none) {
    Error error{ErrorKind::bad_input,
                kind == FileKind::folder
                    ? std::string("is a folder, not a file")
                    : fmt::format("the file's format is told by its extension, and it has none (allowed {})",
                                  extensions_text())};
    error.file = name;
    return error;
  }
  return {ErrorKind::bad_input,
          fmt::format("no built-in scene of this name (got \"{}\"){}; \"gnomon scenes\" lists them",
                      printable(name), suggestion(name, names))};
}

Error no_memory(const std::string& file) {
  Error error{ErrorKind::graphics, "not enough memory to load the scene"};
  error.file = file;
  return error;
}

Expected<Scene> load_file(const std::string& path, const LoadOptions& options) {
  const auto file = MappedFile::open(path);
  if (!file) return fail(file.error());
  const std::string_view bytes = file->bytes();
  IncludeState includes;
  auto sha256 = hash_beside(bytes);
  LoadOptions rooted = options;
  rooted.root = folder_of(path);
  if (options.files != nullptr) options.files->push_back(path);
  return complete(read_by_extension(bytes, path, rooted, includes), path, std::move(sha256), options);
}

}  // namespace

namespace {

std::vector<SceneSetting> settings_in(std::string_view source, const std::string& name) {
  const auto document = parse_json(source, name);
  const JsonMember* settings = document ? document->root.find("settings") : nullptr;
  std::vector<SceneSetting> out;
  if (settings == nullptr) return out;
  for (const JsonMember& member : settings->value.members) {
    if (member.value.type != JsonValue::Type::string) continue;
    const LineColumn at = line_column(source, member.value.begin);
    out.push_back({member.key, member.value.text, at.line, at.column});
  }
  return out;
}

}  // namespace

std::vector<SceneSetting> scene_settings(const std::string& path_or_name) {
  if (const auto builtin = find_builtin_scene(path_or_name)) {
    thread_local std::map<std::string, std::vector<SceneSetting>>
        known;  // a sweep asks for each of its cells
    const auto found = known.find(path_or_name);
    if (found != known.end()) return found->second;
    return known[path_or_name] = settings_in(builtin->text, path_or_name);
  }
  if (lower_extension(path_or_name) != ".json") return {};
  const auto bytes = read_file(path_or_name);
  return bytes ? settings_in(*bytes, path_or_name) : std::vector<SceneSetting>();
}

std::vector<SceneFormat> scene_formats() {
  return {std::begin(formats), std::end(formats)};
}

std::string extensions_text(std::optional<bool> by_assimp) {
  std::string text;
  for (const SceneFormat& format : formats)
    if (by_assimp.value_or(format.by_assimp) == format.by_assimp)
      text += fmt::format("{}{}", text.empty() ? "" : " ", format.extension);
  return text;
}

Expected<LoadedFile> read_by_extension(std::string_view bytes, const std::string& path,
                                       const LoadOptions& options, IncludeState& includes) {
  const std::string extension = lower_extension(path);
  for (const FormatRow& format : formats)
    if (format.extension == extension) return format.read({bytes, path, folder_of(path), options, includes});
  const std::string_view hint = foreign_hint(extension);
  Error error{ErrorKind::bad_input,
              fmt::format("unknown extension (got \"{}\", allowed {}){}{}", printable(extension),
                          extensions_text(), hint.empty() ? "" : "; ", hint)};
  error.file = path;
  return fail(std::move(error));
}

Expected<Scene> load_json_scene(std::string_view text, const std::string& file, const std::string& folder,
                                const LoadOptions& options) try {
  IncludeState includes;
  auto sha256 = hash_beside(text);
  return complete(read_json_scene(text, file, folder, options, includes), file, std::move(sha256), options);
} catch (const std::bad_alloc&) {
  return fail(no_memory(file));
}

Expected<Scene> load_scene(const std::string& path_or_name, const LoadOptions& options) try {
  if (!lower_extension(path_or_name).empty()) return load_file(path_or_name, options);
  if (const auto builtin = find_builtin_scene(path_or_name))
    return load_json_scene(builtin->text, path_or_name, "", options);
  return fail(unknown_name(path_or_name));
} catch (const std::bad_alloc&) {
  return fail(no_memory(path_or_name));
}

}  // namespace gnomon
