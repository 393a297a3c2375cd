// Periodic noise for generated textures: it repeats over the unit square without a seam.
#pragma once

#include <cstdint>

#include "scene/image.h"

namespace gnomon {

/// Uniform in [0, 1), a hash of a lattice point.
double lattice_noise(int x, int y, std::uint64_t seed);

/// Fractal value noise (Perlin 1985's sum of octaves, each twice as fine and `persistence` times as strong)
/// at the texel centres of the unit square: in [0, 1], 0.5 in the mean. The coarsest octave has `cells`
/// random values along each side, smoothly interpolated; octaves finer than the texels are left out.
Image<float> periodic_fractal(ImageSize size, const glm::ivec2& cells, int octaves, std::uint64_t seed,
                              double persistence = 0.5);

}  // namespace gnomon
