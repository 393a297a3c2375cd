// gnomon judge --identify on captures that Gnomon made with the map withheld: which map size and bias it finds.
// Four settings by default; GNOMON_IDENTIFY=all in the environment tries 24 and prints what was found.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "compare/result/option_names.h"
#include "compare/result/outputs.h"
#include "judge/identify.h"
#include "scene/load.h"
#include "tests/support/capture_support.h"
#include "tests/support/synthetic_comparison.h"

namespace gnomon::test {
namespace {

using raster::Technique;

constexpr ImageSize picture{320, 180};

struct Found {
  bool size = false, bias = false, technique = false;
};

/// What the pictures alone decide does not depend on the map that is found below them.
void expect_same_pictures(const compare::LightComparison& light, const compare::LightComparison& before) {
  const compare::ErrorStats &now = light.error, &then = before.error;
  EXPECT_TRUE(std::isfinite(then.flip));
  EXPECT_EQ(now.flip, then.flip);
  EXPECT_EQ(now.flip_compared, then.flip_compared);
  EXPECT_EQ(now.ssim, then.ssim);
  EXPECT_EQ(now.ssim_compared, then.ssim_compared);
  EXPECT_EQ(now.wrong, then.wrong);
  EXPECT_EQ(now.mean_absolute, then.mean_absolute);
  EXPECT_EQ(light.pixels.compared, before.pixels.compared);
  EXPECT_EQ(light.pixels.uncertain_by_samples, before.pixels.uncertain_by_samples);
}

/// A capture of the drawing without its map, judged.
JudgeOutcome judge_drawing(const Compared& drawn) {
  JudgeOutcome judged =
      judge(self_capture(drawn, testing::TempDir() + "/gnomon-identify", {.positions = true}));
  EXPECT_TRUE(judged.result) << reason(judged);
  return judged;
}

void identify_in(JudgeOutcome& judged) {
  auto context = raster::create_context(raster::Backend::automatic);
  ASSERT_TRUE(context);
  auto renderer = raster::Renderer::create(std::move(*context), *judged.world, plan_effects(*judged.scene));
  ASSERT_TRUE(renderer);
  const auto done = judge::identify(*judged.result, **renderer, {});
  ASSERT_TRUE(done) << done.error().message();
}

compare::Identified identified(const std::string& name, const raster::MapOptions& map) {
  JudgeOutcome judged = judge_drawing(draw_builtin(name, picture, map));
  if (!judged.result) return {};
  identify_in(judged);
  return judged.result->judged->identified.value_or(compare::Identified{});
}

Found identify_one(const std::string& name, const raster::MapOptions& map) {
  const Compared drawn = draw_builtin(name, picture, map);
  const raster::LightRecord& record = drawn.result.raster.lights[0];
  JudgeOutcome judged = judge_drawing(drawn);
  if (!judged.result) return {};
  const compare::LightComparison before = judged.result->lights[0];
  identify_in(judged);
  if (!judged.result->judged->identified) return {};
  const compare::Identified& found = *judged.result->judged->identified;
  const double off = std::abs(found.bias_world - record.bias_constant_world) / record.texel_world;
  fmt::print("{:14} {:5} {:5} bias {:.4f} -> {} ({:.3f} texels off), explained {:.1f} %, {} drawings\n", name,
             compare::technique_name(map.technique), map.size, record.bias_constant_world, found.options, off,
             100.0 * found.explained, found.renders);
  const nlohmann::json json = nlohmann::json::parse(compare::result_json(*judged.result));
  EXPECT_EQ(json["lights"][0]["map"]["inferred"], true);
  const compare::LightComparison& light = judged.result->lights[0];
  expect_same_pictures(light, before);
  double signed_sum = 0.0;
  for (const compare::BudgetStep& step : light.budget) signed_sum += step.signed_mean;
  EXPECT_NEAR(signed_sum, light.rung_mean[6] - light.rung_mean[0], 1e-9);
  return {found.map_size == map.size, off <= 0.5, found.technique == compare::technique_name(map.technique)};
}

raster::MapOptions setting(Technique technique, int size, double bias) {
  raster::MapOptions map;
  map.technique = technique, map.size = size;
  map.bias = {.constant = bias, .unit = raster::BiasUnit::texel};
  map.filter.radius_texels = 1.5;
  map.filter.receiver_plane = false;
  return map;
}

TEST(JudgeIdentify, FindsMapSizeAndBias) {
  const bool all = std::getenv("GNOMON_IDENTIFY") != nullptr;
  const std::vector<int> sizes = all ? std::vector{256, 512, 1024} : std::vector{512};
  const std::vector<double> biases = all ? std::vector{0.3, 1.0} : std::vector{0.6};
  int tried = 0, size = 0, bias = 0, technique = 0;
  for (const Technique t : {Technique::hard, Technique::pcf, Technique::vsm, Technique::csm})
    for (const int s : sizes)
      for (const double b : biases) {
        const Found found = identify_one("floating-box", setting(t, s, b));
        ++tried, size += found.size, bias += found.bias, technique += found.technique;
      }
  fmt::print("of {}: technique {}, map size {}, bias within half a texel {}\n", tried, technique, size, bias);
  // Of 24 settings at least 20.
  EXPECT_GE(size * 24, tried * 20);
  EXPECT_GE(bias * 24, tried * 20);
}

// A pixel that the model draws otherwise is no longer one whose shadow stands off.
TEST(JudgeIdentify, CountsTheDetachmentOfWhatIsExplainedAlone) {
  const auto made = compare::make_synthetic();
  compare::LightComparison& light = made->comparison.lights.front();
  const ImageSize size = light.labels.size;
  Image<float> model = light.rungs[6];
  light.detachment_map = Image<float>(size, std::numeric_limits<float>::quiet_NaN());
  std::uint64_t kept = 0;
  for (std::size_t i = 0, n = 0; i < light.labels.data.size(); ++i) {
    if (light.labels.data[i] != compare::Label::peter_panning) continue;
    light.detachment_map.data[i] = 0.5f;
    if (n++ % 2 == 0)
      model.data[i] = 1.0f - model.data[i];
    else
      ++kept;
  }
  ASSERT_GT(kept, 0u);
  judge::mark_unexplained(model, light);
  EXPECT_EQ(light.classes[static_cast<std::size_t>(compare::Label::peter_panning) - 1], kept);
  EXPECT_EQ(light.detachment.pixels, kept);
}

/// Judges a drawing of the scene against the scene with its sun elsewhere, and returns what is noted and identified.
std::pair<std::string, bool> judged_under_turned_sun(double degrees) {
  const Compared drawn = draw_builtin("floating-box", picture, setting(Technique::hard, 1024, 0.6));
  const judge::Capture capture =
      self_capture(drawn, testing::TempDir() + "/gnomon-turned-sun", {.positions = true});
  Scene said = *load_scene("floating-box");
  said.lights.resize(1);
  Vec3& sun = said.lights.front().direction;
  const double turn = glm::radians(degrees);
  sun = {std::cos(turn) * sun.x + std::sin(turn) * sun.z, sun.y,
         std::cos(turn) * sun.z - std::sin(turn) * sun.x};
  JudgeOutcome judged = judge(capture, said);
  EXPECT_TRUE(judged.result) << reason(judged);
  if (!judged.result) return {};
  identify_in(judged);
  std::string notes;
  for (const std::string& note : judged.result->judged->notes) notes += note + "\n";
  return {notes, judged.result->judged->identified.has_value()};
}

// Shadows of another sun are no setting's: the sun is named, and nothing is labelled by a setting.
TEST(JudgeIdentify, NamesASunThatStandsElsewhere) {
  const auto [turned, labels] = judged_under_turned_sun(12.0);
  EXPECT_NE(turned.find("the sun stands elsewhere: "), std::string::npos) << turned;
  EXPECT_FALSE(labels);
  const auto [right, labels_right] = judged_under_turned_sun(0.0);
  EXPECT_EQ(right.find("the sun stands elsewhere"), std::string::npos) << right;
  EXPECT_TRUE(labels_right);
}

// Gnomon's own pcf compares with the receiver's plane, which few other renderers do.
TEST(JudgeIdentify, FindsTheFilterThatGnomonDrawsUnasked) {
  raster::MapOptions map;
  map.technique = Technique::pcf, map.size = 512;
  map.bias = raster::default_bias(map);
  const compare::Identified found = identified("floating-box", map);
  EXPECT_TRUE(found.options.starts_with("--technique pcf --map-size 512 --bias auto")) << found.options;
  EXPECT_EQ(found.options.find("--filter-plane"), std::string::npos) << found.options;
  EXPECT_GT(found.explained, 0.99);
}

// The options that are told are those of the drawing, and no other of the sizes tried comes nearer.
TEST(JudgeIdentify, FindsAFilterWithoutTheReceiversPlane) {
  const compare::Identified found = identified("courtyard", setting(Technique::pcf, 512, 1.5));
  EXPECT_TRUE(found.options.starts_with("--technique pcf --map-size 512 --bias ")) << found.options;
  EXPECT_TRUE(found.options.ends_with(" --filter-plane off")) << found.options;
  EXPECT_GT(found.explained, 0.9);
}

}  // namespace
}  // namespace gnomon::test
