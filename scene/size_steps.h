// Sizes that must not change with every step of the camera go by steps, four to an octave.
#pragma once

#include <cmath>

namespace gnomon {

/// The least such size that is no smaller. `size` > 0.
inline double up_to_size_step(double size) {
  constexpr double steps_per_octave = 4.0;
  return std::exp2(std::ceil(std::log2(size) * steps_per_octave) / steps_per_octave);
}

}  // namespace gnomon
