// Objects that cast no shadow, or receive none. What a file says of an instance or a shape becomes a material of its own. So
// whoever knows a primitive's material knows it.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <utility>

#include "scene/scene.h"

namespace gnomon {

struct ShadowFlags {
  bool casts = true, receives = true;
  auto operator<=>(const ShadowFlags&) const = default;
};

class ShadowVariants {
 public:
  /// The material that differs from this one in casting or receiving, made when it is first asked for.
  std::uint32_t material(const ShadowFlags& flags, Scene& scene, std::uint32_t material);
  /// The instance with such materials: where its mesh has materials for its triangles, with a copy of that.
  void apply(const ShadowFlags& flags, Scene& scene, MeshInstance& instance);

 private:
  using Key = std::pair<std::uint32_t, ShadowFlags>;
  std::map<Key, std::uint32_t> materials_, meshes_;
};

/// Says which objects cast no shadow, and which receive none.
void note_shadow_flags(Scene& scene);

}  // namespace gnomon
