// A glTF file under construction. Private to the writer.
#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "scene/base/expected.h"
#include "scene/scene.h"

namespace gnomon::gltf_writer {

using Json = nlohmann::ordered_json;

struct File {
  Json json = Json::object();
  std::string binary;                ///< the one buffer
  std::set<std::string> extensions;  ///< used
  std::vector<std::string> notes;

  /// Appends to json[list] and returns the new index.
  std::size_t add(const char* list, Json value) {
    Json& items = json[list];
    items.push_back(std::move(value));
    return items.size() - 1;
  }
  /// The bytes, aligned to four, as a bufferView. `target`: 34962 vertices, 34963 indices, 0 neither.
  std::size_t add_view(std::string_view bytes, int target);
};

/// The shortest decimal number that reads back as this float.
double shortest(float value);
Json shortest(const Vec3f& value);
Json array(const Vec3& value);
/// Column by column.
Json array(const Mat4& value);

/// The textures, and one glTF material for each of ours, in the same order.
Expected<void> write_materials(File& file, const Scene& scene);
/// Meshes and a node for each instance.
void write_instances(File& file, const Scene& scene);

}  // namespace gnomon::gltf_writer
