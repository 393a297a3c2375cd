// Generated textures: sizes, determinism, seamless repetition, parameter errors.
#include <gtest/gtest.h>

#include "scene/generate/generate.h"
#include "scene/generate/random.h"

namespace gnomon {
namespace {

TEST(TextureGenerators, MakeWhatTheyAnnounce) {
  ASSERT_EQ(texture_generators().size(), 4u);
  for (const GeneratorInfo& info : texture_generators()) {
    const Expected<Texture> a = generate_texture(info.kind, {}), b = generate_texture(info.kind, {});
    ASSERT_TRUE(a && b) << info.kind;
    EXPECT_EQ(a->texels.size(), a->size.pixels());
    EXPECT_EQ(a->texels, b->texels);
    EXPECT_TRUE(a->srgb);
    for (const auto& t : a->texels) ASSERT_EQ(t.a, 255);
  }
}

TEST(TextureGenerators, CheckerIsTwoByTwoInSrgb) {
  const Texture t = *generate_texture(
      "checker", {{"color_a", std::vector{1.0, 0.0, 0.2140}}, {"color_b", std::vector{0.0, 0.0, 0.0}}});
  ASSERT_EQ(t.size, (ImageSize{2, 2}));
  EXPECT_TRUE(t.nearest);
  EXPECT_EQ(t.texels[0],
            glm::u8vec4(255, 0, 127, 255));  // 0.2140 linear is 0.5 in sRGB: 127.5 less a rounding
  EXPECT_EQ(t.texels[0], t.texels[3]);
  EXPECT_EQ(t.texels[1], glm::u8vec4(0, 0, 0, 255));
}

TEST(TextureGenerators, ResolutionIsAsAsked) {
  EXPECT_EQ(generate_texture("wood", {{"resolution", 64.0}})->size, (ImageSize{64, 64}));
}

TEST(TextureGenerators, WrongParametersAreNamed) {
  EXPECT_EQ(generate_texture("chekcer", {}).error().field, "kind");
  EXPECT_EQ(generate_texture("noise", {{"color_a", std::vector{0.1, 0.2}}}).error().field, "color_a");
  EXPECT_EQ(generate_texture("noise", {{"color_a", std::vector{0.1, 0.2, 1.5}}}).error().field, "color_a");
  EXPECT_EQ(generate_texture("noise", {{"resolution", 1e6}}).error().field, "resolution");
}

TEST(PeriodicNoise, RepeatsWithoutASeamAndStaysInRange) {
  const Image<float> n = periodic_fractal({256, 192}, {4, 3}, 3, 9);
  const auto step = [&](int x0, int y0, int x1, int y1) { return std::abs(n.at(x0, y0) - n.at(x1, y1)); };
  float inner_x = 0, inner_y = 0, seam_x = 0, seam_y = 0;
  for (int y = 0; y < 192; ++y) {
    for (int x = 1; x < 256; ++x) inner_x = std::max(inner_x, step(x - 1, y, x, y));
    seam_x = std::max(seam_x, step(255, y, 0, y));
  }
  for (int x = 0; x < 256; ++x) {
    for (int y = 1; y < 192; ++y) inner_y = std::max(inner_y, step(x, y - 1, x, y));
    seam_y = std::max(seam_y, step(x, 191, x, 0));
  }
  // A step over the border is no larger than the steps inside.
  EXPECT_LE(seam_x, inner_x);
  EXPECT_LE(seam_y, inner_y);
  const auto [low, high] = std::minmax_element(n.data.begin(), n.data.end());
  EXPECT_GE(*low, 0.0f);
  EXPECT_LE(*high, 1.0f);
  EXPECT_GT(*high - *low, 0.3f);  // and it is not constant
}

TEST(PeriodicNoise, LeavesOutOctavesFinerThanTheTexels) {
  // 64 texels hold octaves of 16, 32 and 64 cells; a fourth would have 128.
  EXPECT_EQ(periodic_fractal({64, 64}, {16, 16}, 3, 1).data,
            periodic_fractal({64, 64}, {16, 16}, 10, 1).data);
  EXPECT_NE(periodic_fractal({64, 64}, {16, 16}, 2, 1).data, periodic_fractal({64, 64}, {16, 16}, 3, 1).data);
}

}  // namespace
}  // namespace gnomon
