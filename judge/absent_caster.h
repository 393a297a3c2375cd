// The guard of captures whose casters were found from a frame. A sky, a lamp or a helper may shadow everything by rays, and be
// in no map: that is no finding about the renderer.
#pragma once

#include <optional>
#include <string>

#include "compare/comparison.h"
#include "judge/captured_frame.h"

namespace gnomon::judge {

struct AbsentCaster {
  std::string object;
  double share = 0.0;  ///< of the pixels within the map that rays find in shadow
};

/// Returns the object that the light meets first for most of the pixels that rays find in shadow, if the map holds nothing
/// of it. `drawn`'s only record has a map.
std::optional<AbsentCaster> find_absent_caster(const FrameInput& input, const raster::RasterFrame& drawn,
                                               const compare::LightComparison& light);

/// One sentence that names the object and says what to do.
std::string absent_caster_words(const AbsentCaster& absent);

}  // namespace gnomon::judge
