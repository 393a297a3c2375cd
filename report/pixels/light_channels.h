// What the page's script reads of one light: its map, and of every pixel the ladder, the lookup and the
// metrics.
#pragma once

#include "report/page.h"
#include "report/pixels/channels.h"
#include "report/pixels/surface_prediction.h"

namespace gnomon::compare {

constexpr double position_steps = 256.0, visibility_steps = 25200.0;

/// `surfaces` must last until the packer has run.
nlohmann::ordered_json light_data(const PageInput& input, std::size_t index, Packer& packer,
                                  const PixelSurfaces& surfaces);

}  // namespace gnomon::compare
