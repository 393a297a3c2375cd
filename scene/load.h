// Scene files: the project's own JSON (scene/files/scene.schema.json), glTF 2.0 / GLB, OBJ+MTL, PLY and what assimp makes glTF
// of, and the built-in scenes by name. The format is told by the extension (scene_formats); a name without one is a built-in
// scene.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"
#include "scene/keyed_path.h"
#include "scene/scene.h"

namespace gnomon {

class TextureMemory;

struct LoadOptions {
  bool confine_paths = false;  ///< refuse files outside the scene's own folder
  std::string camera{};        ///< of the file's cameras: a name, or a number from 0; empty: the first
  std::string root{};          ///< the scene's own folder; load_scene sets it to where the main file lies
  /// Where given, what textures may take (scene/files/pictures/texture_memory.h); more is an error (graphics).
  TextureMemory* textures = nullptr;
  std::vector<std::string>* files = nullptr;  ///< where given, takes the path of every file that is named
  /// Where given, takes the paths along which the file itself moves the chosen camera and lights: "paths" of a scene in
  /// the project's own format, animations of a glTF file. Those of included files are not read.
  std::vector<KeyedPath>* paths = nullptr;
  /// Names a glTF file's animation, by its path's name, whose objects stand as they do at so many seconds (nodes with
  /// meshes, joints of skins, weights of morph targets); empty: all as it is stored.
  std::string animation{};
  double seconds = 0.0;
  /// Where given, takes all of the file's cameras, in its order, and no note says which one is used.
  std::vector<NamedCamera>* cameras = nullptr;
};

/// The whole scene, checked: indices in range, finite positions, unit directions, at least one material, one
/// light and a camera. What the loader had to make up (camera, light, ground) or could not use is in
/// Scene::notes. Errors are ErrorKind::bad_input with file, line and column, or the path inside the file.
/// ErrorKind::usage when the file has no such camera. ErrorKind::graphics (resources) when there is not
/// enough memory.
Expected<Scene> load_scene(const std::string& path_or_name, const LoadOptions& options = {});

/// A format that load_scene() reads.
struct SceneFormat {
  std::string_view extension;  ///< ".glb", in lower case
  bool by_assimp = false;      ///< by way of glTF, which assimp makes of it
};
/// All of them, those by way of assimp last.
std::vector<SceneFormat> scene_formats();
/// ".json .gltf .glb .obj .ply .stl ...": all of them, or those alone that are, or are not, read by way of assimp.
std::string extensions_text(std::optional<bool> by_assimp = std::nullopt);

/// What a scene file asks for: an option of the command line without its dashes ("map-size"), and its value.
struct SceneSetting {
  std::string option, value;
  int line = 0, column = 0;  ///< of the value, from 1
};
/// "settings" of a scene in the project's own format. Empty where there are none, and where the file does not
/// parse; without what is no text: load_scene says why.
std::vector<SceneSetting> scene_settings(const std::string& path_or_name);

struct BuiltinScene {
  std::string_view name;
  std::string_view description;  ///< one sentence
  bool large = false;            ///< millions of triangles
};
std::vector<BuiltinScene> builtin_scenes();

// The built-in scenes' files, embedded in the program, so that their names work anywhere. The loader reads
// them as it reads any other scene file.

struct BuiltinFile {
  std::string_view name;  ///< the scene's name
  std::string_view text;  ///< the JSON
};

/// nullopt when there is no built-in scene of that name.
std::optional<BuiltinFile> find_builtin_scene(std::string_view name);

}  // namespace gnomon
