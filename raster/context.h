// An OpenGL 4.5 core context: offscreen through OSMesa (loaded at run time) or EGL surfaceless, or one that a
// window owns.
#pragma once

#include <memory>

#include "raster/frame.h"
#include "raster/options.h"
#include "scene/expected.h"

namespace gnomon::raster {

/// The viewer derives its own from this, around its window's context.
class Context {
 public:
  using Procedure = void (*)();
  virtual ~Context() = default;
  /// Makes the context current on the calling thread.
  virtual bool make_current() = 0;
  virtual Procedure procedure(const char* name) const = 0;
  virtual const char* backend() const = 0;
};

/// Backend::automatic tries OSMesa, then EGL in software, then EGL on hardware, so that the same machine draws the
/// same whether or not it has a GPU; Backend::egl takes a GPU where there is one, and the last two only what they name.
/// Error (graphics): one line naming everything that was tried and why it failed.
Expected<std::unique_ptr<Context>> create_context(Backend backend);

}  // namespace gnomon::raster
