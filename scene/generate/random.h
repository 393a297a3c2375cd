// Deterministic random numbers for generators: the same on every machine and compiler, unlike <random>'s
// distributions. SplitMix64: Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators",
// OOPSLA, figure 17.
#pragma once

#include <cstdint>

#include "scene/image.h"
#include "scene/math.h"

namespace gnomon {

/// Two draws never stand in one call's arguments, nor on both sides of a sum: compilers differ in which goes first.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15ull;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  /// Uniform in [0, 1): 53 bits.
  double unit() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  /// Uniform in the ball of radius 1, by rejection.
  Vec3 in_ball() {
    for (;;) {
      const Vec3 p{between(-1.0, 1.0), between(-1.0, 1.0), between(-1.0, 1.0)};
      if (glm::dot(p, p) <= 1.0) return p;
    }
  }
  /// Uniform on the unit sphere.
  Vec3 direction() {
    for (;;) {
      const Vec3 p = in_ball();
      if (glm::dot(p, p) > 0.01) return glm::normalize(p);
    }
  }

 private:
  std::uint64_t state_;
};

// Periodic noise for generated textures: it repeats over the unit square without a seam.

/// Uniform in [0, 1), a hash of a lattice point.
double lattice_noise(int x, int y, std::uint64_t seed);

/// Fractal value noise (Perlin 1985's sum of octaves, each twice as fine and `persistence` times as strong)
/// at the texel centres of the unit square. It is in [0, 1], 0.5 in the mean. The coarsest octave has `cells`
/// random values along each side, smoothly interpolated; octaves finer than the texels are left out.
Image<float> periodic_fractal(ImageSize size, const glm::ivec2& cells, int octaves, std::uint64_t seed,
                              double persistence = 0.5);

}  // namespace gnomon
