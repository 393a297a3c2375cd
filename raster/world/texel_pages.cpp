#include "raster/world/world_buffers.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "scene/texture_sample.h"
#include "shaders/shared_constants.h"

namespace gnomon::raster {
namespace {

std::uint32_t flags_of(const Texture& texture) {
  const auto flag = [](bool set, int bit) { return set ? static_cast<std::uint32_t>(bit) : 0u; };
  return flag(texture.srgb, shaders::texture_srgb) | flag(texture.nearest, shaders::texture_nearest) |
         flag(texture.repeat_s, shaders::texture_repeat_s) |
         flag(texture.repeat_t, shaders::texture_repeat_t);
}

std::vector<glm::uvec4> make_table(std::span<const Texture> textures) {
  std::vector<glm::uvec4> table;
  for (const float value : linear_from_srgb8()) table.emplace_back(std::bit_cast<std::uint32_t>(value));
  std::uint32_t first = 0;
  for (const Texture& t : textures) {
    table.emplace_back(first, t.size.width, t.size.height, flags_of(t));
    first += static_cast<std::uint32_t>(t.texels.size());
  }
  return table;
}

/// Lays all texels one behind the other, a page at a time.
class PageFiller {
 public:
  explicit PageFiller(std::span<const Texture> textures) : left_(textures) {}

  void fill(std::span<glm::u8vec4> page) {
    while (!page.empty() && !left_.empty()) {
      const auto rest = std::span(left_.front().texels).subspan(done_);
      const std::size_t count = std::min(rest.size(), page.size());
      std::copy_n(rest.begin(), count, page.begin());
      page = page.subspan(count), done_ += count;
      if (count == rest.size()) left_ = left_.subspan(1), done_ = 0;
    }
    std::fill(page.begin(), page.end(), glm::u8vec4(0));
  }

 private:
  std::span<const Texture> left_;
  std::size_t done_ = 0;  ///< texels of the first of them
};

}  // namespace

Expected<TexelPages> TexelPages::upload(Gl& gl, std::span<const Texture> textures) {
  constexpr std::uint64_t width = shaders::page_width;
  constexpr std::uint64_t page = width * shaders::page_height;
  std::uint64_t total = 0;
  for (const Texture& t : textures) total += t.texels.size();
  const std::uint64_t layers = std::max<std::uint64_t>(1, (total + page - 1) / page);
  const auto limit = static_cast<std::uint64_t>(gl.integer(GL_MAX_ARRAY_TEXTURE_LAYERS));
  if (layers > limit || total > 0xffffffffu) {
    return fail(ErrorKind::graphics,
                fmt::format("the textures are too large for this OpenGL (got {} texels, allowed {})", total,
                            std::min<std::uint64_t>(limit * page, 0xffffffffu)));
  }
  const std::uint64_t rows =
      layers > 1 ? shaders::page_height : std::max<std::uint64_t>(1, (total + width - 1) / width);

  TexelPages out{
      Texture2D(gl, GL_RGBA8UI, {shaders::page_width, static_cast<int>(rows)}, static_cast<int>(layers)),
      Buffer(gl), BufferTexture(gl)};
  gl->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  PageFiller filler(textures);
  std::vector<glm::u8vec4> texels(rows *
                                  width);  // of one page: all at once are half of what a large scene takes
  for (std::uint64_t layer = 0; layer < layers; ++layer) {
    filler.fill(texels);
    gl->TextureSubImage3D(out.pages.id(), 0, 0, 0, static_cast<GLint>(layer), shaders::page_width,
                          static_cast<GLsizei>(rows), 1, GL_RGBA_INTEGER, GL_UNSIGNED_BYTE, texels.data());
  }
  out.table.write(std::span<const glm::uvec4>(make_table(textures)));
  out.table_texels.attach(out.table, GL_RGBA32UI);
  if (auto ok = gl.check("uploading the textures"); !ok) return fail(ok.error());
  return out;
}

void TexelPages::bind() const {
  pages.bind(shaders::texel_pages_unit);
  table_texels.bind(shaders::textures_unit);
}

}  // namespace gnomon::raster
