#include "raytrace/shapes/mask_cells.h"

#include <algorithm>
#include <array>

#include "scene/base/parallel.h"

namespace gnomon::raytrace {
namespace {

// A texel's bits, of which those of several together are the common ones.
constexpr std::uint8_t opaque_bit = static_cast<std::uint8_t>(MaskKind::opaque),
                       hole_bit = static_cast<std::uint8_t>(MaskKind::hole);

/// By the texel's alpha. What floats round a mean of texels by does not matter to what is kept away from the cutoff.
std::array<std::uint8_t, 256> kinds_by_alpha(const Material& material) {
  constexpr float margin = 0x1p-16f;
  std::array<std::uint8_t, 256> kinds{};
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const float alpha = material.alpha * (static_cast<float>(i) / 255.0f), cutoff = material.alpha_cutoff;
    if (alpha >= cutoff * (1.0f + margin) || cutoff <= 0.0f) kinds[i] = opaque_bit;
    if (alpha < cutoff * (1.0f - margin)) kinds[i] = hole_bit;
  }
  return kinds;
}

}  // namespace

MaskCells::MaskCells(const Scene& scene, const Material& material) {
  const std::array<std::uint8_t, 256> kinds = kinds_by_alpha(material);
  if (material.diffuse_texture == no_id) {
    size_ = {1, 1}, kinds_ = {kinds[255]};
    return;
  }
  const Texture& texture = scene.textures[material.diffuse_texture];
  size_ = texture.size, repeat_s_ = texture.repeat_s, repeat_t_ = texture.repeat_t;
  kinds_.resize(texture.texels.size());
  parallel_for(kinds_.size(), 1 << 16, [&](std::size_t i) { kinds_[i] = kinds[texture.texels[i].a]; });
  widen_rows(), widen_columns();
}

/// Adds to a cell's texels i and i + 1 the neighbours i - 1 and i + 2.
void MaskCells::widen_rows() {
  const auto width = static_cast<std::size_t>(size_.width);
  parallel_ranges(static_cast<std::size_t>(size_.height), 16, [&](std::size_t first, std::size_t last) {
    std::vector<std::uint8_t> padded(width + 3);
    for (std::size_t row = first; row < last; ++row) {
      std::uint8_t* kinds = kinds_.data() + row * width;
      int column = -1;
      for (std::uint8_t& kind : padded) kind = kinds[wrapped(column++, size_.width, repeat_s_)];
      for (std::size_t i = 0; i < width; ++i)
        kinds[i] = padded[i] & padded[i + 1] & padded[i + 2] & padded[i + 3];
    }
  });
}

void MaskCells::widen_columns() {
  const auto width = static_cast<std::size_t>(size_.width);
  const std::vector<std::uint8_t> rows = kinds_;
  parallel_for(size_.height, 16, [&](int j) {
    const auto row = [&](int k) {
      return rows.data() + static_cast<std::size_t>(wrapped(k, size_.height, repeat_t_)) * width;
    };
    const std::uint8_t *a = row(j - 1), *b = row(j), *c = row(j + 1), *d = row(j + 2);
    std::uint8_t* kinds = kinds_.data() + static_cast<std::size_t>(j) * width;
    for (std::size_t i = 0; i < width; ++i) kinds[i] = a[i] & b[i] & c[i] & d[i];
  });
}

std::vector<MaskCells> mask_cells(const Scene& scene) {
  std::vector<MaskCells> cells;
  for (const Material& material : scene.materials)
    cells.push_back(material.alpha_mode == AlphaMode::mask ? MaskCells(scene, material) : MaskCells());
  return cells;
}

}  // namespace gnomon::raytrace
