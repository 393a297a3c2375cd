// --technique rays through the rasterizer and the comparison: steps that add up and mean what they say, hard lights exact,
// pictures the same for any number of threads.
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/result/estimate.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/verdict.h"
#include "rays/visibility.h"
#include "scene/load.h"
#include "tests/support/one_world.h"

namespace gnomon::test {
namespace {

using compare::Cause;
using raster::Denoiser;

compare::CompareOptions ray_options(Denoiser denoiser, int history = 1) {
  compare::CompareOptions options;
  options.raster.size = options.raytrace.size = {192, 108};
  options.raster.map.technique = raster::Technique::rays;
  options.raster.map.rays.denoiser = denoiser;
  options.raster.map.rays.history = history;
  options.raster.runs = 0;
  options.raster.seed = options.raytrace.seed = 9;
  options.perceptual = false;
  return options;
}

std::unique_ptr<OneWorld> open(const std::string& name) {
  auto scene = load_scene(name);
  if (!scene) return nullptr;
  auto world = std::make_unique<OneWorld>(std::move(*scene));
  world->renderer->use_external_visibility(raster::Technique::rays, rays::make_visibility(world->world));
  return world;
}

double step(const compare::LightComparison& light, Cause cause) {
  return light.budget[static_cast<std::size_t>(cause)].absolute_mean;
}

constexpr std::array denoisers{Denoiser::none, Denoiser::penumbra, Denoiser::atrous, Denoiser::svgf,
                               Denoiser::fidelityfx};

TEST(RaysTechnique, StepsAddUpAndMeanWhatTheySay) {
  const auto world = open("penumbra");
  ASSERT_NE(world, nullptr);
  for (const Denoiser denoiser : denoisers)
    for (const int history : {1, 5}) {
      const compare::Comparison result = world->compare(ray_options(denoiser, history));
      const compare::LightComparison& light = result.lights.front();
      double sum = 0.0;
      for (const compare::BudgetStep& one : light.budget) sum += one.signed_mean;
      // Sums of some 19,000 floats in doubles, and means of both ends.
      EXPECT_NEAR(sum, light.rung_mean.back() - light.rung_mean.front(), 1e-12);
      EXPECT_EQ(step(light, Cause::light_size), 0.0);
      EXPECT_EQ(step(light, Cause::sampling), 0.0);
      EXPECT_EQ(step(light, Cause::rays_lag), 0.0) << "nothing moves";
      EXPECT_GT(step(light, Cause::rays_noise), 0.0);
      // But for the one that clamps, what the denoiser makes of the rays again is what was drawn, to the bit.
      EXPECT_EQ(step(light, Cause::rays_remap) == 0.0, denoiser != Denoiser::fidelityfx) << int(denoiser);
      EXPECT_EQ(step(light, Cause::rays_blur) == 0.0, denoiser == Denoiser::none) << int(denoiser);
      for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
        const auto label = light.labels.data[i];
        if (!compare::has_cause(label)) continue;
        ASSERT_TRUE(label == compare::Label::blur || label == compare::Label::noise ||
                    label == compare::Label::remap);
      }
    }
}

TEST(RaysTechnique, HistoryAndRaysTakeNoiseAway) {
  const auto world = open("penumbra");
  ASSERT_NE(world, nullptr);
  const auto noise = [&](raster::RayCount count, int history) {
    compare::CompareOptions options = ray_options(Denoiser::none, history);
    options.raster.map.rays.count = count;
    return step(world->compare(options).lights.front(), Cause::rays_noise);
  };
  const double one = noise(raster::RayCount::one, 1);
  EXPECT_LT(noise(raster::RayCount::four, 1), 0.55 * one);
  EXPECT_LT(noise(raster::RayCount::one, 16), 0.3 * one);
  EXPECT_LT(noise(raster::RayCount::sixteen, 16), 0.1 * one);
}

TEST(RaysTechnique, OneRayToALightWithoutSizeIsExact) {
  for (const char* name : {"fence", "floating-box", "whitted"}) {
    const auto world = open(name);
    ASSERT_NE(world, nullptr);
    const compare::Comparison result = world->compare(ray_options(Denoiser::svgf, 3));
    for (const compare::LightComparison& light : result.lights) {
      if (has_size(world->scene.lights[light.light])) continue;
      EXPECT_GT(light.pixels.compared, 0u);
      EXPECT_EQ(light.error.mean_absolute, 0.0) << name;
    }
  }
}

TEST(RaysTechnique, SaysNothingInTexelsOfAMapThatIsNotThere) {
  const auto world = open("penumbra");
  ASSERT_NE(world, nullptr);
  const compare::Comparison result = world->compare(ray_options(Denoiser::penumbra));
  const compare::LightComparison& light = result.lights.front();
  EXPECT_GT(light.edges.edges, 0u);
  EXPECT_GT(light.edges.rms_world, 0.0);
  EXPECT_TRUE(std::isnan(light.edges.rms_texels));
  const auto json = nlohmann::json::parse(compare::result_json(result, 0.0, 0.0));
  const auto& map = json.at("lights").at(0).at("map");
  for (const char* key : {"size", "faces", "depth_format", "stores", "window"})
    EXPECT_TRUE(map.at(key).is_null()) << key;
  EXPECT_TRUE(map.at("texel_world").at("median").is_null());
  EXPECT_TRUE(map.at("windows").empty());
}

TEST(RaysTechnique, AnotherMachinesTimeIsItsRatesTimesWhatWasCounted) {
  const auto world = open("penumbra");
  ASSERT_NE(world, nullptr);
  compare::CompareOptions options = ray_options(Denoiser::penumbra);
  const auto estimated = [&](bool moves) {
    compare::Comparison result = world->compare(options);
    result.rates =
        compare::Rates{.name = "slow", .source = "", .texels = 1e6, .lookups = 2e6, .rays = 4e6, .taps = 8e6};
    return std::pair(compare::estimated_sides(result, result.lights.front(), moves), result);
  };
  const auto [rays, drawn] = estimated(true);
  const auto& cast = *drawn.raster.lights.front().external;
  EXPECT_DOUBLE_EQ(rays.map, double(cast.rays) / 4e3 + double(cast.taps) / 8e3);
  EXPECT_DOUBLE_EQ(rays.rays, double(drawn.raytraced.lights.front().soft_rays) / 4e3);
  options.raster.map = {};
  const auto [still, hard] = estimated(false);
  EXPECT_DOUBLE_EQ(still.map, double(*hard.lights.front().lookups) / 2e3);
  const double texels = double(hard.raster.lights.front().map_texels);
  EXPECT_DOUBLE_EQ(estimated(true).first.map, still.map + texels / 1e3);
  EXPECT_GT(texels, 0.0);
}

TEST(RaysTechnique, EdgesThatABlurTakesAwayAreNotRightToTheTexel) {
  const auto world = open("penumbra");
  ASSERT_NE(world, nullptr);
  compare::CompareOptions options = ray_options(Denoiser::none);
  options.raster.map = {};
  options.raster.map.technique = raster::Technique::esm;
  options.raster.map.size = 64;
  const compare::Comparison result = world->compare(options);
  EXPECT_EQ(result.lights.front().edges.edges, 0u);
  EXPECT_TRUE(std::isnan(result.lights.front().edges.rms_texels));
}

TEST(RaysTechnique, SamplesTooFewForPenumbrasAreSaid) {
  const auto world = open("penumbra");
  ASSERT_NE(world, nullptr);
  compare::CompareOptions options = ray_options(Denoiser::none);
  for (const auto& [samples, said] : {std::pair(4, true), {256, false}}) {
    options.raytrace.shadow_samples = samples;
    const compare::Comparison result = world->compare(options);
    const std::string words = compare::verdict_on(result, result.lights.front()).whole();
    EXPECT_EQ(words.find("use more --samples") != std::string::npos, said) << words;
  }
}

TEST(RaysTechnique, FinishedPicturesAreAsRightAsTheirShadows) {
  const auto world = open("fence");
  ASSERT_NE(world, nullptr);
  compare::CompareOptions options = ray_options(Denoiser::none);
  options.perceptual = true;
  const compare::Comparison exact = world->compare(options);
  ASSERT_TRUE(exact.shaded);
  EXPECT_EQ(exact.shaded->mean_absolute, 0.0);
  EXPECT_EQ(exact.shaded->flip, 0.0);
  options.raster.map = {};
  const compare::Comparison hard = world->compare(options);
  ASSERT_TRUE(hard.shaded);
  EXPECT_GT(hard.shaded->mean_absolute, 0.0);
  EXPECT_LT(hard.shaded->mean_absolute, hard.lights.front().error.mean_absolute);
  EXPECT_LT(hard.shaded->flip, hard.lights.front().error.flip);
  EXPECT_FALSE(open("whitted")->compare(options).shaded) << "rays mirror there";
}

TEST(RaysTechnique, PartsOfALightThatContributeAlikeWeighNothing) {
  const auto weighted = [](OneWorld& world) {
    compare::CompareOptions options = ray_options(Denoiser::none);
    options.raster.map = {};
    options.perceptual = true;
    options.raytrace.shadow_samples = 64;
    return world.compare(options).lights.front().penumbra->weighted_difference;
  };
  auto under_sun = load_scene("courtyard");
  ASSERT_TRUE(under_sun);
  under_sun->lights.front().extent = SunDisc{.angular_diameter = 0.0093};
  OneWorld courtyard(std::move(*under_sun));
  // Half a degree of the sun changes the cosine by less than a hundredth; a lamp near its receivers has nearer parts.
  const double sun = weighted(courtyard), lamp = weighted(*open("penumbra"));
  EXPECT_LT(sun, 0.002);
  EXPECT_GT(lamp, 0.005);
}

TEST(RaysTechnique, DrawsTheSameOnOneThread) {
  const auto picture = [](Denoiser denoiser) {
    const auto world = open("penumbra");
    return world->compare(ray_options(denoiser, 3)).raster.lights.front().visibility.data;
  };
  for (const Denoiser denoiser : denoisers) {
    const auto many = picture(denoiser);
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(picture(denoiser), many) << int(denoiser);
  }
}

}  // namespace
}  // namespace gnomon::test
