// A comparison as a live figure shows it. It is what `gnomon compare` would do with the same words, in a picture small
// enough for a phone. It comes as the parts of a page's data (report/pixels/page_data.h).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "report/shell.h"
#include "scene/base/expected.h"

namespace gnomon::app {
class Console;
}

namespace gnomon::lab::lessons {

/// Options of `gnomon compare` without their dashes: {"map-size", "64"}.
using Settings = std::vector<std::pair<std::string, std::string>>;

struct SmallComparison {
  nlohmann::ordered_json words;         ///< what all comparisons of a page share: labels, sizes, steps
  nlohmann::ordered_json shared;        ///< exposure, rays, materials
  std::vector<report::DataPart> parts;  ///< "pixels", "geometry", "light-0"
  nlohmann::ordered_json light;         ///< of its result what the chart of every bias shows
  nlohmann::ordered_json
      drawn;  ///< {"values": of the settings, "bias_world", "texel_world"}: what panels show
  double wrong_fraction = 0.0;  ///< as drawn
  double texel_world = 0.0;     ///< width of a texel, world units: the median
};

/// The picture of its labels, as PNG, for a comparison with the scene's own settings. Errors as below.
Expected<std::string> labels_png(const std::string& scene, app::Console& console);
/// Errors: of the scene, of its settings, of the graphics.
Expected<SmallComparison> compare_small(const std::string& scene, const Settings& settings,
                                        app::Console& console);

}  // namespace gnomon::lab::lessons
