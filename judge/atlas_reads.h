// Filters that read beyond a layer's part of an atlas: what is stored there is a neighbour's, and shadows nothing here.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"
#include "judge/captured_frame.h"

namespace gnomon::judge {

struct AtlasReads {
  std::vector<std::string> notes;  ///< how many, and what helps
  std::string cure;                ///< what helps, where most wrong pixels are such ones
};

/// Labels errors of filters that their layer's own texels would not make, and that its neighbours' in the picture make, as
/// outside the map.
AtlasReads label_atlas_reads(const FrameInput& input, const raster::RasterFrame& drawn,
                             compare::LightComparison& light);

}  // namespace gnomon::judge
