// Arrays of integers as short text for the page. The page's twin is page/src/packed.ts.
//
// A number is taken modulo 2^(8 bytes). What is predicted of it is subtracted. What is left, read as signed,
// is folded to 0, -1, 1, -2, 2, ... = 0, 1, 2, 3, 4, .... So small numbers of either sign have empty high
// bytes. Then come all lowest bytes, all second bytes and so on, compressed as one zlib stream (RFC 1950).
// Its bits, lowest first, stand 13 by 13 in pairs of 91 characters that JSON and HTML take as they are. A
// last rest of at most six stands in one character. That is a thirteenth shorter than base64.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/image.h"

namespace gnomon::report {

/// What a number is predicted from: nothing, the number before, or the last one of the same surface.
enum class From : std::uint8_t { nothing, previous, surface };

/// For each number the place of the last one before it of the same surface, or else of the one before; 0 of
/// the first.
using Sources = std::vector<std::uint32_t>;
/// `surfaces`: of each number, numbered from 0 on without large gaps; ~0: none.
Sources surface_sources(const std::vector<std::uint32_t>& surfaces);

struct PackOptions {
  int bytes = 4;  ///< of each number: 1, 2 or 4
  From from = From::nothing;
  /// What 1 stands for: all numbers are this, its opposite or 0. Other than 1 for what is predicted from nothing, only.
  std::uint32_t unit = 1;
};

/// `sources`: for From::surface.
std::string packed(std::vector<std::uint32_t> numbers, const PackOptions& options,
                   const Sources* sources = nullptr);

/// Bytes as pairs of characters.
std::string dense_text(std::string_view bytes);

// Linear light as small whole numbers for the page: logarithms, before exposure.

constexpr int colour_steps = 64;  ///< to an octave: half a percent from the middle of a step to its end
constexpr int darkest_octave = -24, brightest_octave = 24;

/// 0 of black; else 1 + colour_steps (log2 of the value - darkest_octave), rounded to within 0.52.
std::uint16_t colour_number(float value);
/// Returns the numbers of a picture's red, green and blue.
std::array<std::vector<std::uint16_t>, 3> colour_numbers(const ColorImage& image);

}  // namespace gnomon::report
