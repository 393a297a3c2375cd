// Every technique's frame as a minimal OpenGL program draws it: raster's own shaders, buffers and draw calls,
// and nothing else (no checks, no records, no costs counted).
#pragma once

#include <memory>

#include "raster/options.h"
#include "scene/world.h"

namespace gnomon::bench {

/// For the world's first light, a directional one; no analytic shapes.
class MinimalProgram {
 public:
  MinimalProgram(const World& world, const raster::RasterOptions& options);
  ~MinimalProgram();
  MinimalProgram(const MinimalProgram&) = delete;
  MinimalProgram& operator=(const MinimalProgram&) = delete;
  /// Draws a frame and waits for it.
  void frame();

 private:
  class Passes;
  std::unique_ptr<Passes> passes_;
};

}  // namespace gnomon::bench
