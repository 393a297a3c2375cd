// Every texture of a scene in one array texture: their texels one after the other, in pages of 4096 x 4096.
// The shaders fetch and filter by hand (shaders/texture.glsl), so textures need not share a size. Private to
// raster.
#pragma once

#include <span>

#include "raster/gl_objects.h"
#include "scene/scene.h"

namespace gnomon::raster {

struct TexelPages {
  Texture2D pages;  ///< RGBA8UI
  /// The sRGB decoding table, then {first texel, width, height, flags} per texture: a texel each.
  Buffer table;
  BufferTexture table_texels;

  /// Error (graphics): more texels than the context's array textures hold.
  static Expected<TexelPages> upload(Gl& gl, std::span<const Texture> textures);
  void bind() const;
};

}  // namespace gnomon::raster
