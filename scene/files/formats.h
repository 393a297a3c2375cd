// One function per file format, and what they share. A LoadedFile is what a file says and nothing more;
// load.cpp then makes up what is missing (defaults.h) and checks the whole (validate.h).
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scene/load.h"

namespace gnomon {

struct LoadedPath : KeyedPath {
  std::vector<NodeChain> cameras{};  ///< of each of the file's; empty where it does not move
};

/// A mesh of the file may consist of several, each with a material of its own or none.
struct MeshPart {
  std::string name;
  std::uint32_t mesh = 0;
  Mat4 mesh_from_part{1.0};
  std::uint32_t material = no_id;
  bool has_own_material = false;
};

struct NamedMesh {
  std::vector<MeshPart> parts;
  bool used = false;
};

/// What a JSON scene gives names to, for itself and for whoever includes it; the names inside a model are its own affair.
struct FileNames {
  std::map<std::string, std::uint32_t, std::less<>> materials{};
  std::map<std::string, NamedMesh, std::less<>> meshes{};
};

struct LoadedFile {
  Scene scene;
  std::vector<NamedCamera> cameras{};  ///< the file's, in its order
  bool has_camera = false;             ///< the scene's camera is one of them
  std::vector<LoadedPath> paths{};     ///< of a glTF file only where LoadOptions asks for them
  FileNames names{};
  /// Why a light is made up, where the scene has none.
  std::string why_none = "the file has none";
  bool is_model = false;  ///< a bare model: geometry that brings no world around it (glTF, OBJ, PLY)
};

/// Guards against files that include each other, or too many of them.
struct IncludeState {
  std::vector<std::string> open;  ///< canonical paths of the files being read, outermost first
  int total = 0;
};
inline constexpr int max_includes = 256;

/// `file` is the name for messages; `folder` is where paths in the file start.
Expected<LoadedFile> read_json_scene(std::string_view text, const std::string& file,
                                     const std::string& folder, const LoadOptions& options,
                                     IncludeState& includes);
Expected<LoadedFile> read_gltf(std::string_view bytes, const std::string& file, const std::string& folder,
                               const LoadOptions& options);
Expected<LoadedFile> read_obj(std::string_view text, const std::string& file, const std::string& folder,
                              const LoadOptions& options);
Expected<LoadedFile> read_ply(std::string_view bytes, const std::string& file);

/// Chooses by the extension; `bytes` are the file's.
Expected<LoadedFile> read_by_extension(std::string_view bytes, const std::string& path,
                                       const LoadOptions& options, IncludeState& includes);

/// A JSON scene that is not in a file of its own: built-in scenes, and what is yet to be written. Errors as of
/// load_scene().
Expected<Scene> load_json_scene(std::string_view text, const std::string& file, const std::string& folder,
                                const LoadOptions& options);

/// A vertex colour as OBJ and PLY have it: RGB is sRGB-encoded, as MeshLab, Blender and three.js write and read it;
/// kept within [0, 1].
Vec4f linear_color(const Vec3f& srgb, float alpha);

/// The material of model files that give none: neutral grey; white where vertices have colours.
Material model_material(std::string name, bool has_colors = false);

// Models in formats that the project does not read itself: assimp, in a process of its own, makes glTF of them.

/// What to do about a format that is not read at all (".blend": export it from there as .glb); empty for others.
std::string_view foreign_hint(std::string_view extension);

/// Reads the file by way of glTF. The program `assimp` (Debian: assimp-utils) gets two minutes of processor time, 4 GB of
/// memory and no file but this one (scene/base/run_apart.h). What shows further files in its place is an error. What it cannot
/// read is an error with its own words, that it is not there one of ErrorKind::bad_input. A note says what glTF by assimp
/// lacks. `folder` is where its textures lie, which are read as those of a glTF file.
Expected<LoadedFile> read_foreign(std::string_view bytes, const std::string& file, const std::string& folder,
                                  const LoadOptions& options);

}  // namespace gnomon
