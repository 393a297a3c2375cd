// The effect plan: which effects the scene calls for, and which light or material does. Both renderers are
// specialised by it; an effect that is not called for costs nothing.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "scene/scene.h"

namespace gnomon {

enum class Effect : std::uint8_t {
  hard_shadow,
  soft_shadow,
  reflection,
  refraction,
  absorption,
  glossy,
  indirect_light,
  textures,
  alpha_mask,
  emission,
  specular,
  antialiasing,
  vertex_colors,
  unlit,
  single_sided
};
inline constexpr std::size_t effect_count = 15;

std::string_view effect_name(Effect effect);

struct EffectEntry {
  Effect effect;
  bool called_for = false;  ///< some light or material needs it
  bool simulated = false;   ///< and this program does it; called for but not simulated is said in `reason`
  std::string reason;       ///< "light 'sun' casts hard shadows"; "no material has transmission > 0"
};

struct EffectPlan {
  std::array<EffectEntry, effect_count> entries;
  const EffectEntry& operator[](Effect e) const { return entries[static_cast<std::size_t>(e)]; }
  bool simulates(Effect e) const { return (*this)[e].simulated; }
};

/// Only materials that an instance or shape uses count.
EffectPlan plan_effects(const Scene& scene);

}  // namespace gnomon
