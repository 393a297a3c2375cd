// Where a directional light's own map lies, without its depths, which take a look at every triangle.
#pragma once

#include <array>

#include "scene/light_view.h"

namespace gnomon {

/// Whether the texels that fit_light_view() gives a directional light lie elsewhere for the one camera than for the
/// other. False where it gives none.
bool window_moves(const World& world, const Light& light, const std::array<Camera, 2>& cameras, double aspect,
                  int size);

}  // namespace gnomon
