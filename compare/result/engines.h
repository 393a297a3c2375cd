// The engines whose settings are known: which shadow maps they draw, and in which units they are told a bias. What is known of
// an engine stands in its row of engines.cpp; docs/engine-units.md has the formulas and where they come from.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "raster/options.h"
#include "scene/light.h"

namespace gnomon::compare {

/// What of a bias an engine's setting says.
enum class BiasPart : std::uint8_t { constant, slope, normal_offset };

struct EngineUnit {
  std::string_view engine;      ///< "three.js"
  std::string_view setting;     ///< "shadow.bias"
  std::optional<double> value;  ///< none: it cannot be derived exactly
  std::string formula;  ///< in the symbols of docs/engine-units.md; without a value, why there is none
  BiasPart part = BiasPart::constant;
};

/// The symbols of docs/engine-units.md.
struct BiasSymbols {
  double b = 0.0;  ///< constant of receivers and casters together, world units along the light's ray
  double s = 0.0;  ///< slope bias
  double f = 0.0;  ///< slope bias of casters
  double n = 0.0;  ///< normal offset, texels
  double w = 1.0;  ///< a texel's world width at depth z
  double z = 1.0;  ///< depth at the middle of the scene
  double near = 0.0, far = 1.0;  ///< of the map
  double stored_per_world =
      1.0;           ///< stored depth per world unit of depth, at depth z of a map in perspective
  double ulp = 1.0;  ///< the depth format's step
  raster::DepthFormat format = raster::DepthFormat::d32f;
  bool parallel = true, cascades = false;

  double range() const { return far - near; }
};

struct TunedEngine {
  std::string_view key;   ///< "unity"; empty of what is no engine
  std::string_view name;  ///< as EngineUnit::engine has it
  std::span<const raster::Technique> techniques;
  bool front_faces_culled = false;
  bool constant_in_texels = false;  ///< of each cascade's own texel
  bool offsets_casters = false;     ///< its slope is a polygon offset of the casters
  double filtered_constant = 1.0;   ///< by what its constant is multiplied where comparisons are filtered
  /// Where a normal offset is all that reaches the test.
  std::optional<raster::Technique> normal_offset_alone{};
  /// Adds its settings.
  void (*add_units)(const BiasSymbols&, LightType, std::vector<EngineUnit>&) = nullptr;

  /// Whether its settings tell this part of a bias, at least of a directional light.
  bool has(BiasPart part) const;
  /// Whether the engine can be set to draw with these options, and told their bias in numbers for a light of this type.
  /// They must be its techniques and filters, which follow no receiver's plane. Of the biases they may use the parts that
  /// it has.
  bool draws(const raster::MapOptions& map, LightType light) const;
  bool draws(const raster::MapOptions& map) const;  ///< for some light
};

/// All rows, polygon offset the last of them.
std::span<const TunedEngine> known_engines();
/// Those that can be tuned for.
std::span<const TunedEngine> tuned_engines();
/// nullptr: none has this key.
const TunedEngine* find_engine(std::string_view key);
/// The one that a renderer's name begins with, such as "Godot 3 (RenderDoc)"; nullptr: none.
const TunedEngine* engine_of_renderer(std::string_view name);
/// Whether any of them draws it.
bool any_engine_draws(const raster::MapOptions& map);

}  // namespace gnomon::compare
