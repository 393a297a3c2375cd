// Generated textures: checker, fractal noise, paving or bricks, wood. Texels are sRGB-encoded from linear
// colours. Everything is sampled at texel centres of the unit square and repeats without a seam.
#include "scene/generate/textures.h"

#include <algorithm>

#include "scene/generate/generator.h"
#include "scene/generate/random.h"

namespace gnomon {
namespace {

double lattice(int x, int y, std::uint64_t seed) {
  return Random(seed * 0x632be59bd9b4e019ull + static_cast<std::uint64_t>(x) * 0x100000001b3ull +
                static_cast<std::uint64_t>(y))
      .unit();
}

// IEC 61966-2-1.
std::uint8_t encode_srgb(double v) {
  const double c = std::clamp(v, 0.0, 1.0);
  const double e = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * e));
}

template <class Color>
Texture draw(std::string_view name, ImageSize size, const Color& color_at) {
  Texture t{std::string(name), size, {}, true, false, true, true};
  t.texels.reserve(size.pixels());
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const Vec3 c = color_at(Vec2((x + 0.5) / size.width, (y + 0.5) / size.height));
      t.texels.emplace_back(encode_srgb(c.x), encode_srgb(c.y), encode_srgb(c.z), std::uint8_t{255});
    }
  }
  return t;
}

ParameterInfo resolution_parameter(int value) {
  return count_parameter("resolution", value, 2, 4096, "texels along each side");
}

ImageSize square(const Values& v) {
  return {v.count("resolution"), v.count("resolution")};
}

// ---- checker: two by two squares

Expected<Texture> make_checker(const Values& v) {
  Texture t = draw("checker", {2, 2}, [&](const Vec2& uv) {
    return Vec3(v.color((uv.x < 0.5) == (uv.y < 0.5) ? "color_a" : "color_b"));
  });
  t.nearest = true;
  return t;
}

const std::array<ParameterInfo, 2> checker_parameters{{
    color_parameter("color_a", {0.8, 0.8, 0.8}, "of the squares at the origin's corner and across from it"),
    color_parameter("color_b", {0.1, 0.1, 0.1}, "of the other two"),
}};

// ---- noise: a fractal mixture of two colours

Expected<Texture> make_noise(const Values& v) {
  const Vec3 a{v.color("color_a")}, b{v.color("color_b")};
  const double contrast = v.number("contrast");
  const glm::ivec2 cells{static_cast<int>(v.list("cells")[0]), static_cast<int>(v.list("cells")[1])};
  return draw("noise", square(v), [&](const Vec2& uv) {
    const double n = 0.5 + contrast * (periodic_fractal(uv, cells, v.count("octaves"), v.seed()) - 0.5);
    return glm::mix(a, b, std::clamp(n, 0.0, 1.0));
  });
}

const std::array<ParameterInfo, 7> noise_parameters{{
    color_parameter("color_a", {0.05, 0.12, 0.02}, "where the noise is low"),
    color_parameter("color_b", {0.12, 0.25, 0.05}, "where it is high"),
    {"cells", "", std::vector<double>{4.0, 4.0}, 1.0, 1024.0, "cells of the coarsest octave along u and v",
     true},
    count_parameter("octaves", 5, 1, 10, "each twice as fine as the one before"),
    {"contrast", "", 1.5, 0.0, 20.0, "1 keeps the noise's own range"},
    resolution_parameter(512),
    seed_parameter(),
}};

// ---- paving: rows of flags or bricks with joints, each of its own shade

Expected<Texture> make_paving_texture(const Values& v) {
  const int columns = v.count("columns"), rows = v.count("rows");
  const double joint = v.number("joint"), bond = v.number("bond"), variation = v.number("variation");
  const Vec3 color{v.color("color")}, joint_color{v.color("joint_color")};
  const std::uint64_t seed = v.seed();
  const double aspect = v.number("aspect");
  return draw("paving", square(v), [&](const Vec2& uv) {
    const int row = std::min(static_cast<int>(uv.y * rows), rows - 1);
    const double shifted = uv.x * columns + bond * (row % 2);
    const int column = static_cast<int>(std::floor(shifted)) % columns;
    // Distances to the nearest joint's middle, in units of a flag's height.
    const double fx = shifted - std::floor(shifted), fy = uv.y * rows - row;
    const double wobble = 0.03 * (periodic_noise(uv, {8 * columns, 8 * rows}, seed + 1) - 0.5);
    const double edge =
        std::min(std::min(fx, 1.0 - fx) * aspect, std::min(fy, 1.0 - fy)) + wobble * joint * 8.0;
    const double grain = periodic_fractal(uv, {6 * columns, 6 * rows}, 4, seed + 2) - 0.5;
    if (edge < 0.5 * joint) return joint_color * (1.0 + 0.6 * grain);
    const double shade = 1.0 + variation * (2.0 * lattice(column, row, seed) - 1.0) + 0.5 * variation * grain;
    return color * shade;
  });
}

