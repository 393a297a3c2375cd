// Texture lookup: the documented formula, point by point.
#include <gtest/gtest.h>

#include "scene/files/pictures/image_io.h"
#include "scene/texture_sample.h"

namespace gnomon {
namespace {

// Linear, 4 x 2: red is the column, green the row.
Texture ramp() {
  Texture t;
  t.size = {4, 2};
  t.srgb = false;
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 4; ++column)
      t.texels.emplace_back(static_cast<std::uint8_t>(51 * column), static_cast<std::uint8_t>(255 * row), 0,
                            255);
  return t;
}

constexpr float one_rounding = 1e-6f;  // one rounding of a value up to 1 to float

TEST(Texture, TexelCentresGiveTexels) {
  const Texture t = ramp();
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 4; ++column) {
      const Vec4f c = sample_texture(t, {(column + 0.5) / 4.0, (row + 0.5) / 2.0});
      EXPECT_NEAR(c.r, 0.2f * static_cast<float>(column), one_rounding);
      EXPECT_NEAR(c.g, static_cast<float>(row), one_rounding);
    }
}

TEST(Texture, BilinearBetweenCentres) {
  const Texture t = ramp();
  EXPECT_NEAR(sample_texture(t, {(1.0 + 0.75) / 4.0, 0.25}).r, 0.2f * 1.25f, one_rounding);
  EXPECT_NEAR(sample_texture(t, {0.375, 0.5}).g, 0.5f, one_rounding);
}

TEST(Texture, RepeatWrapsAndClampHolds) {
  Texture t = ramp();
  EXPECT_NEAR(sample_texture(t, {0.0, 0.25}).r, 0.3f, one_rounding);  // halfway between columns 3 and 0
  EXPECT_NEAR(sample_texture(t, {-7.625, 0.25}).r, 0.2f, one_rounding);
  EXPECT_NEAR(sample_texture(t, {1e9 + 0.375, 0.25}).r, 0.2f, one_rounding);
  t.repeat_s = false;
  EXPECT_NEAR(sample_texture(t, {0.0, 0.25}).r, 0.0f, one_rounding);
  EXPECT_NEAR(sample_texture(t, {5.0, 0.25}).r, 0.6f, one_rounding);
  EXPECT_NEAR(sample_texture(t, {-5.0, 0.25}).r, 0.0f, one_rounding);
}

TEST(Texture, NearestHasSharpEdges) {
  Texture t = ramp();
  t.nearest = true;
  EXPECT_NEAR(sample_texture(t, {0.2499, 0.1}).r, 0.0f, one_rounding);
  EXPECT_NEAR(sample_texture(t, {0.25, 0.1}).r, 0.2f, one_rounding);
  t.repeat_s = t.repeat_t = false;
  EXPECT_NEAR(sample_texture(t, {1.0, 1.0}).r, 0.6f, one_rounding);
}

// Decoding must come before the weights: the mean of black and white is 0.5 linear, not 0.5 encoded (0.214).
TEST(Texture, SrgbIsDecodedBeforeFiltering) {
  Texture t;
  t.size = {2, 1};
  t.texels = {{0, 0, 0, 0}, {255, 255, 255, 255}};
  const Vec4f middle = sample_texture(t, {0.5, 0.5});
  EXPECT_NEAR(middle.r, 0.5f, one_rounding);
  EXPECT_NEAR(middle.a, 0.5f, one_rounding);
  t.texels = {{188, 188, 188, 128}, {188, 188, 188, 128}};
  const Vec4f grey = sample_texture(t, {0.5, 0.5});
  EXPECT_NEAR(grey.r, linear_from_srgb(188.0f / 255.0f), 1e-5f);  // float's pow against double's
  EXPECT_NEAR(grey.a, 128.0f / 255.0f, one_rounding);             // alpha is never decoded
}

TEST(Texture, NonFiniteCoordinatesAreDefined) {
  const Texture t = ramp();
  const Vec4f zero = sample_texture(t, {0.0, 0.0});
  EXPECT_EQ(sample_texture(t, {std::nan(""), infinity}), zero);
}

// KHR_texture_transform: scale, then a rotation that looks counter-clockwise with v down, then offset.
TEST(Texture, TransformOrderAndSense) {
  const TextureTransform t{{10.0, 20.0}, {2.0, 3.0}, 0.5 * pi};
  const Vec2 moved = transform_uv(t, {1.0, 0.0});
  EXPECT_NEAR(moved.x, 10.0, 1e-12);
  EXPECT_NEAR(moved.y, 18.0, 1e-12);
  const Vec2 other = transform_uv(t, {0.0, 1.0});
  EXPECT_NEAR(other.x, 13.0, 1e-12);
  EXPECT_NEAR(other.y, 20.0, 1e-12);
}

}  // namespace
}  // namespace gnomon
