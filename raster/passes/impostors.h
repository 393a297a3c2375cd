// Analytic shapes on an image: each is ray-cast in the rectangle that it can cover. Private to raster.
#pragma once

#include <functional>

#include "raster/programs/programs.h"

namespace gnomon::raster {

/// Draws the world's shapes with programs of this permutation, to which the scene's own features are added. `axes` are
/// those in which a program gets the shape, as seen from the projection's origin; `set` says what else a pass sets.
Expected<void> draw_impostors(const Gl& gl, ProgramCache& programs, const World& world,
                              const Projection& projection, const LightFace& axes,
                              const ImpostorProgram::Permutation& permutation,
                              const std::function<void(const ImpostorProgram&)>& set = {});

}  // namespace gnomon::raster
