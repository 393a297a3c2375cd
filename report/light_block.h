// The blocks of one light's section of the page.
#pragma once

#include <algorithm>
#include <string>

#include "compare/result/number_text.h"
#include "report/sections.h"

namespace gnomon::compare {

/// One light with what its blocks need at hand.
struct LightBlock {
  const PageInput& in;
  std::size_t index;  ///< in Comparison::lights
  const LightComparison& light;
  std::string key(std::string_view rest) const { return light_key(index, rest); }
  /// Of the compared pixels, as text.
  std::string share(std::uint64_t pixels) const {
    const std::uint64_t compared = std::max<std::uint64_t>(light.pixels.compared, 1);
    return percent(static_cast<double>(pixels) / static_cast<double>(compared));
  }
};

/// The seven rungs and the six steps between them.
std::string ladder_block(const LightBlock& block);
/// Wrong pixels at every constant bias, as words and as a chart; empty where there is no curve.
std::string bias_block(const LightBlock& block);
/// Which kind of bias suits the light; empty where that is not known.
std::string bias_kinds_table(const LightBlock& block);
/// The bias drawn with, as engines ask for it; empty for exact techniques.
std::string engine_units_table(const LightBlock& block);
/// Edges, detachment, texel width, FLIP, mean error.
std::string facts_block(const LightBlock& block);
/// The hybrid's decisions; empty for other techniques.
std::string hybrid_block(const LightBlock& block);
std::string depth_map_block(const LightBlock& block);

}  // namespace gnomon::compare
