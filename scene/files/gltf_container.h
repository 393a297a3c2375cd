// The GLB container (glTF 2.0, section 4).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scene/expected.h"

namespace gnomon {

struct GlbChunks {
  std::string_view json;
  std::optional<std::string_view> binary;
};

bool is_glb(std::string_view bytes);
Expected<GlbChunks> read_glb(std::string_view bytes, const std::string& file);

}  // namespace gnomon