const std::array<ParameterInfo, 10> paving_parameters{{
    count_parameter("columns", 4, 1, 256, "flags along u"),
    count_parameter("rows", 4, 1, 256, "flags along v; an even number where rows are shifted"),
    {"aspect", "", 1.0, 0.05, 20.0, "a flag's width over its height"},
    {"joint", "flag heights", 0.05, 0.0, 0.5, "width of the joints"},
    {"bond", "flags", 0.5, 0.0, 1.0, "how far every other row is shifted"},
    color_parameter("color", {0.45, 0.38, 0.30}, "of the stone"),
    color_parameter("joint_color", {0.16, 0.14, 0.12}, "of the joints"),
    {"variation", "", 0.18, 0.0, 1.0, "how much the flags' shades differ"},
    resolution_parameter(1024),
    seed_parameter(),
}};

// ---- wood: grain along v

Expected<Texture> make_wood(const Values& v) {
  const Vec3 color{v.color("color")}, dark{v.color("grain_color")};
  const int rings = v.count("rings");
  const double strength = v.number("strength");
  return draw("wood", square(v), [&](const Vec2& uv) {
    const double bend = 0.35 * periodic_fractal(uv, {2, 2}, 3, v.seed());
    const double phase = 2.0 * pi * (rings * uv.x + 3.0 * bend);
    const double ring = 0.5 + 0.5 * std::sin(phase);
    const double fibre = periodic_fractal(uv, {64, 4}, 3, v.seed() + 1);
    return glm::mix(color, dark, std::clamp(strength * (0.55 * ring * ring + 0.6 * fibre), 0.0, 1.0));
  });
}

const std::array<ParameterInfo, 6> wood_parameters{{
    color_parameter("color", {0.42, 0.26, 0.13}, "between the grain"),
    color_parameter("grain_color", {0.20, 0.11, 0.05}, "of the grain"),
    count_parameter("rings", 6, 1, 200, "year rings across u"),
    {"strength", "", 0.8, 0.0, 1.0, "of the grain"},
    resolution_parameter(512),
    seed_parameter(),
}};

}  // namespace

double periodic_noise(const Vec2& uv, const glm::ivec2& cells, std::uint64_t seed) {
  const Vec2 p{uv.x * cells.x, uv.y * cells.y};
  const Vec2 floor = glm::floor(p), f = p - floor;
  const auto wrap = [](double i, int n) { return ((static_cast<int>(i) % n) + n) % n; };
  const int x0 = wrap(floor.x, cells.x), y0 = wrap(floor.y, cells.y);
  const int x1 = (x0 + 1) % cells.x, y1 = (y0 + 1) % cells.y;
  const Vec2 s = f * f * (3.0 - 2.0 * f);
  return glm::mix(glm::mix(lattice(x0, y0, seed), lattice(x1, y0, seed), s.x),
                  glm::mix(lattice(x0, y1, seed), lattice(x1, y1, seed), s.x), s.y);
}

double periodic_fractal(const Vec2& uv, const glm::ivec2& cells, int octaves, std::uint64_t seed) {
  double sum = 0.0, weight = 1.0, total = 0.0;
  for (int i = 0; i < octaves; ++i) {
    sum += weight * periodic_noise(uv, cells * (1 << i), seed + 101u * static_cast<std::uint64_t>(i));
    total += weight;
    weight *= 0.5;
  }
  return sum / total;
}

std::span<const TextureGenerator> all_texture_generators() {
  static const std::array<TextureGenerator, 4> list{{
      {{"checker", "Two by two squares of two colours.", checker_parameters, {}}, make_checker},
      {{"noise", "A fractal mixture of two colours: lawn, gravel, plaster.", noise_parameters, {}},
       make_noise},
      {{"paving", "Rows of flags or bricks with joints, each of its own shade.", paving_parameters, {}},
       make_paving_texture},
      {{"wood", "Wood with its grain along v.", wood_parameters, {}}, make_wood},
  }};
  return list;
}

}  // namespace gnomon
