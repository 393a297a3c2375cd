// What the textures of one scene may take, told by the headers of their files before anything is decoded.
#pragma once

#include <mutex>
#include <string>

#include "scene/files/pictures/image_library.h"

namespace gnomon {

/// Any thread may ask. A texture counts as it is decoded, four bytes a texel and more where the file holds more.
class TextureMemory {
 public:
  /// At most so many bytes. `limit_text` says so in messages ("500M by --memory").
  TextureMemory(double limit_bytes, std::string limit_text)
      : limit_(limit_bytes), limit_text_(std::move(limit_text)) {}

  /// For a texture that the scene keeps. The error (graphics) names the file: with those before it there are too many bytes.
  static HeaderCheck kept(TextureMemory* memory, const std::string& file);
  /// For one that is looked at and let go. The error (graphics) names the file: by itself it has too many bytes.
  static HeaderCheck passing(TextureMemory* memory, const std::string& file);
  /// The same, with nothing counted yet.
  TextureMemory anew() const { return {limit_, limit_text_}; }

 private:
  Expected<void> take(const std::string& file, const ImageSize& size, std::size_t bytes_per_pixel,
                      bool keeps);
  double limit_;
  std::string limit_text_;
  std::mutex mutex_;
  double taken_ = 0.0;
};

}  // namespace gnomon
