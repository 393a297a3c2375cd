// The program in use, run over every pixel of what is drawn to.
#pragma once

#include "raster/gl/gl.h"
#include "scene/image.h"

namespace gnomon::raster {

/// Draws the triangle that covers a viewport of this size at (0, 0); without a scissor test. In Interruptible work in stripes that are
/// waited for, the first of 16384 pixels and later ones twice as high for as long as they take less than 50 ms; Interrupted between two.
void fill(const Gl& gl, ImageSize size);
/// Does so in these rows alone.
void fill(const Gl& gl, ImageSize size, const PictureRows& rows);

}  // namespace gnomon::raster
