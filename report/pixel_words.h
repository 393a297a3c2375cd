// One pixel's story in words: what the map stores there, what the test makes of it, and which step made it wrong. The
// choice of the words stands in phrases.json, from which the report page's script tells the same story: both say only what
// holds of a pixel, and its numbers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compare/comparison.h"
#include "compare/truth/shown_materials.h"

namespace gnomon::report {

struct PixelFacts {
  compare::Label label = compare::Label::background;
  std::array<double, compare::rung_count> rungs{};  ///< V0 ... V6; 1 lit, 0 in shadow
  double gap = 0.0;         ///< world units along the light ray; minus infinity: nothing is stored
  double u = 0.0, v = 0.0;  ///< where it looks the map up, texels
  bool seen = true;         ///< a surface that both renderers see
  std::optional<compare::ShownMaterial> material{};      ///< its own, where that mirrors or transmits
  std::optional<compare::ShownMaterial> stored_glass{};  ///< what its texel holds, where that is other glass
  std::optional<std::uint8_t> decision{};  ///< of the hybrid: 0 surely in shadow, 1 surely lit, 2 traced
  compare::Ladder ladder = compare::Ladder::map;
};

/// The step that the label of an error names (docs/labels.md), by the rung it leads to, 1 to 6; 0: it is right, or
/// not compared.
int deciding_rung(const PixelFacts& pixel);

/// At the bias that was drawn.
std::string pixel_words(const compare::Comparison& comparison, const compare::LightComparison& light,
                        const PixelFacts& pixel);

/// What the pictures show there beside what is compared: mirrors and glass; empty for a plain surface in plain light.
std::vector<std::string> pixel_remarks(const PixelFacts& pixel);

}  // namespace gnomon::report
