// The presenter draws a picture the right way up, unchanged, and scaled as asked.
#include "raster/gl/gl.h"
#include "raster/gl/present.h"
#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

// OSMesa's own window (16 x 16) stands for the viewer's.
class Present : public testing::Test {
 protected:
  void SetUp() override {
    auto context = raster::create_context(raster::Backend::osmesa);
    if (!context) GTEST_SKIP() << context.error().message();
    context_ = std::move(*context);
    auto presenter = raster::Presenter::create(*context_);
    ASSERT_TRUE(presenter.has_value()) << presenter.error().message();
    presenter_ = std::move(*presenter);
    picture_ = Rgb8Image({2, 2});
    picture_.at(0, 0) = {255, 0, 0}, picture_.at(1, 0) = {0, 200, 0};
    picture_.at(0, 1) = {0, 0, 130}, picture_.at(1, 1) = {17, 33, 99};
  }
  /// A pixel of the window, (0, 0) at the lower left.
  glm::u8vec3 pixel(int x, int y) {
    const auto gl = raster::Gl::load(*context_);
    glm::u8vec4 value{};
    (**gl)->ReadPixels(x, y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, &value);
    return glm::u8vec3(value);
  }
  std::unique_ptr<raster::Context> context_;
  std::unique_ptr<raster::Presenter> presenter_;
  Rgb8Image picture_;
};

TEST_F(Present, NearestPutsRowZeroAtTheTop) {
  ASSERT_TRUE(
      presenter_->draw(picture_, {0, 0, 16, 16}, {0, 0, 16, 16}, raster::Scaling::nearest).has_value());
  EXPECT_EQ(pixel(0, 15), picture_.at(0, 0));
  EXPECT_EQ(pixel(7, 8), picture_.at(0, 0));
  EXPECT_EQ(pixel(8, 8), picture_.at(1, 0));
  EXPECT_EQ(pixel(0, 0), picture_.at(0, 1));
  EXPECT_EQ(pixel(15, 7), picture_.at(1, 1));
}

TEST_F(Present, LinearBlendsBetweenPixels) {
  ASSERT_TRUE(
      presenter_->draw(picture_, {0, 0, 16, 16}, {0, 0, 16, 16}, raster::Scaling::linear).has_value());
  const glm::u8vec3 middle = pixel(7, 14);
  EXPECT_GT(middle.x, 100);
  EXPECT_LT(middle.x, 160);
  EXPECT_GT(middle.y, 60);
}

TEST_F(Present, KeepsToItsViewport) {
  ASSERT_TRUE(
      presenter_->draw(picture_, {0, 0, 16, 16}, {0, 0, 16, 16}, raster::Scaling::nearest).has_value());
  Rgb8Image white({1, 1}, glm::u8vec3(255));
  ASSERT_TRUE(presenter_->draw(white, {4, 4, 2, 2}, {0, 0, 16, 16}, raster::Scaling::nearest).has_value());
  EXPECT_EQ(pixel(4, 4), glm::u8vec3(255));
  EXPECT_EQ(pixel(3, 4), picture_.at(0, 1));
  EXPECT_EQ(pixel(6, 4), picture_.at(0, 1));
}

}  // namespace
}  // namespace gnomon::test
