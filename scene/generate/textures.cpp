// Generated textures: checker, fractal noise, paving or bricks, wood. Texels are sRGB-encoded from linear
// colours. Everything is sampled at texel centres of the unit square and repeats without a seam.
#include <algorithm>

#include "scene/base/parallel.h"
#include "scene/generate/generator.h"
#include "scene/generate/random.h"

namespace gnomon {
namespace {

// IEC 61966-2-1, tabulated: 16 bits of linear input are finer than 8 bits of sRGB everywhere.
std::uint8_t encode_srgb(double v) {
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> t(65536);
    for (std::size_t i = 0; i < t.size(); ++i) {
      const double c = static_cast<double>(i) / 65535.0;
      const double e = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
      t[i] = static_cast<std::uint8_t>(std::lround(255.0 * e));
    }
    return t;
  }();
  return table[static_cast<std::size_t>(std::lround(65535.0 * std::clamp(v, 0.0, 1.0)))];
}

struct Texel {
  int x, y;
  Vec2 uv;  ///< of its centre
};

template <class Color>
Texture draw(std::string_view name, ImageSize size, const Color& color_at) {
  Texture t{std::string(name), size, {}, true, false, true, true};
  t.texels.resize(size.pixels());
  parallel_for(size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) {
      const Vec3 c = color_at(Texel{x, y, Vec2((x + 0.5) / size.width, (y + 0.5) / size.height)});
      t.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
               static_cast<std::size_t>(x)] = {encode_srgb(c.x), encode_srgb(c.y), encode_srgb(c.z),
                                               std::uint8_t{255}};
    }
  });
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
  Texture t = draw("checker", {2, 2},
                   [&](const Texel& at) { return Vec3(v.color(at.x == at.y ? "color_a" : "color_b")); });
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
  const Image<float> noise =
      periodic_fractal(square(v), cells, v.count("octaves"), v.seed(), v.number("persistence"));
  return draw("noise", square(v), [&](const Texel& at) {
    const double n = 0.5 + contrast * (noise.at(at.x, at.y) - 0.5);
    return glm::mix(a, b, std::clamp(n, 0.0, 1.0));
  });
}

const std::array<ParameterInfo, 8> noise_parameters{{
    color_parameter("color_a", {0.05, 0.12, 0.02}, "where the noise is low"),
    color_parameter("color_b", {0.12, 0.25, 0.05}, "where it is high"),
    {"cells", "", std::vector<double>{4.0, 4.0}, 1.0, 1024.0, "cells of the coarsest octave along u and v",
     true},
    count_parameter("octaves", 5, 1, 10, "each twice as fine as the one before"),
    {"persistence", "", 0.5, 0.0, 1.0, "strength of each octave as a share of the one before"},
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
  const Image<float> wobble = periodic_fractal(square(v), {8 * columns, 8 * rows}, 1, seed + 1);
  const Image<float> grain = periodic_fractal(square(v), {6 * columns, 6 * rows}, 4, seed + 2);
  return draw("paving", square(v), [&](const Texel& at) {
    const int row = std::min(static_cast<int>(at.uv.y * rows), rows - 1);
    const double shifted = at.uv.x * columns + bond * (row % 2);
    const int column = static_cast<int>(std::floor(shifted)) % columns;
    // Distances to the nearest joint's middle, in units of a flag's height; the edges are a little worn.
    const double fx = shifted - std::floor(shifted), fy = at.uv.y * rows - row;
    const double worn = 0.24 * joint * (wobble.at(at.x, at.y) - 0.5);
    const double edge = std::min(std::min(fx, 1.0 - fx) * aspect, std::min(fy, 1.0 - fy)) + worn;
    const double g = grain.at(at.x, at.y) - 0.5;
    if (edge < 0.5 * joint) return joint_color * (1.0 + 0.6 * g);
    return color * (1.0 + variation * (2.0 * lattice_noise(column, row, seed) - 1.0) + 0.5 * variation * g);
  });
}

const std::array<ParameterInfo, 10> paving_texture_parameters{{
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
  const int rings = v.count("rings"), boards = v.count("boards");
  const double strength = v.number("strength"), joint = v.number("joint");
  const std::uint64_t seed = v.seed();
  const ImageSize size = square(v);
  const Image<float> bend = periodic_fractal(size, {2 * boards, 2}, 3, seed);
  const Image<float> fibre = periodic_fractal(size, {32 * std::max(rings / 8, 1), 4}, 3, seed + 1);
  return draw("wood", size, [&](const Texel& at) {
    const int board = std::min(static_cast<int>(at.uv.x * boards), boards - 1);
    const double across = at.uv.x * boards - board;
    if (std::min(across, 1.0 - across) < 0.5 * joint) return 0.3 * dark;
    // Each board is cut elsewhere from the tree: another stretch of the same noise.
    const int cut = boards == 1 ? 0 : static_cast<int>(size.height * lattice_noise(board, 0, seed + 2));
    const int y = (at.y + cut) % size.height;
    const double ring = glm::fract(rings * at.uv.x + 2.5 * bend.at(at.x, y));
    const double late_wood = ring * ring * (1.0 - glm::smoothstep(0.9, 1.0, ring));
    const double grain = std::clamp(strength * (0.75 * late_wood + 0.55 * fibre.at(at.x, y)), 0.0, 1.0);
    const double shade = boards == 1 ? 1.0 : 0.86 + 0.28 * lattice_noise(board, 1, seed + 2);
    return shade * glm::mix(color, dark, grain);
  });
}

const std::array<ParameterInfo, 8> wood_parameters{{
    color_parameter("color", {0.42, 0.26, 0.13}, "between the grain"),
    color_parameter("grain_color", {0.20, 0.11, 0.05}, "of the grain"),
    count_parameter("rings", 6, 1, 200, "year rings across u"),
    {"strength", "", 0.8, 0.0, 1.0, "of the grain"},
    count_parameter("boards", 1, 1, 64, "boards side by side across u"),
    {"joint", "board widths", 0.0, 0.0, 0.5, "width of the joints between boards"},
    resolution_parameter(512),
    seed_parameter(),
}};

}  // namespace

std::span<const TextureGenerator> all_texture_generators() {
  static const std::array<TextureGenerator, 4> list{{
      {{"checker", "Two by two squares of two colours.", checker_parameters, {}}, make_checker},
      {{"noise", "A fractal mixture of two colours: lawn, gravel, plaster.", noise_parameters, {}},
       make_noise},
      {{"paving",
        "Rows of flags or bricks with joints, each of its own shade.",
        paving_texture_parameters,
        {}},
       make_paving_texture},
      {{"wood", "Wood with its grain along v.", wood_parameters, {}}, make_wood},
  }};
  return list;
}

}  // namespace gnomon
