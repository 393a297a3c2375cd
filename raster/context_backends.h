// The offscreen backends behind create_context(). Private to raster.
#pragma once

#include "raster/context.h"

namespace gnomon::raster {

/// Software rendering without a display (Mesa up to 25.0).
Expected<std::unique_ptr<Context>> create_osmesa_context();

/// A hardware GPU where there is one, else Mesa's surfaceless platform, else any software device.
Expected<std::unique_ptr<Context>> create_egl_context();

}  // namespace gnomon::raster
