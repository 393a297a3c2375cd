// What a captured map holds against what the light meets first in the scene. A wrong pixel that the ladder calls precision
// is one of precision only where the map's format and arithmetic can explain the stored depth; otherwise the map's casters
// are not the scene's, and the pixel gets the label that says how (docs/labels.md).
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"
#include "judge/captured_frame.h"

namespace gnomon::judge {

/// What is found of the map's casters, by label: the one with the most pixels first.
struct ContentFinding {
  compare::Label label = compare::Label::right;
  std::size_t pixels = 0;  ///< whose error has this label
  std::size_t wrong = 0;   ///< of them those that are off by more than one half
  std::string object;      ///< the caster with most of them; empty where that is none of the scene's
  std::optional<double>
      nearest;  ///< of clipped casters: the depth along the map's axis from which on they lie
  std::optional<double> farthest;
  double bias_world = 0.0;  ///< of a bias of casters: how far it moves them from the light, median
};

struct MapContent {
  std::vector<ContentFinding> found;
  /// Most of the wrong pixels inside the map are due to casters that no bias mends.
  bool is_main_cause(const compare::LightComparison& light) const;
};

/// The texel that the biased test looks up for a pixel; none outside the map.
std::optional<TexelKey> lookup_of(const FrameInput& input, const raster::RasterFrame& drawn,
                                  std::size_t pixel);

/// Gives labels of casters to pixels of `light`, that of `drawn`'s only record, whose map is another renderer's. Where the
/// test is not the one described, they are unexplained instead: the map may be looked up elsewhere.
MapContent label_map_content(const FrameInput& input, const raster::RasterFrame& drawn,
                             compare::LightComparison& light, bool is_as_described);

/// One sentence for each kind that has some pixels.
std::vector<std::string> map_content_notes(const MapContent& content, const raster::LightRecord& record);

}  // namespace gnomon::judge
