// Periodic noise for generated textures: everything here repeats over the unit square without a seam.
#pragma once

#include <cstdint>

#include "scene/math.h"

namespace gnomon {

/// Value noise in [0, 1] at uv (period 1), with `cells` random values along each side, smoothly interpolated.
double periodic_noise(const Vec2& uv, const glm::ivec2& cells, std::uint64_t seed);

/// `octaves` of it, each twice as fine and half as strong; in [0, 1], 0.5 in the mean.
double periodic_fractal(const Vec2& uv, const glm::ivec2& cells, int octaves, std::uint64_t seed);

}  // namespace gnomon
