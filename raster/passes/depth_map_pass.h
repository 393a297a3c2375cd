// Renders a light's depth map, face by face, and reads it back. Private to raster.
#pragma once

#include <vector>

#include "raster/frame.h"
#include "raster/world/world_buffers.h"

namespace gnomon::raster {

class DepthMapPass {
 public:
  DepthMapPass(Gl& gl, ProgramCache& programs) : gl_(&gl), programs_(&programs) {}

  /// Makes (or keeps) the textures. Error (graphics): out of memory.
  Expected<void> prepare(const LightView& view, DepthFormat format);
  /// Clears and draws every face; the light's block must be bound.
  /// With `first`, another map of the same shape: only what lies behind what that one holds.
  Expected<void> draw(const WorldBuffers& world, const LightView& view, Cull cull,
                      const CasterBias& bias = {}, const DepthMapPass* first = nullptr);
  /// Reads the last map drawn.
  void read(std::vector<float>& depth) const;
  void bind_for_lookup() const;
  void bind(int unit) const { depth_.bind(unit); }
  std::uint64_t bytes() const;

 private:
  struct Drawing {
    const LightView& view;
    Cull cull;
    const CasterBias& bias;
    bool peel;
  };
  Expected<void> draw_shapes(const WorldBuffers& world, const Drawing& drawing, int face);
  float format_step() const;
  void clear(const LightView& view, int face) const;
  void set_state(const LightView& view, Cull cull, ImageSize drawn) const;

  Gl* gl_;
  ProgramCache* programs_;
  Texture2D depth_;
  std::vector<Framebuffer> faces_;
};

}  // namespace gnomon::raster
