// The engine's short cuts against single comparisons: every number of every cell is the same, to the last
// bit.
#include <random>

#include "compare/result/output_parts.h"
#include "scene/load.h"
#include "studies/sweep/engine.h"
#include "tests/support/one_world.h"
#include "tests/support/small_scenes.h"

namespace gnomon::test {
namespace {

using compare::Setting;
using studies::Engine;

constexpr ImageSize size{240, 135};

// A sun, a spot and a point light; a sphere and a plane beside triangles.
Scene boxes_and_ball() {
  Scene scene = test::boxes_under_three_lights();
  scene.shapes.push_back({"ball", Sphere{{-1.2, 0.5, 0.6}, 0.5}, 0});
  return scene;
}

/// A world with an engine at work in it, and single comparisons beside it.
struct SweepRun {
  OneWorld swept_world, single_world;
  Engine engine;
  Setting first;

  explicit SweepRun(const Scene& scene, bool perceptual = false)
      : swept_world(scene),
        single_world(scene),
        engine(swept_world.scene, swept_world.world, *swept_world.renderer, perceptual) {
    first.raster.size = first.raytrace.size = size;
    first.raster.runs = 0;
    first.raster.map.size = 128;
    first.raster.map.bias = {0.01, raster::BiasUnit::world};
    first.raytrace.picture = false;
    first.camera = scene.camera;
    first.lights = scene.lights;
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i) first.compared.push_back(i);
  }

  std::string swept(const Setting& setting, studies::Detail detail = studies::Detail::images) {
    const auto result = engine.compare(setting, detail);
    if (!result) return result.error().message();
    return compare::result_line(**result, {});
  }
  std::string alone(const Setting& setting, bool perceptual = false) {
    compare::CompareOptions options;
    options.raster = setting.raster;
    options.raytrace = setting.raytrace;
    options.perceptual = perceptual;
    single_world.scene.camera = setting.camera;
    single_world.scene.lights = setting.lights;
    return compare::result_line(single_world.compare(options), {});
  }
};

// 20 constant biases at random: none is drawn, each equals its own drawing.
TEST(Engine, DerivedFramesEqualDrawnOnes) {
  SweepRun shop(boxes_and_ball());
  ASSERT_EQ(shop.swept(shop.first), shop.alone(shop.first));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-4.0, 0.0);
  for (int i = 0; i < 20; ++i) {
    Setting setting = shop.first;
    setting.raster.map.bias.constant = std::pow(10.0, exponent(random)) * (i % 7 == 3 ? -1.0 : 1.0);
    setting.raster.map.bias.unit = i % 5 == 4 ? raster::BiasUnit::texel : raster::BiasUnit::world;
    EXPECT_EQ(shop.swept(setting), shop.alone(setting)) << "bias " << setting.raster.map.bias.constant;
    EXPECT_TRUE(shop.engine.last_was_derived());
  }
  EXPECT_EQ(shop.engine.work().renders, 1u);
  EXPECT_EQ(shop.engine.work().derived, 20u);
  EXPECT_EQ(shop.engine.work().truths, 1u);
}

/// Draws 20 points at random of every technique that has a curve again, in the unit that --bias takes, and the best one.
void expect_curve_is_drawn(const Scene& scene, raster::Technique technique) {
  SweepRun shop(scene);
  Setting setting = shop.first;
  setting.raster.map.technique = technique;
  setting.raster.map.bias = {1.0, raster::BiasUnit::texel, 0.5};
  ASSERT_TRUE(compare::biases_follow_from_gaps(setting.raster.map));
  const auto drawn = shop.engine.compare(setting);
  ASSERT_TRUE(drawn) << drawn.error().message();
  const compare::LightComparison light = (*drawn)->lights.front();
  std::vector<compare::BiasCurvePoint> points{{light.best_bias.constant_world}};
  std::mt19937 random(4);
  for (int i = 0; i < 20; ++i) points.push_back(light.bias_curve[random() % light.bias_curve.size()]);
  compare::CompareOptions options;
  options.raster = setting.raster, options.raytrace = setting.raytrace, options.perceptual = false;
  for (const compare::BiasCurvePoint& point : points) {
    options.raster.map.bias = compare::with_constant(setting.raster.map, point.bias, light.bias_texel_world);
    const compare::ErrorStats error = shop.single_world.compare(options).lights.front().error;
    const bool best = &point == &points.front();
    if (best)
      EXPECT_DOUBLE_EQ(error.wrong_fraction, light.best_bias.wrong_fraction) << "best " << point.bias;
    else
      EXPECT_EQ(std::pair(error.false_shadow, error.missed_shadow),
                std::pair(point.false_shadow, point.missed_shadow))
          << "technique " << int(technique) << " bias " << point.bias;
  }
}

