// The depth map as moments that may be filtered (shaders/moments.glsl): converted face by face, blurred along
// rows and columns, and reduced to mipmaps. Private to raster.
#pragma once

#include "raster/passes/technique_pass.h"

namespace gnomon::raster {

/// Texels around each face of a cube that repeat the neighbouring faces, so that blur and the first mipmap
/// levels read across the edges; 0 for a single face, whose last texels repeat.
int moment_border(const FilterOptions& filter, LightType light);
/// The coarsest mipmap level that shading reads: of a cube, the one whose texels still fit the border.
int moment_max_level(const FilterOptions& filter, LightType light, int map_size);

class MomentPass final : public TechniquePass {
 public:
  MomentPass(Gl& gl, ProgramCache& programs) : gl_(&gl), programs_(&programs) {}
  Expected<void> prepare(const MapJob& job) override;
  Expected<void> draw(const MapJob& job) override;
  void bind_for_lookup() const override { moments_.bind(unit); }
  std::uint64_t texels() const override { return texels_; }
  std::uint64_t bytes() const override;
  /// What the last draw() left at level 0; for tests.
  const Texture2D& moments() const { return moments_; }

 private:
  static const int unit;
  void set_state(ImageSize drawn) const;
  void blur(const Program& program, int radius, ImageSize drawn);

  Gl* gl_;
  ProgramCache* programs_;
  Texture2D moments_, row_means_;
  std::vector<Framebuffer> faces_;
  Framebuffer row_target_;
  std::uint64_t texels_ = 0;
};

}  // namespace gnomon::raster
