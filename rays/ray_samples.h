// Which points of the light a pixel's few rays are sent to. What a point is depends on the seed, the frame, the pixel and the
// ray's number alone. So pictures are the same on every machine and for any number of threads.
#pragma once

#include <array>
#include <cstdint>

#include "raster/options.h"
#include "scene/math.h"

namespace gnomon::rays {

/// One pixel's rays of one frame.
struct PixelRays {
  std::uint32_t x = 0, y = 0;  ///< in the camera's picture
  std::uint32_t frame = 0;     ///< 0: the first that the history holds
  std::uint32_t count = 1;     ///< of the rays; 1 to 16
  std::uint64_t key = 0;       ///< of the seed, the light and the pixel
};

/// The points of the unit square [0, 1)^2 for one pixel's rays.
/// - random: each alone, uniformly.
/// - stratified: raytrace::StratifiedSquare, each frame's by themselves.
/// - blue_noise: the points of the R2 sequence, frame after frame (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom
///   Sequences"). They are moved by what the pixel has in a mask of blue noise (blue_noise_mask), another amount along each axis.
///   Their wrapping round keeps each uniform.
class RaySquare {
 public:
  RaySquare(raster::RaySampler sampler, const PixelRays& pixel);
  Vec2 operator[](std::uint32_t i) const;

 private:
  raster::RaySampler sampler_;
  PixelRays pixel_;
  std::uint64_t frame_key_;
  Vec2 shift_{0.0};
};

inline constexpr std::uint32_t mask_side = 32;
/// Each of 0 ... mask_side² - 1 once, row by row. Any threshold leaves a pattern without low frequencies, across the edges, too
/// (Ulichney 1993, "The void-and-cluster method for dither array generation", with a Gaussian of 1.5 pixels). It is the same on
/// every machine, for energies are integers.
const std::array<std::uint16_t, mask_side * mask_side>& blue_noise_mask();

}  // namespace gnomon::rays
