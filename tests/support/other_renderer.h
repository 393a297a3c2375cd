// A shadow test written with nothing but a capture's matrix and texels, as another renderer would have it.
#pragma once

#include "support/capture_support.h"

namespace gnomon::test {

/// Floor and boxes under one light: "sun", "lamp" (spot) or "bulb" (point).
Scene scene_under(const std::string& light);

/// Puts in the place of the capture's visibility what the other renderer draws on the capture's map, with the
/// capture's bias and without a filter. `outside`: what it draws beside the map.
void draw_again(const compare::Capture& capture, const Compared& drawn, float outside = 1.0f);

}  // namespace gnomon::test
