// Checks of the user's choices, and the conversion of a bias to world units. Private to raster.
#pragma once

#include "raster/frame.h"
#include "scene/world.h"

namespace gnomon::raster {

/// Error: ErrorKind::usage for a value outside its range, ErrorKind::graphics for a size beyond the context's
/// limit.
Expected<void> check_options(const RasterOptions& options, const ContextInfo& context);

BiasRounding bias_rounding(const MapOptions& map, const LightView& view, const World& world,
                           const Vec3& reference);

/// The constant bias in world units (texel_world() says how wide a texel is).
double constant_bias_world(const Bias& bias, const LightView& view, const World& world);

}  // namespace gnomon::raster
