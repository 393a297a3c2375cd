// Checks of the user's choices, and what rounding they leave. Private to raster.
#pragma once

#include "raster/frame.h"
#include "scene/world.h"

namespace gnomon::raster {

/// Error: ErrorKind::usage for a value outside its range, ErrorKind::graphics for a size beyond the context's
/// limit.
Expected<void> check_options(const RasterOptions& options, const ContextInfo& context);

BiasRounding bias_rounding(const MapOptions& map, const LightView& view, const World& world,
                           const Vec3& reference);

}  // namespace gnomon::raster
