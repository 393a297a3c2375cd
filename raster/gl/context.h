// An OpenGL 4.5 core context: offscreen through OSMesa (loaded at run time) or EGL surfaceless, or one that a
// window owns.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "raster/frame.h"
#include "raster/options.h"
#include "scene/base/expected.h"

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

  /// Why not OSMesa, which Backend::automatic tries first; empty where that was not tried, or draws.
  const std::string& why_not_osmesa() const { return why_not_osmesa_; }
  void set_why_not_osmesa(std::string why) { why_not_osmesa_ = std::move(why); }

 private:
  std::string why_not_osmesa_;
};

/// Backend::automatic tries OSMesa, then EGL in software, then EGL on hardware, so that the same machine draws the
/// same whether or not it has a GPU; Backend::egl takes a GPU where there is one, and the last two only what they name.
/// Error (graphics): one line naming everything that was tried and why it failed.
Expected<std::unique_ptr<Context>> create_context(Backend backend);

// What the name of an OpenGL renderer says of it.

/// Whether a renderer of this name (GL_RENDERER) draws in software.
bool draws_in_software(std::string_view renderer);

// The offscreen backends behind create_context(). Private to raster.

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
