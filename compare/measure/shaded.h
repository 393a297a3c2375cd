// What the shadows' errors do to the finished pictures: textures, other lights and dim lights hide a part of them.
#pragma once

#include <optional>

#include "compare/comparison.h"

namespace gnomon::compare {

/// Compares the colours of both pictures of a comparison in one piece, with its exposure, on a screen's range [0, 1] and in sRGB.
/// None where rays draw more than the rasterizer does (reflection, refraction, glossy, indirect light), and where a picture was not
/// made.
std::optional<ShadedError> shaded_error(const Comparison& comparison);

}  // namespace gnomon::compare
