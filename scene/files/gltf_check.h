// A strict look at a glTF or GLB file before the lenient parser reads it: the container, the types of what we
// use, and every index, offset and count, so that a mistake has a place and nothing reads past a buffer.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/expected.h"
#include "scene/files/json_document.h"

namespace gnomon {

/// The JSON of the file, checked, and what of it cannot be shown.
struct CheckedGltf {
  JsonDocument document;
  bool is_binary = false;
  std::vector<std::string> notes;
};

Expected<CheckedGltf> check_gltf(std::string_view bytes, const std::string& file);

}  // namespace gnomon
