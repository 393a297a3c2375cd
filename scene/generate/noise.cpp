// Value noise by octaves, each added over the whole picture at once: one table of lattice values, two weights
// per texel.

#include "scene/base/parallel.h"
#include "scene/generate/random.h"

namespace gnomon {

double lattice_noise(int x, int y, std::uint64_t seed) {
  return Random(seed * 0x632be59bd9b4e019ull + static_cast<std::uint64_t>(x) * 0x100000001b3ull +
                static_cast<std::uint64_t>(y))
      .unit();
}

namespace {

// Where a texel's centre lies among an octave's cells: the two neighbours and the smooth weight of the
// second.
struct Between {
  std::size_t first, second;
  float weight;
};

std::vector<Between> place(int texels, int cells) {
  std::vector<Between> out;
  for (int i = 0; i < texels; ++i) {
    const double p = (i + 0.5) * cells / texels, f = p - std::floor(p);
    const auto cell = static_cast<std::size_t>(p);
    out.push_back(
        {cell, (cell + 1) % static_cast<std::size_t>(cells), static_cast<float>(f * f * (3.0 - 2.0 * f))});
  }
  return out;
}

void add_octave(Image<float>& sum, const glm::ivec2& cells, float weight, std::uint64_t seed) {
  std::vector<float> values;
  for (int y = 0; y < cells.y; ++y) {
    for (int x = 0; x < cells.x; ++x)
      values.push_back(weight * static_cast<float>(lattice_noise(x, y, seed)));
  }
  const std::vector<Between> across = place(sum.size.width, cells.x), down = place(sum.size.height, cells.y);
  const auto stride = static_cast<std::size_t>(cells.x);
  parallel_for(down.size(), [&](std::size_t y) {
    const float *above = &values[down[y].first * stride], *below = &values[down[y].second * stride];
    float* row = &sum.data[y * across.size()];
    for (std::size_t x = 0; x < across.size(); ++x) {
      const auto [a, b, s] = across[x];
      const float top = above[a] + s * (above[b] - above[a]), bottom = below[a] + s * (below[b] - below[a]);
      row[x] += top + down[y].weight * (bottom - top);
    }
  });
}

}  // namespace

Image<float> periodic_fractal(ImageSize size, const glm::ivec2& cells, int octaves, std::uint64_t seed,
                              double persistence) {
  int used = 1;
  while (used < octaves && cells.x << used <= size.width && cells.y << used <= size.height) ++used;
  double total = 0.0;
  for (int i = 0; i < used; ++i) total += std::pow(persistence, i);
  Image<float> sum(size);
  for (int i = 0; i < used; ++i) {
    const auto weight = static_cast<float>(std::pow(persistence, i) / total);
    add_octave(sum, cells * (1 << i), weight, seed + 101u * static_cast<std::uint64_t>(i));
  }
  return sum;
}

}  // namespace gnomon
