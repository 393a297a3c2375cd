#include "scene/files/pictures/texture_memory.h"

#include <fmt/core.h>

#include <algorithm>

#include "scene/scene.h"

namespace gnomon {

Expected<void> TextureMemory::take(const std::string& file, const ImageSize& size,
                                   std::size_t bytes_per_pixel, bool keeps) {
  const double bytes =
      static_cast<double>(size.pixels()) *
      static_cast<double>(std::max(bytes_per_pixel, sizeof(decltype(Texture::texels)::value_type)));
  const std::lock_guard lock(mutex_);
  if ((keeps ? taken_ : 0.0) + bytes <= limit_) {
    if (keeps) taken_ += bytes;
    return {};
  }
  Error error{
      ErrorKind::graphics,
      fmt::format("the scene's textures take too much memory (got {}x{} pixels here, {:.0f} MB; allowed {} "
                  "for all of them)",
                  size.width, size.height, bytes / 1e6, limit_text_)};
  error.file = file;
  return fail(std::move(error));
}

HeaderCheck TextureMemory::kept(TextureMemory* memory, const std::string& file) {
  if (memory == nullptr) return {};
  return [=](const ImageSize& size, std::size_t bytes) { return memory->take(file, size, bytes, true); };
}

HeaderCheck TextureMemory::passing(TextureMemory* memory, const std::string& file) {
  if (memory == nullptr) return {};
  return [=](const ImageSize& size, std::size_t bytes) { return memory->take(file, size, bytes, false); };
}

}  // namespace gnomon
