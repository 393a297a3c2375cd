// Puts an 8-bit picture on a window: for the viewer, which owns the window and its context.
#pragma once

#include <memory>
#include <string>

#include "raster/gl/context.h"
#include "scene/base/expected.h"
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

  /// GL_RENDERER of the window's context.
  virtual std::string renderer() const = 0;

  /// Fills the whole default framebuffer.
  virtual void clear(const glm::u8vec3& colour) = 0;

  /// Draws the picture over `place` of the default framebuffer, stretched to fill it, but only what lies in
  /// `clip`, a part of the window; 8-bit values reach the screen unchanged. The place may be larger than the
  /// window.
  virtual Expected<void> draw(const Rgb8Image& picture, const Viewport& place, const Viewport& clip,
                              Scaling scaling) = 0;

  /// What has been drawn there and not yet been swapped to the screen.
  virtual Expected<Rgb8Image> read(const Viewport& viewport) = 0;
};

}  // namespace gnomon::raster