TEST(Engine, EveryCurveIsWhatItsBiasesDraw) {
  using enum raster::Technique;
  Scene scene = boxes_and_ball();
  const std::vector<Light> lights = scene.lights;
  scene.lights = {lights[0]};
  for (const raster::Technique technique : {hard, second_depth, midpoint, csm, lispsm})
    expect_curve_is_drawn(scene, technique);
  scene.lights = {lights[1]};
  expect_curve_is_drawn(scene, hard);
  scene.lights = {lights[2]};
  for (const raster::Technique technique : {hard, cube}) expect_curve_is_drawn(scene, technique);
}

// What a filter would draw with another bias does not follow from the gaps of a hard test.
TEST(Engine, TechniquesWithoutACurveSayWhy) {
  using enum raster::Technique;
  Scene scene = boxes_and_ball();
  scene.lights.resize(1);
  SweepRun shop(scene);
  for (const raster::Technique technique : {pcf, pcss, vsm, esm, evsm, msm, izb}) {
    Setting setting = shop.first;
    setting.raster.map.technique = technique;
    const auto drawn = shop.engine.compare(setting);
    ASSERT_TRUE(drawn) << drawn.error().message();
    const compare::LightComparison& light = (*drawn)->lights.front();
    EXPECT_TRUE(light.bias_curve.empty()) << int(technique);
    EXPECT_FALSE(light.bias_curve_withheld.empty()) << int(technique);
    const std::string line = compare::result_line(**drawn, {});
    EXPECT_NE(line.find("\"best_bias\":{\"constant_world\":null"), std::string::npos) << line;
  }
}

// An endless plane goes on behind the map's last depth: what is not stored there is no rounding of the map's.
TEST(Ladder, WhatLiesBeyondTheMapIsNotImprecise) {
  OneWorld whitted(load_scene("whitted").value());
  compare::CompareOptions options;
  options.raster.size = options.raytrace.size = {480, 270};
  options.raster.runs = 0;
  options.perceptual = false;
  const compare::LightComparison light = whitted.compare(options).lights.front();
  EXPECT_LT(light.budget[static_cast<std::size_t>(compare::Cause::precision)].absolute_mean, 1e-6)
      << "549 of 84,511 pixels at the horizon once";
}

/// Texels of a (2 reach + 1)^2 kernel around a place in a map of so many texels that lie in it.
std::uint64_t texels_in_map(Vec2f uv, int reach, int map) {
  const auto along = [&](float at) {
    const int middle = static_cast<int>(std::floor(at));
    return std::max(0, std::min(map - 1, middle + reach) - std::max(0, middle - reach) + 1);
  };
  const bool inside = uv.x >= 0.0f && uv.y >= 0.0f && uv.x < float(map) && uv.y < float(map);
  return inside ? static_cast<std::uint64_t>(along(uv.x)) * static_cast<std::uint64_t>(along(uv.y)) : 0;
}

