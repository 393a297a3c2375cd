// Generated textures: sizes, determinism, seamless repetition, parameter errors.
#include <gtest/gtest.h>

#include "scene/generate/generate.h"
#include "scene/generate/textures.h"

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
  double low = 1.0, high = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double t = i / 400.0;
    EXPECT_NEAR(periodic_fractal({0.0, t}, {4, 3}, 5, 9), periodic_fractal({1.0, t}, {4, 3}, 5, 9), 1e-12);
    EXPECT_NEAR(periodic_fractal({t, 0.0}, {4, 3}, 5, 9), periodic_fractal({t, 1.0}, {4, 3}, 5, 9), 1e-12);
    const double n = periodic_fractal({t, 0.37}, {4, 3}, 5, 9);
    low = std::min(low, n), high = std::max(high, n);
  }
  EXPECT_GE(low, 0.0);
  EXPECT_LE(high, 1.0);
  EXPECT_GT(high - low, 0.2);  // and it is not constant
}

}  // namespace
}  // namespace gnomon
