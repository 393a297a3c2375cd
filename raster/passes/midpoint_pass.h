// The midpoint map (Woo 1992, "The Shadow Depth Map Revisited", Graphics Gems III). Each texel stores the
// depth halfway between the first surface that its ray meets and the next one behind it. That one is found by
// drawing the map again without the first layer (depth peeling, Everitt 2001). Where nothing lies behind the
// first surface, the map's far depth stands for it. Private to raster.
#pragma once

#include <map>

#include "raster/passes/technique_pass.h"

namespace gnomon::raster {

class MidpointPass final : public TechniquePass {
 public:
  MidpointPass(Gl& gl, ProgramCache& programs) : gl_(&gl), second_(gl, programs) {}
  Expected<void> prepare(const MapJob& job) override;
  Expected<void> draw(const MapJob& job) override;
  void bind_for_lookup() const override;
  void read(ShadowMap& map) const override;
  std::uint64_t texels() const override;
  std::uint64_t bytes() const override;

 private:
  Expected<const Program*> program(const LightView& view);
  Gl* gl_;
  DepthMapPass second_;
  Texture2D middle_;  ///< R32F: stored depth, as a depth map has it
  std::vector<Framebuffer> faces_;
  std::map<std::pair<bool, bool>, Program> programs_;  ///< perspective, reversed
};

}  // namespace gnomon::raster