TEST(Lookups, AreCountedTexelByTexel) {
  Scene scene = boxes_and_ball();
  scene.lights.resize(1);
  SweepRun shop(scene);
  for (const int reach : {0, 1, 3}) {
    Setting setting = shop.first;
    setting.raster.map.technique = reach == 0 ? raster::Technique::hard : raster::Technique::pcf;
    setting.raster.map.filter.radius_texels = reach + 0.5;
    const auto drawn = shop.engine.compare(setting);
    ASSERT_TRUE(drawn) << drawn.error().message();
    const compare::LightComparison& light = (*drawn)->lights.front();
    const raster::LightRecord& record = (*drawn)->raster.lights.front();
    std::uint64_t expected = 0;
    for (std::size_t i = 0; i < light.labels.data.size(); ++i)
      if (compare::is_compared(light.labels.data[i]))
        expected += texels_in_map(record.texel_uv.data[i], reach, record.map.view.size);
    EXPECT_EQ(light.lookups, std::optional(expected)) << "reach " << reach;
  }
  Setting exact = shop.first;
  exact.raster.map.technique = raster::Technique::izb;
  const auto drawn = shop.engine.compare(exact);
  ASSERT_TRUE(drawn) << drawn.error().message();
  EXPECT_FALSE((*drawn)->lights.front().lookups) << "lists are walked, and no map is looked up";
}

// The shading without shadows is timed beside the other and leaves no trace in the picture.
TEST(ShadowCost, IsTimedInTurnAndDrawsNothing) {
  for (const auto technique : {raster::Technique::hard, raster::Technique::pcf, raster::Technique::vsm}) {
    OneWorld apart(boxes_and_ball()), plain(boxes_and_ball());
    compare::CompareOptions options;
    options.raster.size = options.raytrace.size = size;
    options.raster.map.size = 128, options.raster.map.technique = technique;
    options.raster.runs = 2;
    options.raytrace.runs = 2, options.raytrace.warm_up = true;
    options.perceptual = false;
    const compare::Comparison without = plain.compare(options);
    options.raster.shadow_cost = true;
    const compare::Comparison with = apart.compare(options);
    EXPECT_TRUE(with.raster.color.data == without.raster.color.data) << int(technique);
    for (std::size_t i = 0; i < with.raster.lights.size(); ++i) {
      const raster::LightRecord& record = with.raster.lights[i];
      EXPECT_TRUE(record.visibility.data == without.raster.lights[i].visibility.data) << int(technique);
      EXPECT_EQ(record.shade_pass.runs.size(), 2u);
      EXPECT_EQ(record.unshadowed_pass.runs.size(), 2u);
      EXPECT_TRUE(without.raster.lights[i].unshadowed_pass.runs.empty());
      EXPECT_GT(record.first_map_ms, 0.0);
      EXPECT_FALSE(record.strips.empty());
      double sum = 0.0;
      for (const TimedStrip& strip : record.strips) {
        EXPECT_EQ(strip.part.runs.size(), 2u);
        sum += strip.whole.runs.front() - strip.part.runs.front();
      }
      EXPECT_NEAR(sum, record.shade_pass.runs.front() - record.unshadowed_pass.runs.front(), 1e-6);
      EXPECT_GE(with.raytraced.structure.runs.size(), 1u);
      EXPECT_LE(with.raytraced.structure.runs.size(), 2u);
      EXPECT_EQ(with.raytraced.lights[i].shadow_rays.runs.size(), 2u);
      EXPECT_EQ(with.raytraced.lights[i].light_structure.runs.size(), 2u);
    }
  }
}

// Where the constant scales with the texel, a bias in world units is another drawing, not another constant.
TEST(Engine, UnitsOfCascadesAreNotDerivedFromEachOther) {
  Scene scene = boxes_and_ball();
  scene.lights.resize(1);
  SweepRun shop(scene);
  Setting setting = shop.first;
  setting.raster.map.technique = raster::Technique::csm;
  for (const raster::BiasUnit unit : {raster::BiasUnit::texel, raster::BiasUnit::world}) {
    setting.raster.map.bias = {0.03, unit};
    EXPECT_EQ(shop.swept(setting), shop.alone(setting));
    EXPECT_FALSE(shop.engine.last_was_derived());
  }
}

