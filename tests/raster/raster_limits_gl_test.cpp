// What the rasterizer refuses, and in which words; nothing is shrunk or ignored in silence.
#include <cmath>

#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

class Limits : public testing::Test {
 protected:
  void SetUp() override {
    Scene scene = still_life();
    scene.lights = {sun({-0.5, -1.0, -0.6})};
    drawn_ = make_drawn(std::move(scene));
    ASSERT_NE(drawn_.renderer, nullptr);
  }
  Error error_of(const raster::RasterOptions& options, std::vector<std::uint32_t> lights = {0}) {
    const auto frame = drawn_.renderer->render(options, lights);
    return frame ? Error{ErrorKind::internal, "no error"} : frame.error();
  }
  Drawn drawn_;
};

TEST_F(Limits, MapBeyondTheContextsLimit) {
  raster::RasterOptions options = small_options(2 * drawn_.renderer->info().max_map_size);
  const Error error = error_of(options);
  EXPECT_EQ(error.kind, ErrorKind::graphics);
  EXPECT_EQ(error.message(), "map size: is too large for this OpenGL (got " +
                                 std::to_string(options.map.size) + " texels, allowed " +
                                 std::to_string(options.map.size / 2) +
                                 ": the least of GL_MAX_TEXTURE_SIZE and GL_MAX_VIEWPORT_DIMS)");
}

TEST_F(Limits, ImageBeyondTheContextsLimit) {
  raster::RasterOptions options = small_options();
  options.size = {2 * drawn_.renderer->info().max_map_size, 1};
  EXPECT_EQ(error_of(options).kind, ErrorKind::graphics);
}

TEST_F(Limits, EveryBadChoiceIsAUsageError) {
  const auto expect_usage = [&](const char* what, auto change) {
    raster::RasterOptions options = small_options();
    change(options);
    EXPECT_EQ(error_of(options).kind, ErrorKind::usage) << what;
  };
  expect_usage("map size 0", [](auto& o) { o.map.size = 0; });
  expect_usage("map size -1", [](auto& o) { o.map.size = -1; });
  expect_usage("image width 0", [](auto& o) { o.size.width = 0; });
  expect_usage("bias NaN", [](auto& o) { o.map.bias.constant = std::nan(""); });
  expect_usage("slope infinite", [](auto& o) { o.map.bias.slope = infinity; });
  expect_usage("normal offset NaN", [](auto& o) { o.map.bias.normal_offset_texels = std::nan(""); });
  expect_usage("normal offset -1", [](auto& o) { o.map.bias.normal_offset_texels = -1.0; });
  expect_usage("runs -1", [](auto& o) { o.runs = -1; });
  EXPECT_EQ(error_of(small_options(), {1}).kind, ErrorKind::usage);
}

TEST_F(Limits, RendererStillWorksAfterAnError) {
  error_of(small_options(1 << 20));
  drawn_.render(small_options());
  EXPECT_EQ(drawn_.frame.lights.size(), 1u);
}

TEST_F(Limits, SmallestImageAndMap) {
  raster::RasterOptions options = small_options(1);
  options.size = {1, 1};
  drawn_.render(options);
  EXPECT_EQ(drawn_.light().map.depth.size(), 1u);
  EXPECT_EQ(drawn_.frame.color.data.size(), 1u);
  EXPECT_TRUE(std::isfinite(drawn_.frame.color.data[0].x));
}

// Extreme but finite biases have a known outcome.
TEST_F(Limits, HugeBiasLightsEverythingAndHugeNegativeBiasNothing) {
  for (const double bias : {1e30, -1e30}) {
    raster::RasterOptions options = small_options();
    options.map.bias = {.constant = bias, .unit = raster::BiasUnit::world};
    drawn_.render(options);
    const auto& record = drawn_.light();
    for (std::size_t i = 0; i < record.gap.data.size(); ++i) {
      const bool stored = record.gap.data[i] > -infinity;
      ASSERT_EQ(record.visibility.data[i],
                stored && drawn_.frame.primitive.data[i] != no_id && bias < 0 ? 0.0f : 1.0f);
    }
  }
}

}  // namespace
}  // namespace gnomon::test
