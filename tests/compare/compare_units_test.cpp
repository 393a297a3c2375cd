// Parts of the comparison on small, hand-made data: the deciding step, the bias curve, the budget.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/advice/rule.h"
#include "compare/bias/bias_curve.h"
#include "compare/bias/bias_kinds.h"
#include "compare/ladder/budget.h"
#include "compare/ladder/ladder.h"
#include "compare/result/engine_units.h"
#include "tests/support/compare_support.h"

namespace gnomon::compare {
namespace {

TEST(DecidingStep, OfAFalseShadowIsTheLastRise) {
  EXPECT_EQ(deciding_step({1, 1, 1, 0, 0, 0, 0}), Cause::slope);
  EXPECT_EQ(deciding_step({1, 1, 1, 0, 0, 1, 0}), Cause::filter);
  EXPECT_EQ(deciding_step({1, 1, 0, 1, 0, 0, 0}), Cause::precision);
  EXPECT_EQ(deciding_step({0.75f, 0, 0, 1, 0.25f, 0, 0}), Cause::bias) << "half is not wrong";
}

// Between V2 and V5 the surface shadows itself, and the bias takes that away again.
TEST(DecidingStep, OfAMissedShadowIsTheFirstRise) {
  EXPECT_EQ(deciding_step({0, 0, 1, 1, 1, 1, 1}), Cause::sampling);
  EXPECT_EQ(deciding_step({0, 0, 1, 0, 0, 1, 1}), Cause::sampling);
  EXPECT_EQ(deciding_step({0, 0, 0, 1, 0, 1, 1}), Cause::slope);
  EXPECT_EQ(deciding_step({0, 0, 0, 0, 0, 1, 1}), Cause::bias);
  EXPECT_EQ(deciding_step({0.4f, 1, 0, 0, 0, 1, 1}), Cause::light_size);
  EXPECT_EQ(deciding_step({0, 0, 1, 0, 0, 0, 1}), Cause::filter) << "V5 is dark: only the filter lights it";
}

TEST(Budget, TellsWhatAStepDarkenedFromWhatItLightened) {
  const BudgetStep step{-0.25, 0.75};
  EXPECT_EQ(step.darkened(), 0.5);
  EXPECT_EQ(step.lightened(), 0.25);
}

TEST(Accident, IsASamplingErrorThatALaterErrorHides) {
  EXPECT_TRUE(is_accident({0, 0, 1, 0, 0, 0, 0})) << "dark by shadowing itself";
  EXPECT_TRUE(is_accident({1, 1, 0, 0, 0, 1, 1})) << "lit by the bias";
  EXPECT_FALSE(is_accident({0, 0, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(is_accident({0, 0, 1, 1, 1, 1, 1})) << "wrong";
  EXPECT_FALSE(is_accident({1, 1, 1, 0, 0, 1, 1})) << "the bias is there to cure acne";
}

// A pixel drawn half lit is as near to right as to wrong: two of them count as one wrong pixel, and the
// counts stay whole numbers that add up.
TEST(ErrorStats, ExactHalvesCountHalf) {
  std::array<Image<float>, rung_count> rungs;
  for (Image<float>& rung : rungs) rung = Image<float>({4, 1}, 1.0f);
  rungs[6].data = {1.0f, 0.5f, 0.5f, 0.25f};
  PixelSums sums;
  sums.add(rungs, Image<Label>({4, 1}, Label::right));
  const ErrorStats error = sums.terms().error();
  EXPECT_EQ(error.wrong, 1u);
  EXPECT_EQ(error.false_shadow + error.missed_shadow, error.wrong);
  EXPECT_EQ(error.ties, 2u);
  EXPECT_EQ(error.fractional, 3u);
  EXPECT_EQ(error.wrong_fraction, 0.5);
  EXPECT_EQ(error.mean_absolute, 1.75 / 4.0);
}

TEST(BestBias, LiesBetweenTheLastLitAndTheFirstShadowedGap) {
  const BestBias best = find_best_bias({{-1.0f, 0.25f, 0.5f}, {1.0f, 2.0f}});
  EXPECT_TRUE(best.feasible);
  EXPECT_EQ(best.wrong_fraction, 0.0);
  EXPECT_EQ(best.constant_world, 1.1f * 0.5f) << "not far out on the plateau";
  EXPECT_EQ(best.needs_more_than, 0.5);
  EXPECT_EQ(best.needs_less_than, 1.0);
}

TEST(BestBias, SaysWhichPixelsContradict) {
  const BestBias best = find_best_bias({{0.1f, 0.2f, 3.0f}, {1.0f, 2.0f, 4.0f}});
  EXPECT_FALSE(best.feasible);
  EXPECT_DOUBLE_EQ(best.wrong_fraction, 1.0 / 6.0);
  EXPECT_DOUBLE_EQ(best.constant_world, 1.1f * 0.2f);
  EXPECT_EQ(best.lit_pixels_above, 1u);
  EXPECT_EQ(best.needs_more_than, 3.0);
  EXPECT_EQ(best.shadowed_pixels_below, 1u)
      << "no bias misses a shadow here but any below 1 shadows a lit pixel";
  EXPECT_EQ(best.needs_less_than, 1.0);
}

TEST(BestBias, AShadowThatNothingStoredCastsIsMissedAtAnyBias) {
  const float nothing = -std::numeric_limits<float>::infinity();
  const BestBias best = find_best_bias({{0.1f, 0.2f}, {nothing, nothing, 1.0f}});
  EXPECT_FALSE(best.feasible);
  EXPECT_DOUBLE_EQ(best.wrong_fraction, 0.4);
  EXPECT_EQ(best.shadowed_pixels_below, 2u);
  EXPECT_EQ(best.needs_less_than, -infinity);
  EXPECT_EQ(best.lit_pixels_above, 1u);
}

TEST(BestBias, WithoutShadowsIsATenthAboveTheLargestLitGap) {
  const BestBias best = find_best_bias({{0.1f, 0.3f}, {}});
  EXPECT_TRUE(best.feasible);
  EXPECT_FLOAT_EQ(static_cast<float>(best.constant_world), 1.1f * 0.3f);
}

// Half the light is as near to right as to wrong, whatever the bias.
TEST(BestBias, TiesCountHalf) {
  GapLists gaps{{0.1f, 0.3f}, {}};
  gaps.ties = 2;
  const BestBias best = find_best_bias(gaps);
  EXPECT_TRUE(best.feasible);
  EXPECT_EQ(best.wrong_fraction, 0.25);
  EXPECT_EQ(gaps.wrong_fraction_at(0.2), 0.5);
  EXPECT_EQ(smallest_good_range(gaps).from, 0.3f);
}

// Hundred pixels are wrong at any of these, and mending one more gains nothing that counts.
TEST(AdvisedBias, IsNotFarOutOnAPlateau) {
  GapLists gaps{{0.1f, 0.1f, 0.1f, 0.2f, 50.0f}, {1000.0f}};
  gaps.shadowed.insert(gaps.shadowed.begin(), 100, -1.0f);
  const BestBias best = find_advised_bias(gaps);
  EXPECT_FALSE(best.feasible);
  EXPECT_FLOAT_EQ(static_cast<float>(best.constant_world), 1.1f * 50.0f) << "the fewest are wrong there";
  ASSERT_TRUE(best.smaller.has_value());
  EXPECT_GT(best.smaller->constant_world, 0.1);
  EXPECT_LT(best.smaller->constant_world, 0.3);
  EXPECT_DOUBLE_EQ(best.smaller->wrong_fraction, gaps.wrong_fraction_at(best.smaller->constant_world));
  EXPECT_EQ(best.advised().constant_world, best.smaller->constant_world);
  const BestBias near = find_advised_bias({{0.1f, 0.2f, 3.0f}, {1.0f, 2.0f, 4.0f}});
  EXPECT_FALSE(near.smaller.has_value()) << "every smaller one is clearly worse";
  EXPECT_NEAR(near.advised().constant_world, near.constant_world, 5e-3 * near.constant_world);
}

// What is printed has three digits, in texels where the constant is given in texels, and its share is that of the rounded
// number: here the fewest are wrong between numbers that three digits do not tell apart.
TEST(AdvisedBias, HasThreeDigitsAndTheirShare) {
  const GapLists gaps{{0.123461f, 0.123462f}, {0.123464f, 5.0f}};
  const BestBias best = find_advised_bias(gaps);
  EXPECT_EQ(best.wrong_fraction, 0.0);
  EXPECT_EQ(best.advised().constant_world, 0.123);
  EXPECT_EQ(best.advised().wrong_fraction, 0.5);
  const double texel = 0.0201;
  const BestBias in_texels = find_advised_bias(gaps, texel);
  EXPECT_DOUBLE_EQ(in_texels.advised().constant_world, 6.14 * texel);
  EXPECT_EQ(in_texels.advised().wrong_fraction, gaps.wrong_fraction_at(6.14 * texel));
}

TEST(GoodRange, IsTheFirstThatIsHardlyWorse) {
  // 1,000 lit pixels, one of which needs a bias far beyond what the shadows bear.
  GapLists gaps{std::vector<float>(1000, 0.5f), {2.0f, 2.0f}};
  gaps.lit.push_back(100.0f);
  const BiasRange range = smallest_good_range(gaps);
  EXPECT_EQ(range.from, 0.5f);
  EXPECT_EQ(range.to, 2.0f);
  gaps.shadowed.clear();
  EXPECT_EQ(smallest_good_range(gaps).from, 100.0f) << "nothing speaks against it";
}

TEST(ShortNumber, HasFewDigitsAndLiesInTheRange) {
  EXPECT_EQ(short_number_in(0.0, 1.0), 0.0);
  EXPECT_EQ(short_number_in(0.0312, 7.0), 0.032);
  EXPECT_EQ(short_number_in(0.95, 1e9), 1.0);
  EXPECT_EQ(short_number_in(0.9, infinity), 0.9);
  const double low = 0.123456, high = std::nextafter(low, 1.0);
  EXPECT_EQ(short_number_in(low, high), 0.123) << "none of three digits lies between";
}

// A map of 100 units of depth, a texel of a quarter: the table of docs/engine-units.md by hand.
TEST(EngineUnits, AreThoseOfTheTable) {
  raster::LightRecord record;
  record.texel_world = 0.25, record.rounding.stored_step = std::exp2(-24.0);
  record.map.format = raster::DepthFormat::d24;
  record.map.view.projection = LightProjection::orthographic;
  record.map.view.size = 64, record.map.view.face_count = 1;
  LightFace& face = record.map.view.faces[0];
  face.near_depth = 10.0, face.far_depth = 110.0, face.half_extent = {8.0, 8.0};
  const Scene scene;
  World world;
  world.scene = &scene;
  raster::Bias bias;
  bias.slope = 1.0, bias.normal_offset_texels = 2.0;
  const auto value = [&, units = engine_units(bias, 0.5, LightType::directional, record, world)](
                         std::string_view engine, std::string_view setting) {
    for (const EngineUnit& unit : units)
      if (unit.engine == engine && unit.setting == setting) return unit.value.value_or(NAN);
    return double{NAN};
  };
  EXPECT_DOUBLE_EQ(value("three.js", "shadow.bias"), -0.005);
  EXPECT_DOUBLE_EQ(value("three.js", "shadow.normalBias"), 0.5);
  EXPECT_DOUBLE_EQ(value("Unity (URP)", "Depth Bias"), 2.0);
  EXPECT_DOUBLE_EQ(value("Unity (URP)", "Normal Bias"), 2.0);
  EXPECT_DOUBLE_EQ(value("Unreal", "Shadow Bias"), 0.4);
  EXPECT_DOUBLE_EQ(value("Unreal", "Shadow Slope Bias"), 0.25 * std::sqrt(0.5) / 1.5);
  EXPECT_DOUBLE_EQ(value("Godot", "shadow_bias"), 50.0);
  EXPECT_DOUBLE_EQ(value("Bevy", "shadow_depth_bias"), 0.5);
  EXPECT_DOUBLE_EQ(value("Babylon.js", "bias"), 0.005);
  EXPECT_DOUBLE_EQ(value("PlayCanvas", "shadowBias"), 0.1);
  EXPECT_DOUBLE_EQ(value("PlayCanvas", "normalOffsetBias"), 0.5);
  EXPECT_DOUBLE_EQ(value("polygon offset", "factor"), 1.0);
  EXPECT_DOUBLE_EQ(value("polygon offset", "units"), 0.005 * 16777216.0);
}

// What has no number in an engine's settings is not tried for it, nor a filter that follows the receiver's plane.
TEST(Engines, DrawOnlyWhatTheyCanBeTold) {
  const auto draws = [](std::string_view engine, raster::Technique technique, raster::Bias bias,
                        LightType light = LightType::directional) {
    raster::MapOptions map;
    map.technique = technique, map.bias = bias, map.filter.receiver_plane = false;
    return find_engine(engine)->draws(map, light);
  };
  using enum raster::Technique;
  const raster::Bias constant{.constant = 1.0, .unit = raster::BiasUnit::texel};
  const raster::Bias none{.constant = 0.0, .unit = raster::BiasUnit::world};
  raster::Bias of_casters = none, moved = none, constant_and_moved = constant;
  of_casters.caster_slope = 2.0, moved.normal_offset_texels = constant_and_moved.normal_offset_texels = 1.0;
  EXPECT_FALSE(draws("playcanvas", pcf, constant));
  EXPECT_FALSE(draws("playcanvas", pcf, none));
  EXPECT_TRUE(draws("playcanvas", pcf, of_casters));
  EXPECT_FALSE(draws("playcanvas", pcss, of_casters)) << "inert there";
  EXPECT_TRUE(draws("playcanvas", pcss, moved));
  EXPECT_TRUE(draws("godot", pcf, constant_and_moved));
  EXPECT_FALSE(draws("godot", pcf, constant, LightType::spot));
  EXPECT_FALSE(draws("godot3", csm, constant));
  EXPECT_TRUE(draws("filament", vsm, constant));
  EXPECT_FALSE(draws("filament", pcf, constant_and_moved));
  EXPECT_FALSE(draws("bevy", pcf, constant_and_moved, LightType::spot));
  raster::MapOptions plane;
  plane.technique = pcf, plane.bias = constant;
  EXPECT_FALSE(find_engine("godot")->draws(plane));
  EXPECT_EQ(engine_of_renderer("Godot 3 (RenderDoc)")->key, "godot3");
}

// Lit pixels that only a lifted shadow would mend choose no bias, and count as wrong.
TEST(BestBias, LiftsNoShadowForTexelsThatLieElsewhere) {
  GapLists gaps{{0.1f, 0.2f}, {500.0f}};
  gaps.lit_by_lifting = {20.0f, 30.0f};
  const BestBias best = find_best_bias(gaps);
  EXPECT_LT(best.constant_world, 1.0);
  EXPECT_DOUBLE_EQ(best.wrong_fraction, 2.0 / 5.0);
  EXPECT_EQ(smallest_good_range(gaps).from, 0.2f);
  EXPECT_DOUBLE_EQ(gaps.wrong_fraction_at(0.15), 3.0 / 5.0);
  EXPECT_DOUBLE_EQ(gaps.wrong_fraction_at(25.0), 1.0 / 5.0);
}

TEST(AdviceRule, AsksForAClearGainThatHarmsNothing) {
  constexpr std::uint64_t pixels = 100000;
  const Left now{0.02, 0.03, 0.03};
  EXPECT_TRUE(is_worth_advising({0.02, 0.02, 0.02}, now, pixels));
  EXPECT_FALSE(is_worth_advising({0.0201, 0.02, 0.0201}, now, pixels)) << "worse in the share";
  EXPECT_FALSE(is_worth_advising({0.001, 0.0301, 0.001}, now, pixels)) << "worse in the mean";
  EXPECT_FALSE(is_worth_advising({0.02, 0.029, 0.029}, now, pixels)) << "hardly less";
  EXPECT_FALSE(is_worth_advising({0.0, 0.0, std::nan("")}, now, pixels)) << "not known";
  const Left one{1e-5, 1e-5, 1e-5}, five{5e-5, 5e-5, 5e-5};
  EXPECT_FALSE(is_worth_advising({0.0, 0.0, 0.0}, one, pixels)) << "chance";
  EXPECT_TRUE(is_worth_advising({0.0, 0.0, 0.0}, five, pixels));
}

// Against counting one by one, on many random lists with ties.
TEST(BestBias, EqualsBruteForce) {
  std::uint32_t state = 1;
  const auto next = [&] { return (state = state * 1664525u + 1013904223u) >> 24; };
  for (int round = 0; round < 300; ++round) {
    GapLists gaps;
    for (int i = 0; i < 12; ++i) {
      gaps.lit.push_back(static_cast<float>(next() % 16) - 4.0f);
      gaps.shadowed.push_back(static_cast<float>(next() % 16) - 2.0f);
    }
    std::sort(gaps.lit.begin(), gaps.lit.end());
    std::sort(gaps.shadowed.begin(), gaps.shadowed.end());
    gaps.ties = next() % 3;
    std::uint64_t least = 1000;
    for (double b = 0.0; b < 20.0; b += 0.5) {
      std::uint64_t wrong = 0;
      for (const float g : gaps.lit) wrong += g > static_cast<float>(b);
      for (const float g : gaps.shadowed) wrong += !(g > static_cast<float>(b));
      const BiasCurvePoint point = gaps.at(b);
      EXPECT_EQ(point.false_shadow + point.missed_shadow, wrong);
      EXPECT_DOUBLE_EQ(point.wrong_fraction,
                       (double(wrong) + 0.5 * double(gaps.ties)) / double(gaps.count()));
      least = std::min(least, wrong);
    }
    const BestBias best = find_best_bias(gaps);
    EXPECT_DOUBLE_EQ(best.wrong_fraction, (double(least) + 0.5 * double(gaps.ties)) / double(gaps.count()));
    EXPECT_DOUBLE_EQ(best.wrong_fraction, gaps.at(best.constant_world).wrong_fraction);
  }
}

TEST(AcneFraction, EqualsSampling) {
  for (const double b : {0.0, 0.3, 1.0}) {
    for (const double bias : {-0.4, 0.0, 0.2, 0.9, 1.5}) {
      int above = 0;
      constexpr int n = 1000;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
          above += (2.0 * (i + 0.5) / n - 1.0) + b * (2.0 * (j + 0.5) / n - 1.0) > bias;
      EXPECT_NEAR(gnomon::test::acne_fraction(1.0, b, bias), above / double(n * n), 1e-3);
    }
  }
}

}  // namespace
}  // namespace gnomon::compare
