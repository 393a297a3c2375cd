// The offscreen backends behind create_context(). Private to raster.
#pragma once

#include "raster/context.h"

namespace gnomon::raster {

/// Software rendering without a display (Mesa up to 25.0).
Expected<std::unique_ptr<Context>> create_osmesa_context();

/// Which of EGL's devices may draw.
enum class EglDevices : std::uint8_t {
  hardware_first,  ///< a GPU where there is one, else Mesa's surfaceless platform, else any software device
  software,
  hardware
};

/// The context's backend() is "egl-software" or "egl-hardware".
Expected<std::unique_ptr<Context>> create_egl_context(EglDevices devices);

}  // namespace gnomon::raster
