// Which shadow maps and which kinds of bias the engines have that people tune for, so that the tuner offers what can be set.
#pragma once

#include <span>
#include <string_view>

#include "raster/options.h"

namespace gnomon::compare {

struct TunedEngine {
  std::string_view key;   ///< "unity"
  std::string_view name;  ///< as EngineUnit::engine has it
  std::span<const raster::Technique> techniques;
  bool slope_bias, normal_offset, front_faces_culled;
  bool constant_in_texels;  ///< of each cascade's own texel

  /// Whether the engine can be set to draw with these options: its techniques, and of their biases a constant and those above.
  bool draws(const raster::MapOptions& map) const;
};

std::span<const TunedEngine> tuned_engines();
/// nullptr: none has this key.
const TunedEngine* find_engine(std::string_view key);
/// The one that a renderer's name begins with, such as "Godot 3 (RenderDoc)"; nullptr: none.
const TunedEngine* engine_of_renderer(std::string_view name);
/// Whether any of them draws it.
bool any_engine_draws(const raster::MapOptions& map);

}  // namespace gnomon::compare
