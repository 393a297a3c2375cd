// Linear light as small whole numbers for the page: logarithms, before exposure.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/image.h"

namespace gnomon::compare {

constexpr int colour_steps = 64;  ///< to an octave: half a percent from the middle of a step to its end
constexpr int darkest_octave = -24, brightest_octave = 24;

/// 0 of black; else 1 + colour_steps (log2 of the value - darkest_octave), rounded to within 0.52.
std::uint16_t colour_number(float value);
/// Of a picture's red, green and blue.
std::array<std::vector<std::uint16_t>, 3> colour_numbers(const ColorImage& image);

}  // namespace gnomon::compare
