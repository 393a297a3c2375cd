// A texture with what its file says of alpha (image_io.cpp).
#pragma once

#include <string>

#include "scene/expected.h"
#include "scene/scene.h"

namespace gnomon {

struct TextureFile {
  Texture texture;
  bool has_alpha = false;  ///< the file has an alpha channel; without one the texture is opaque
};

/// As read_texture().
Expected<TextureFile> read_texture_file(const std::string& path, bool srgb);

}  // namespace gnomon
