// A sun that stands elsewhere than the capture says: the direction under which exact shadows are the picture's, found by
// rays alone. Renderers clamp a low sun, keep yesterday's direction for a frame, or take one angle for another.
#pragma once

#include <optional>

#include "compare/comparison.h"

namespace gnomon::judge {

struct TurnedSun {
  Vec3 direction;              ///< unit, the way the light travels
  double angle_degrees = 0.0;  ///< between it and the one that was said
  double explained = 0.0;      ///< share of the picture's error that is gone under it, in [0, 1]
};

/// Searches all directions: a grid of five degrees first, then ever smaller steps from the best of it. None for a light that is
/// not a sun, or where nothing compared is off. `judged`: a comparison of the whole picture.
std::optional<TurnedSun> find_turned_sun(const compare::Comparison& judged, const raytrace::Tracer& tracer);

}  // namespace gnomon::judge
