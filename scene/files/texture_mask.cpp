#include "scene/files/texture_mask.h"

#include <algorithm>
#include <cmath>

#include "scene/files/image_io.h"
#include "scene/texture_sample.h"

namespace gnomon {
namespace {

Texture resized(Texture from, const ImageSize& size) {
  if (from.size == size) return from;
  std::vector<glm::u8vec4> texels;
  texels.reserve(size.pixels());
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const Vec4f value = sample_texture(from, {(x + 0.5) / size.width, (y + 0.5) / size.height});
      const auto stored = [&](float v) { return to_8_bit(from.srgb ? srgb_from_linear(v) : v); };
      texels.emplace_back(stored(value.r), stored(value.g), stored(value.b), to_8_bit(value.a));
    }
  from.size = size;
  from.texels = std::move(texels);
  return from;
}

}  // namespace

void take_alpha_from_luminance(Texture& mask) {
  for (glm::u8vec4& t : mask.texels)
    t.a = static_cast<std::uint8_t>(std::lround(0.2126 * t.r + 0.7152 * t.g + 0.0722 * t.b));
}

Texture with_alpha_of(Texture colours, Texture mask) {
  const ImageSize size{std::max(colours.size.width, mask.size.width),
                       std::max(colours.size.height, mask.size.height)};
  mask.repeat_s = colours.repeat_s;
  mask.repeat_t = colours.repeat_t;
  colours = resized(std::move(colours), size);
  mask = resized(std::move(mask), size);
  for (std::size_t i = 0; i < colours.texels.size(); ++i) colours.texels[i].a = mask.texels[i].a;
  return colours;
}

}  // namespace gnomon
