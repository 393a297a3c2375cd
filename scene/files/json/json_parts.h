// The parts of a JSON scene (scene.schema.json says what they hold). Each function reads one list of the file
// into the scene; mistakes go to SceneReader::errors.
#pragma once

#include <map>
#include <string>

#include "scene/files/formats.h"
#include "scene/files/json/json_reader.h"
#include "scene/files/shadow_variants.h"
#include "scene/keyed_path.h"

namespace gnomon {

/// What the reading of one JSON file carries along.
struct SceneReader {
  JsonErrors& errors;
  Scene& scene;
  const std::string& folder;
  const LoadOptions& options;
  IncludeState& includes;
  FileNames names{};
  std::map<std::string, std::uint32_t> textures{};        ///< of files, by what was asked for
  std::map<std::uint32_t, std::uint32_t> plain_meshes{};  ///< copies without triangle_materials
  ShadowVariants shadow_variants{};
  std::string why_none{};  ///< of what is included; empty: nothing to say

  bool failed() const { return errors.first.has_value(); }
  /// Passes on an error that another file or a generator made; one without a file gets this node's position.
  void adopt(const JsonNode& node, Error error);
  /// The path of a file named in the scene; "" and an error when it is not allowed.
  std::string resolve(const JsonNode& named);
};

void read_materials(SceneReader& reader, const JsonNode& list);
void read_lights(SceneReader& reader, const JsonNode& list);
void read_meshes(SceneReader& reader, const JsonNode& list);
void read_instances(SceneReader& reader, const JsonNode& list);
void read_shapes(SceneReader& reader, const JsonNode& list);
/// Rotations of an instance or a shape: one, or several applied in order.
Mat4 read_rotations(const JsonNode& node);
/// One of an instance's copies: turned and scaled in the mesh's space by `own`, then placed as the instance
/// says, then moved.
struct RepeatedPlace {
  Mat4 own{1.0};
  Vec3 offset{0.0};
};
/// An instance's "repeat", row by row.
std::vector<RepeatedPlace> read_repeat(const JsonNode& node);
/// A quadric, torus or implicit surface; `kind` is its key in the shape.
decltype(Shape::geometry) read_solid(std::string_view kind, const JsonNode& node);
/// The members "camera" and "lights" of a path by keys, in a file of its own or in a scene.
void read_path_keys(const JsonObject& object, KeyedPath& path);
NamedCamera read_camera(SceneReader& reader, const JsonNode& node);

/// The material that a string names; 0 and an error when there is none.
std::uint32_t find_material(SceneReader& reader, const JsonNode& name);

/// Where the appended parts begin.
struct MergeOffsets {
  std::uint32_t material = 0, texture = 0, mesh = 0;
};

/// Appends materials, textures, meshes and notes of `from`; with `placed`, its instances, shapes and lights
/// too. Camera and picture settings of `into` stay.
MergeOffsets merge_scene(Scene& into, Scene&& from, bool placed);

}  // namespace gnomon
