// What kinds of lights are called, in scene files and in results.
#pragma once

#include <array>
#include <string_view>

#include "scene/scene.h"

namespace gnomon {

/// By LightType.
inline constexpr std::array<std::string_view, 3> light_type_names{"directional", "point", "spot"};
inline std::string_view light_type_name(LightType type) {
  return light_type_names[static_cast<std::size_t>(type)];
}

}  // namespace gnomon
