// Where a directional light's own map lies, without its depths, which take a look at every triangle.
#pragma once

#include <array>

#include "scene/light_view.h"

namespace gnomon {

/// Whether the texels that fit_light_view() gives a directional light lie elsewhere for the one camera than for the
/// other. False where it gives none.
bool window_moves(const World& world, const Light& light, const std::array<Camera, 2>& cameras, double aspect,
                  int size, const LightWindow& window = {});

/// How the triangles and finite shapes of a world lie to an orthographic map of one face. A caster whose shadow can fall
/// into the window lies inside it across the light; one before the near plane is drawn at that plane, one beyond the far
/// plane is not drawn.
struct WindowCasters {
  std::uint64_t inside = 0;  ///< wholly inside the window, and between its depths
  std::uint64_t cut = 0;     ///< partly inside the window, or across a depth
  std::uint64_t beside = 0;  ///< wholly beside the window
  std::uint64_t before = 0;  ///< inside, wholly before the near plane
  std::uint64_t beyond = 0;  ///< inside, wholly beyond the far plane
  std::uint64_t count() const { return inside + cut + beside + before + beyond; }
};
WindowCasters window_casters(const World& world, const LightView& view);

}  // namespace gnomon
