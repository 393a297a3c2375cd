// A glTF or GLB file (glTF 2.0), read strictly. The container, the types of what we use, and every index, offset and
// count are checked where they are read. So a mistake has a place and nothing reads past a buffer.
//
// The model holds what shapes and places meshes. What one reader alone asks for (buffers, images, materials, textures,
// animations) stays in the JSON tree: gltf_data.h, gltf_materials.h, gltf_paths.cpp.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"
#include "scene/files/json/json_document.h"
#include "scene/math.h"

namespace gnomon {
namespace gltf {

/// Values of accessor.componentType (section 3.6.2.2).
enum ComponentType : int {
  signed_byte = 5120,
  unsigned_byte = 5121,
  signed_short = 5122,
  unsigned_short = 5123,
  unsigned_int = 5125,
  float_32 = 5126
};
/// Values of primitive.mode (section 5.24.4).
enum Mode : int { triangles = 4, triangle_strip = 5, triangle_fan = 6 };

enum class ElementType : std::uint8_t { scalar, vec2, vec3, vec4, mat2, mat3, mat4 };
std::size_t components_of(ElementType type);
std::size_t bytes_of(ComponentType type);

// An index of -1 says that there is none.

struct SparsePart {
  std::size_t view = 0, offset = 0;
};
/// Elements of an accessor that are replaced (section 3.6.2.3).
struct Sparse {
  std::size_t count = 0;
  SparsePart indices, values;
  ComponentType index_type = unsigned_int;
};
struct Accessor {
  int view = -1;
  std::size_t offset = 0, count = 0;
  ElementType type = ElementType::scalar;
  ComponentType component = float_32;
  bool normalized = false;
  std::optional<Sparse> sparse{};
};

using Attributes = std::map<std::string, int, std::less<>>;  ///< accessors by their meaning
struct Primitive {
  int mode = triangles, material = -1, indices = -1;
  Attributes attributes{};
  std::vector<Attributes> targets{};
  const JsonValue* extensions = nullptr;
};
/// The accessor of that name; -1: none.
int attribute(const Attributes& attributes, std::string_view name);
struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
  std::vector<double> weights;
};
struct Skin {
  std::vector<std::size_t> joints;
  int inverse_bind_matrices = -1;
};
struct Camera {
  std::string name;
  bool is_perspective = true;
  double vertical_fov = 0.0;  ///< radians
  double half_height = 0.0;   ///< of an orthographic picture
};
/// A light of KHR_lights_punctual.
struct Light {
  std::string name, type;
  Vec3 color{1.0};
  double intensity = 1.0, range = 0.0;                          ///< range 0: none is given
  double inner_cone_angle = 0.0, outer_cone_angle = 0.25 * pi;  ///< radians
};
struct Node {
  std::string name;
  int mesh = -1, camera = -1, skin = -1, light = -1, parent = -1;
  bool visible = true;
  bool casts_shadow = true, receives_shadow = true;  ///< by its extras
  std::vector<std::size_t> children;
  std::vector<double> weights;
  std::optional<Mat4> matrix;  ///< where it is given, the three parts are not
  std::optional<Vec3> translation, scale;
  std::optional<Vec4> rotation;  ///< x, y, z, w
  const JsonValue* extensions = nullptr;
};

struct Model {
  std::vector<Accessor> accessors;
  std::vector<Mesh> meshes;
  std::vector<Skin> skins;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  std::vector<Node> nodes;  ///< trees: everyone has one parent at most and is not below itself
  std::vector<std::vector<std::size_t>> scenes;  ///< their nodes
  int default_scene = -1;
};

}  // namespace gltf

/// The JSON of a file and the model that it says. The model points into the tree, below its root: moving a GltfDocument
/// leaves those values where they are.
struct GltfDocument {
  JsonDocument json;
  gltf::Model model{};
  bool is_binary = false;
  std::vector<std::string> notes{};  ///< what of it cannot be shown
};

/// Errors (bad_input) name the file, the line and column where the file is text, and the path of the value.
Expected<GltfDocument> parse_gltf(std::string_view bytes, const std::string& file);

}  // namespace gnomon
