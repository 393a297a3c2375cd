// The irregular z-buffer (shaders/izb/izb.glsl): it lists the pixels in each texel of a grid over the light's
// view. Then it tests every triangle, sphere and solid against the pixels of the texels that it touches.
// Private to raster.
#pragma once

#include <map>
#include <tuple>

#include "raster/passes/technique_pass.h"

namespace gnomon::raster {

class IzbPass final : public TechniquePass {
 public:
  IzbPass(Gl& gl, ProgramCache& programs);
  Expected<void> prepare(const MapJob& job) override;
  Expected<void> draw(const MapJob& job) override;
  bool replaces_map() const override { return true; }
  void bind_for_lookup() const override;
  std::uint64_t texels() const override;
  std::uint64_t bytes() const override;
  /// That one drawing can keep lists of.
  static std::size_t most_pixels(const Gl& gl);

 private:
  enum class Stage : std::uint8_t { insert, triangles, spheres, quadrics, tori, implicits };
  static Stage stage_of(const Shape& shape);
  /// `function`: which one, of implicit surfaces.
  Expected<const Program*> program(Stage stage, LightType light, std::uint32_t function = 0);
  Expected<void> upload_world(const World& world);
  Expected<void> reserve_pixels(ImageSize size);
  void write_block(const MapJob& job);
  void bind_all() const;
  Expected<void> insert(const MapJob& job);
  Expected<void> block(const MapJob& job);
  Expected<void> block_shapes(const MapJob& job, int face);

  Gl* gl_;
  ProgramCache* cache_;
  std::map<std::tuple<Stage, LightType, std::uint32_t>, Program> programs_;
  const World* world_ = nullptr;
  ImageSize size_{0, 0};
  Buffer block_, vertices_, shapes_, points_, normals_, errors_, links_, shadows_;
  BufferTexture vertex_bits_, shape_bits_, point_bits_, normal_bits_, error_texels_, link_texels_;
  Texture2D heads_;
  Framebuffer no_target_;  ///< the passes write to buffers alone
};

}  // namespace gnomon::raster
