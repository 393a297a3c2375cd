// --technique hybrid through the rasterizer and the comparison: no pixel is wrong and no step of the budget
// is left, for hard lights and soft ones; what is kept is kept.
#include <gtest/gtest.h>

#include "hybrid/visibility.h"
#include "scene/load.h"
#include "tests/support/one_world.h"

namespace gnomon::test {
namespace {

compare::CompareOptions hybrid_options(int map_size) {
  compare::CompareOptions options;
  options.raster.size = options.raytrace.size = {256, 144};
  options.raster.map.technique = raster::Technique::hybrid;
  options.raster.map.size = map_size;
  options.raster.runs = 0;
  options.raytrace.seed = 9;
  options.perceptual = false;
  return options;
}

std::unique_ptr<OneWorld> open(const std::string& name) {
  auto scene = load_scene(name);
  if (!scene) return nullptr;
  auto world = std::make_unique<OneWorld>(std::move(*scene));
  world->renderer->use_external_visibility(raster::Technique::hybrid, hybrid::make_visibility(world->world));
  return world;
}

TEST(HybridTechnique, IsNowhereWrong) {
  for (const char* name : {"whitted", "thin-wall", "sphere-plane", "fence", "penumbra"}) {
    const auto world = open(name);
    ASSERT_NE(world, nullptr);
    for (const int size : {64, 512}) {
      const compare::Comparison result = world->compare(hybrid_options(size));
      for (const compare::LightComparison& light : result.lights) {
        EXPECT_GT(light.pixels.compared, 0u);
        EXPECT_EQ(light.error.wrong, 0u) << name;
        EXPECT_EQ(light.error.mean_absolute, 0.0) << name;  // the same samples, the same share
        for (const compare::BudgetStep& step : light.budget) EXPECT_EQ(step.absolute_mean, 0.0) << name;
        const auto& external = result.raster.lights[light.record].external;
        ASSERT_TRUE(external.has_value());
        EXPECT_LT(external->rays, external->all_rays) << name;
        EXPECT_GT(external->all_triangle_tests, external->triangle_tests);
        EXPECT_GT(external->bytes, 0u);
      }
    }
  }
}

TEST(HybridTechnique, KeepsItsSheetsWhileTheLightStandsStill) {
  const auto world = open("floating-box");
  ASSERT_NE(world, nullptr);
  raster::RasterOptions options = hybrid_options(256).raster;
  options.analysis = false;
  const std::vector<std::uint32_t> lights{0};
  std::uint64_t rays = 0, all_rays = 0;
  const auto build_time = [&] {
    const auto frame = world->renderer->render(options, lights);
    if (!frame) return std::vector<double>{};
    rays = frame->lights[0].external->rays, all_rays = frame->lights[0].external->all_rays;
    return frame->lights[0].external->build.runs;
  };
  const std::vector<double> first = build_time();
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(build_time(), first);
  EXPECT_LT(rays, all_rays / 2);
  world->scene.lights[0].direction = glm::normalize(world->scene.lights[0].direction + Vec3(0.1, 0, 0));
  const std::vector<double> moved = build_time();
  ASSERT_EQ(moved.size(), 1u);
  EXPECT_NE(moved, first);  // made again: another time
  // A light that moves is traced; one picture, to be analysed, has its sheets.
  EXPECT_EQ(rays, all_rays);
  options.analysis = true;
  world->scene.lights[0].direction = glm::normalize(world->scene.lights[0].direction + Vec3(0.1, 0, 0));
  static_cast<void>(build_time());
  EXPECT_LT(rays, all_rays / 2);
}

// Sheets that the first frame looks at closely are made for the light as much as the rest of them.
TEST(HybridTechnique, TimesOfTheMapHoldWhatTheFirstFrameAdds) {
  const auto world = open("fence");
  ASSERT_NE(world, nullptr);
  raster::RasterOptions options = hybrid_options(256).raster;
  options.runs = 3;
  const std::vector<std::uint32_t> lights{0};
  const auto frame = world->renderer->render(options, lights);
  ASSERT_TRUE(frame);
  const raster::ExternalCosts& external = *frame->lights[0].external;
  EXPECT_GT(external.build_later_ms, 0.0);
  const std::vector<double>&map = frame->lights[0].map_pass.runs, &build = external.build.runs;
  ASSERT_EQ(map.size(), 3u);
  ASSERT_EQ(build.size(), 4u);  // and the one before
  for (std::size_t i = 0; i < 3; ++i) EXPECT_GE(map[i], build[i + 1]) << "a pass holds what it makes";
  EXPECT_GE(external.shadow.least(), 0.0);
}

TEST(HybridTechnique, SaysWhenNobodyWorksItOut) {
  auto scene = load_scene("floating-box");
  ASSERT_TRUE(scene);
  OneWorld world(std::move(*scene));
  const auto frame = world.renderer->render(hybrid_options(64).raster, std::vector<std::uint32_t>{0});
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().kind, ErrorKind::internal);
}

}  // namespace
}  // namespace gnomon::test
