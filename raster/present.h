// Puts an 8-bit picture on a window: for the viewer, which owns the window and its context.
#pragma once

#include <memory>

#include "raster/context.h"
#include "scene/expected.h"
#include "scene/image.h"

namespace gnomon::raster {

enum class Scaling : std::uint8_t { nearest, linear };

/// A part of the window in framebuffer pixels; (x, y) is its lower left corner.
struct Viewport {
  int x = 0, y = 0, width = 0, height = 0;
};

class Presenter {
 public:
  /// The context must outlive the presenter and be current whenever it is used or destroyed.
  static Expected<std::unique_ptr<Presenter>> create(Context& context);
  virtual ~Presenter() = default;

  /// Draws the picture over the viewport of the default framebuffer, stretched to fill it; 8-bit values reach
  /// the screen unchanged.
  virtual Expected<void> draw(const Rgb8Image& picture, const Viewport& viewport, Scaling scaling) = 0;

  /// What has been drawn there and not yet been swapped to the screen.
  virtual Expected<Rgb8Image> read(const Viewport& viewport) = 0;
};

}  // namespace gnomon::raster