// The same when the numbers of all biases are made together, without images.
TEST(Engine, BiasAxisEqualsDrawnFrames) {
  SweepRun shop(boxes_and_ball());
  for (const bool offset : {false, true}) {  // with an offset, receivers look up other texels than their own
    Setting setting = shop.first;
    setting.raster.map.bias.normal_offset_texels = offset ? 1.5 : 0.0;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> exponent(-4.0, 0.0);
    std::vector<raster::Bias> biases;
    for (int i = 0; i < 20; ++i) {
      biases.push_back(setting.raster.map.bias);
      biases.back().constant = i == 0 ? 0.0 : std::pow(10.0, exponent(random)) * (i % 7 == 3 ? -1.0 : 1.0);
      biases.back().unit = i % 5 == 4 ? raster::BiasUnit::texel : raster::BiasUnit::world;
    }
    ASSERT_TRUE(shop.engine.compare(setting));
    shop.engine.expect_biases(biases);
    for (const raster::Bias& bias : biases) {
      setting.raster.map.bias = bias;
      EXPECT_EQ(shop.swept(setting, studies::Detail::numbers), shop.alone(setting))
          << "bias " << bias.constant;
      EXPECT_TRUE(shop.engine.last_was_derived());
    }
  }
  EXPECT_EQ(shop.engine.work().renders, 2u);
}

// Other options share the truth, and the lower rungs where the map is the same; the numbers do not know.
TEST(Engine, CellsEqualSingleComparisons) {
  SweepRun shop(boxes_and_ball());
  std::mt19937 random(2);
  const auto pick = [&](auto... choices) {
    const auto list = {choices...};
    return *(list.begin() + random() % list.size());
  };
  Setting setting = shop.first;
  for (int i = 0; i < 12; ++i) {
    raster::MapOptions& map = setting.raster.map;
    if (i % 3 == 0) {
      map.size = pick(64, 100, 128);
      map.depth_format = pick(raster::DepthFormat::d16, raster::DepthFormat::d32f);
      map.cull = pick(raster::Cull::none, raster::Cull::front, raster::Cull::back);
    }
    // One kind of bias at a time: each needs shaders of its own, which take longer than all the rest.
    map.bias = {pick(0.0, 0.02), raster::BiasUnit::world};
    const int kind = i % 4;
    map.bias.slope = kind == 1 ? 1.5 : 0.0;
    map.bias.normal_offset_texels = kind == 2 ? 1.0 : 0.0;
    map.bias.receiver_plane = kind == 3;
    if (i % 5 == 4) setting.camera.eye += Vec3(0.2, 0.1, 0.0);
    if (i % 7 == 6) setting.lights[0].direction = glm::normalize(Vec3(-0.5, -1.0, 0.1 * i));
    EXPECT_EQ(shop.swept(setting), shop.alone(setting)) << "cell " << i;
  }
  EXPECT_LT(shop.engine.work().truths, 7u);
  EXPECT_LT(shop.engine.work().lower_climbs, 3 * shop.engine.work().renders);
}

// What the map is drawn by beyond its options, such as second-depth's culling, holds for derived cells, too.
TEST(Engine, DerivedCellsOfEveryTechniqueEqualSingleComparisons) {
  Scene scene = boxes_and_ball();
  scene.lights.resize(1);  // the sun, which most techniques serve
  SweepRun shop(scene);
  Setting setting = shop.first;
  for (const raster::TechniqueTraits& traits : raster::all_technique_traits()) {
    setting.raster.map.technique = traits.technique;
    if (!compare::biases_follow_from_gaps(setting.raster.map) ||
        !raster::has_map_for(traits.technique, LightType::directional))
      continue;
    setting.raster.map.bias.constant = 0.02, setting.raster.map.bias.unit = raster::BiasUnit::world;
    EXPECT_EQ(shop.swept(setting), shop.alone(setting)) << traits.name;
    const auto renders = shop.engine.work().renders;
    setting.raster.map.bias.constant = 0.05;
    EXPECT_EQ(shop.swept(setting), shop.alone(setting)) << traits.name << ", derived";
    EXPECT_EQ(shop.engine.work().renders, renders) << traits.name;
  }
}

TEST(Engine, PerceptualMetricsOnlyWhenAsked) {
  SweepRun shop(boxes_and_ball(), true);
  EXPECT_EQ(shop.swept(shop.first), shop.alone(shop.first, true));
  EXPECT_NE(shop.alone(shop.first, true), shop.alone(shop.first, false));
}

}  // namespace
}  // namespace gnomon::test
