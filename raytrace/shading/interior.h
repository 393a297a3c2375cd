// What a ray runs in where bodies of glass touch, nest or overlap. A list holds those that it has entered and
// not left. Priorities say which of them is there (Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray
// Traced Images", JGT 7(2)). A surface where the medium does not change is no boundary: the ray passes it as
// if it were not there. Of equal priorities the one entered last is there, so that plain nesting needs none.
#pragma once

#include <array>

#include "scene/scene.h"

namespace gnomon::raytrace {

/// Materials entered and not left, in the order of entry. Plain data, copied along the path.
class Interior {
 public:
  static constexpr std::size_t capacity =
      8;  ///< bodies at one place; of more, the first entered is forgotten

  bool empty() const { return count_ == 0; }
  /// The material of the medium; no_id: vacuum.
  std::uint32_t medium(const Scene& scene) const {
    std::uint32_t best = no_id;
    for (std::size_t i = 0; i < count_; ++i)
      if (best == no_id || scene.materials[entered_[i]].priority >= scene.materials[best].priority)
        best = entered_[i];
    return best;
  }
  void enter(std::uint32_t material) {
    if (count_ == capacity) erase(0);
    entered_[count_++] = material;
  }
  /// The body of this material entered last; false when there is none.
  bool leave(std::uint32_t material) {
    for (std::size_t i = count_; i-- > 0;)
      if (entered_[i] == material) return erase(i), true;
    return false;
  }

 private:
  void erase(std::size_t at) {
    for (std::size_t i = at + 1; i < count_; ++i) entered_[i - 1] = entered_[i];
    --count_;
  }
  std::array<std::uint32_t, capacity> entered_{};
  std::size_t count_ = 0;
};

inline double index_of(const Scene& scene, std::uint32_t medium) {
  return medium == no_id ? 1.0 : static_cast<double>(scene.materials[medium].ior);
}

/// What a surface of glass is to a ray that intersects it.
struct Crossing {
  std::uint32_t before = no_id, behind = no_id;  ///< media: materials, or no_id for vacuum
  Interior inside;                               ///< behind the surface
  bool is_boundary() const { return before != behind; }
};

/// `material` is the surface's. A body that is left without having been entered (an open mesh) was around the
/// ray all the time.
inline Crossing cross(const Scene& scene, Interior inside, std::uint32_t material, bool entering) {
  Crossing crossing;
  if (entering) {
    crossing.before = inside.medium(scene);
    inside.enter(material);
  } else {
    Interior around = inside;
    if (!inside.leave(material)) around.enter(material);
    crossing.before = around.medium(scene);
  }
  crossing.behind = inside.medium(scene);
  crossing.inside = inside;
  return crossing;
}

}  // namespace gnomon::raytrace
