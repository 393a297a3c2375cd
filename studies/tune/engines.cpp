#include "studies/tune/engines.h"

#include <algorithm>

namespace gnomon::compare {
namespace {

using raster::Technique;

// docs/engine-units.md says which setting of the engine each technique is.
constexpr Technique unity[] = {Technique::hard, Technique::pcf, Technique::csm};
constexpr Technique unreal[] = {Technique::pcf, Technique::pcss, Technique::csm};
constexpr Technique godot[] = {Technique::hard, Technique::pcf, Technique::pcss, Technique::csm};
constexpr Technique godot3[] = {Technique::hard, Technique::pcf, Technique::csm};
constexpr Technique bevy[] = {Technique::pcf, Technique::pcss, Technique::csm};
constexpr Technique three[] = {Technique::hard, Technique::pcf, Technique::vsm, Technique::csm};
constexpr Technique babylon[] = {Technique::hard, Technique::pcf, Technique::pcss, Technique::esm,
                                 Technique::csm};
constexpr Technique playcanvas[] = {Technique::pcf, Technique::pcss, Technique::vsm, Technique::csm};
constexpr Technique filament[] = {Technique::pcf, Technique::pcss, Technique::vsm, Technique::csm,
                                  Technique::lispsm};

constexpr TunedEngine engines[] = {
    {"unity", "Unity (URP)", unity, false, true, false, true},
    {"unreal", "Unreal", unreal, true, false, false, true},
    {"godot", "Godot", godot, false, true, true, false},
    {"godot3", "Godot 3", godot3, false, false, true, false},
    {"bevy", "Bevy", bevy, false, true, false, false},
    {"three", "three.js", three, false, true, true, false},
    {"babylon", "Babylon.js", babylon, false, true, true, false},
    {"playcanvas", "PlayCanvas", playcanvas, true, false, false, false},
    {"filament", "Filament", filament, false, true, false, false},
};

}  // namespace

bool TunedEngine::draws(const raster::MapOptions& map) const {
  const raster::Bias& bias = map.bias;
  return std::ranges::find(techniques, map.technique) != techniques.end() &&
         (slope_bias || bias.slope == 0.0) && (normal_offset || bias.normal_offset_texels == 0.0) &&
         (front_faces_culled || map.cull != raster::Cull::front) && !bias.receiver_plane && !bias.adaptive &&
         !bias.moves_casters();
}

std::span<const TunedEngine> tuned_engines() {
  return engines;
}

const TunedEngine* find_engine(std::string_view key) {
  const auto found = std::ranges::find(engines, key, &TunedEngine::key);
  return found == std::end(engines) ? nullptr : found;
}

const TunedEngine* engine_of_renderer(std::string_view name) {
  const TunedEngine* found = nullptr;
  for (const TunedEngine& engine : engines)
    if (name.starts_with(engine.name) && (found == nullptr || engine.name.size() > found->name.size()))
      found = &engine;
  return found;
}

bool any_engine_draws(const raster::MapOptions& map) {
  return std::ranges::any_of(engines, [&](const TunedEngine& engine) { return engine.draws(map); });
}

}  // namespace gnomon::compare
