// The channels of a comparison's EXR files, of a whole picture or of some of its rows.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "compare/comparison.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::compare {

/// What one light's channels are taken from; all images have one size.
struct AovRows {
  const World& world;
  const raster::RasterFrame& raster;
  const raster::LightRecord& record;
  const raytrace::RayTracedFrame& raytraced;
  const std::array<Image<float>, rung_count>& rungs;
  const Image<Label>& labels;
};
std::vector<Channel> aov_channels(const AovRows& rows);

using AovAttributes = std::array<std::pair<std::string, std::string>, 5>;
AovAttributes aov_attributes(const Comparison& comparison, const LightComparison& light);

}  // namespace gnomon::compare
