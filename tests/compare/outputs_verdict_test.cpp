// What is said of a light, from counts that are set by hand.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "compare/result/figures.h"
#include "compare/result/judged.h"
#include "compare/result/text_layout.h"
#include "compare/result/verdict.h"
#include "tests/support/synthetic_comparison.h"

namespace gnomon::compare {
namespace {

// A light whose counts are set by hand.
struct Case {
  std::unique_ptr<Synthetic> made = make_synthetic();
  LightComparison& light = made->comparison.lights[0];
  Case(std::uint64_t compared, std::array<std::uint64_t, class_count> classes) {
    light.pixels = {compared, 0, 0, 0, 0, compared};
    light.classes = classes;
    for (std::size_t k = 0; k < class_count; ++k)
      light.class_errors[k] = static_cast<double>(classes[k]) / static_cast<double>(compared);
    light.error.wrong = 0;
    for (const std::uint64_t n : classes) light.error.wrong += n;
    light.error.ties = light.error.fractional = 0;
    light.error.wrong_fraction = static_cast<double>(light.error.wrong) / static_cast<double>(compared);
    light.error.mean_absolute = light.error.wrong_fraction;
    light.texel_world = {0.01, 0.0125, 0.02};
    light.bias_texel_world = 0.0125;
  }
  std::string verdict() const { return verdict_on(made->comparison, light).whole(); }
};

TEST(Verdict, SaysHowManyWhyAndWhatWouldHelp) {
  Case c(100000, {3900, 0, 0, 0, 200, 0, 0, 0, 0, 0});
  c.light.best_bias = {0.01, 0.006, true, 0.005, 0.02, 0, 0};
  EXPECT_EQ(c.verdict(),
            "Shadow error 4.1 % of the pixels, mostly acne. Try --slope-bias 1 --bias 0.01: 0.6 % wrong "
            "(a bias of 0.8 texel).");
  EXPECT_EQ(verdict_on(c.made->comparison, c.light).detail, "");
}

// No bias and no size of the map helps where the window ends before the shadows do.
TEST(Verdict, AsksForALargerWindowWhereMostIsLostOutsideIt) {
  constexpr std::size_t outside = static_cast<std::size_t>(Label::outside_map) - 1;
  std::array<std::uint64_t, class_count> classes{100};
  classes[outside] = 3900;
  Case c(100000, classes);
  c.light.best_bias = {0.01, 0.006, true, 0.005, 0.02, 0, 0};
  EXPECT_EQ(c.verdict().find("window"), std::string::npos) << "of a fitted map";
  c.made->comparison.raster.options.map.window.size = {.values = {6.0, 4.0}, .count = 2};
  EXPECT_NE(c.verdict().find("Give the light a larger window: 3.9 % of the pixels miss their shadow"),
            std::string::npos)
      << c.verdict();
  classes = {3900}, classes[outside] = 100;
  Case other(100000, classes);
  other.made->comparison.raster.options.map.window.size = {.values = {6.0, 4.0}, .count = 2};
  EXPECT_EQ(other.verdict().find("larger window"), std::string::npos) << other.verdict();
}

TEST(Verdict, BeginsWithTheMeasureThatWasChosen) {
  Case c(100000, {3900, 0, 0, 0, 200, 0, 0, 0, 0, 0});
  c.light.error.flip = 0.0774, c.light.edges.rms_texels = 1.7;
  const auto begins = [&](const char* measure) {
    c.made->comparison.measure = find_measure(measure);
    return verdict_on(c.made->comparison, c.light).error;
  };
  EXPECT_EQ(begins("wrong"), "Shadow error 4.1 % of the pixels, mostly acne.");
  EXPECT_EQ(begins("mean"), "Shadow error 4.1 % on average, mostly acne; 4.1 % wrong.");
  EXPECT_EQ(begins("flip"), "Shadow error: mean FLIP 0.0774; 4.1 % of the pixels wrong, mostly acne.");
  EXPECT_EQ(begins("edge"),
            "Shadow error: edges off by 1.7 texels (RMS); 4.1 % of the pixels wrong, mostly acne.");
  c.light.error.fractional = 50000;
  EXPECT_EQ(begins("wrong"), "Shadow error 4.1 % of the pixels, mostly acne.") << "of partly lit ones, too";
  c.light.error.wrong = 0, c.light.error.wrong_fraction = 0.0;
  EXPECT_EQ(begins("wrong"), "Shadow error: 0 % wrong; no pixel is off by more than one half.");
  c.light.error.ties = 2000, c.light.error.wrong_fraction = 0.01;
  EXPECT_EQ(begins("wrong"), "Shadow error: 1.0 % wrong; 2,000 pixels are off by exactly one half.");
}

/// A setting that was drawn, and what it left of a light.
TriedSetting tried(const Case& c, const raster::MapOptions& map, double wrong, double mean) {
  LightFigures left = c.light;
  left.error.wrong_fraction = wrong, left.error.mean_absolute = mean;
  return {map, {left}};
}
raster::MapOptions of_size(const Case& c, int size) {
  raster::MapOptions map = c.made->comparison.raster.options.map;
  map.size = size;
  return map;
}
int drawn_size(const Case& c) {
  return c.made->comparison.raster.options.map.size;
}

// What nobody knows without drawing it is not advised, nor are wrong pixels counted where something else was asked for.
TEST(Verdict, AdvisesByTheMeasureThatWasChosen) {
  Case c(100000, {3900, 0, 0, 0, 200, 0, 0, 0, 0, 0});
  c.light.best_bias = {0.01, 0.006, false, 0.005, 0.02, 7, 9};
  c.light.error.flip = 0.0774, c.light.edges.rms_texels = 1.7;
  const int twice = 2 * drawn_size(c);
  c.made->comparison.tried = {tried(c, of_size(c, twice), 0.022, 0.022)};
  const auto advice = [&](const char* measure) {
    c.made->comparison.measure = find_measure(measure);
    const Verdict verdict = verdict_on(c.made->comparison, c.light);
    return joined_sentences({verdict.advice, verdict.detail});
  };
  const std::string bias = " Try --slope-bias 1 --bias 0.01: ",
                    why =
                        " No constant bias beside the slope bias of 1 fits all: 7 lit "
                        "pixels stay dark below "
                        "0.4 texel, and 9 shadowed pixels are lit from 1.6 texels on.";
  EXPECT_EQ(
      advice("wrong"),
      fmt::format("Try --map-size {}: 2.2 % wrong.{}0.6 % wrong (a bias of 0.8 texel).{}", twice, bias, why));
  EXPECT_EQ(advice("mean"),
            fmt::format("Try --map-size {}: mean error 2.2 %.{}mean error 0.6 % (a bias of 0.8 texel).{}",
                        twice, bias, why));
  EXPECT_EQ(advice("flip"), "") << "the drawing leaves as much";
  c.made->comparison.tried[0].lights[0].error.flip = 0.05;
  EXPECT_EQ(advice("flip"), fmt::format("Try --map-size {}: mean FLIP 0.05.", twice));
  c.made->comparison.tried.clear();
  for (const auto& [name, words] : {std::pair{"flip", "FLIP"}, std::pair{"edge", "edge error"}})
    EXPECT_EQ(advice(name), fmt::format("Only drawings tell what another bias or map does to the {}: gnomon "
                                        "tune --max-error {}:LIMIT makes them.",
                                        words, name));
  c.light.error.flip = 0.0;
  EXPECT_EQ(advice("flip"), "") << "nothing is to be mended";
  c.light.error.fractional = 500, c.light.error.mean_absolute = 0.041;
  EXPECT_EQ(advice("wrong"), why.substr(1)) << "gaps do not tell the mean error";
  EXPECT_EQ(advice("mean"), "");
}

// What is worse in the share or in the mean is not advised, whatever it does to the other.
TEST(Verdict, AdvisesNothingThatIsWorseInTheMean) {
  Case c(100000, {3900, 0, 0, 0, 200, 0, 0, 0, 0, 0});
  c.made->comparison.raster.options.map.technique = raster::Technique::pcf;
  c.light.error.fractional = 5000;
  raster::MapOptions map = c.made->comparison.raster.options.map;
  map.bias = {.constant = 0.5, .unit = raster::BiasUnit::texel, .slope = 3.0};
  c.made->comparison.tried = {tried(c, map, 0.001, 0.03)};
  EXPECT_NE(c.verdict().find("Try --slope-bias 3 --bias 0.5texel: 3.0 % on average, 0.1 % wrong."),
            std::string::npos)
      << c.verdict();
  c.made->comparison.tried = {tried(c, map, 0.001, 0.042)};
  EXPECT_EQ(c.verdict().find("Try "), std::string::npos) << c.verdict();
  c.made->comparison.tried = {tried(c, map, 0.042, 0.001)};
  EXPECT_EQ(c.verdict().find("Try "), std::string::npos) << c.verdict();
}

TEST(Verdict, SaysWhenNoBiasCanBeRight) {
  Case c(100000, {4100, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  c.made->comparison.raster.options.map.bias.slope = 0.0;
  c.light.best_bias = {0.02, 0.041, false, 0.031, 0.012, 213, 97};
  EXPECT_EQ(c.verdict(),
            "Shadow error 4.1 % of the pixels, all of them acne. No other constant bias does better. No "
            "constant bias "
            "fits all: 213 lit pixels stay dark below 2.5 texels, and 97 shadowed pixels are lit from 0.96 "
            "texel on.");
  const auto reason = [&](double needs_more_than, double needs_less_than) {
    c.light.best_bias.needs_more_than = needs_more_than, c.light.best_bias.needs_less_than = needs_less_than;
    return verdict_on(c.made->comparison, c.light).detail;
  };
  EXPECT_EQ(reason(1e-4, 1.55e-5),
            "No constant bias fits all: 213 lit pixels stay dark below 0.01 texel, and 97 shadowed pixels "
            "are lit from "
            "0.01 texel on.");
  const std::string lit_anyway = "Bias cannot fix the rest: 97 shadowed pixels are lit even at bias 0.";
  EXPECT_EQ(reason(0.031, -5.01e-6), lit_anyway);
  EXPECT_EQ(reason(-1e-6, -5.01e-6), lit_anyway);
  EXPECT_EQ(reason(0.031, -infinity),
            "Bias cannot fix the rest: some shadowed pixels find no caster in the map.");
}

// The constants are tried with what else the drawing's bias has.
TEST(Verdict, SaysBesideWhatNoConstantCanBeRight) {
  Case c(100000, {4100, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  c.light.best_bias = {0.02, 0.041, false, 0.031, 0.012, 213, 97};
  const std::pair<raster::Bias, std::string> cases[] = {
      {{.slope = 1.5}, "No constant bias beside the slope bias of 1.5 fits all: 213 lit"},
      {{.normal_offset_texels = 2.0}, "No constant bias beside the normal offset of 2 texels fits all"},
      {{.receiver_plane = true}, "No constant bias beside the receiver's plane fits all"},
      {{.adaptive = true}, "No constant bias beside the adaptive bias fits all"},
      {{.slope = 1.0, .receiver_plane = true},
       "No constant bias beside the other parts of the bias fits all"}};
  for (const auto& [bias, words] : cases) {
    c.made->comparison.raster.options.map.bias = bias;
    EXPECT_NE(c.verdict().find(words), std::string::npos) << c.verdict();
  }
}

TEST(Verdict, OffersNoBiasWhoseGainNoFigureShows) {
  Case c(100000, {1600, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  c.light.best_bias = {3.67e-6, 0.01559, true, 0.0, 1.0, 0, 0};
  const std::string wrong = "Shadow error 1.6 % of the pixels, all of them acne.";
  EXPECT_EQ(c.verdict(), wrong + " No other constant bias does clearly better.");
  c.light.best_bias.wrong_fraction = 0.0154;  // written as 1.5 %, and hardly less
  EXPECT_EQ(c.verdict(), wrong + " No other constant bias does clearly better.");
  c.light.best_bias.wrong_fraction = 0.0151;
  EXPECT_EQ(c.verdict(), wrong + " Try --slope-bias 1 --bias 3.67e-06: 1.5 % wrong.");
  BiasKind slope, constant;
  slope.name = "slope bias", slope.of_slope = true, slope.bias.slope = 1.0, slope.wrong_fraction = 0.01555;
  constant.name = "constant bias", constant.wrong_fraction = 0.0156;
  c.light.bias_kinds = {slope, constant};
  EXPECT_EQ(c.verdict(), wrong + " No other bias does clearly better.");
  c.light.bias_kinds[0].wrong_fraction = 0.0101;
  EXPECT_NE(c.verdict().find(" 1.0 % wrong. With a constant bias alone: 1.6 % wrong."), std::string::npos)
      << c.verdict();
  c.light.bias_kinds[0].wrong_fraction = 0.0107, c.light.bias_kinds[1].wrong_fraction = 0.0114;
  EXPECT_EQ(c.verdict().find("alone"), std::string::npos) << c.verdict();
}

TEST(Verdict, LeavesReasonsToItsDetail) {
  Case c(100000, {1600, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  c.light.pixels.uncertain = 100;
  c.light.best_bias = {0.01, 0.0151, false, 0.031, 0.012, 213, 97};
  BiasKind slope, constant;
  slope.name = "slope bias", slope.of_slope = true, slope.bias.slope = 1.0, slope.wrong_fraction = 0.0101;
  constant.name = "constant bias", constant.wrong_fraction = 0.0156;
  c.light.bias_kinds = {slope, constant};
  const Verdict verdict = verdict_on(c.made->comparison, c.light);
  EXPECT_EQ(
      verdict.headline(),
      "Shadow error 1.6 % of the pixels, all of them acne. Try --slope-bias 1 --bias auto: 1.0 % wrong.");
  EXPECT_EQ(
      verdict.detail,
      "100 more (0.1 %) are uncertain: the truth there lies within its own error bound. With a constant "
      "bias alone: 1.6 % wrong. No constant bias beside the slope bias of 1 fits all: 213 lit pixels stay "
      "dark below "
      "2.5 texels, and 97 shadowed pixels are lit from 0.96 texel on.");
}

TEST(Verdict, OffersAnotherRenderersSettingOnlyForAGain) {
  Case c(100000, {1600, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  auto judged = std::make_shared<Judged>();
  judged->advice = {Advice{{"bias.constant_depth", 0.0, 0.5, "stored depth"}, 0.016, 0.002, false}};
  c.made->comparison.judged = judged;
  EXPECT_NE(c.verdict().find(" Try bias.constant_depth 0.5 instead of 0: 0.2 % wrong."), std::string::npos)
      << c.verdict();
  for (const double left : {0.0159, 0.016, 0.02}) {
    judged->advice[0].wrong_instead = left;
    EXPECT_EQ(c.verdict().find("Try "), std::string::npos) << c.verdict();
  }
  judged->advice[0] = Advice{{"bias.normal_offset_world", 0.3, 0.1, "world units"},
                             0.016,
                             0.002,
                             false,
                             AdvisedSetting{"bias.constant_depth", 0.0, 0.5, "stored depth"}};
  EXPECT_NE(c.verdict().find(
                " Try bias.normal_offset_world 0.1 instead of 0.3 and bias.constant_depth 0.5 instead of 0: "
                "0.2 % wrong."),
            std::string::npos)
      << c.verdict();
}

TEST(Verdict, SaysAboutOfAnEstimateForAnotherRenderer) {
  Case c(100000, {1600, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  auto judged = std::make_shared<Judged>();
  judged->advice = {Advice{{"bias.constant_depth", 0.0, 0.5, "stored depth"}, 0.016, 0.002, false}};
  judged->advice[0].about = true;
  c.made->comparison.judged = judged;
  EXPECT_NE(c.verdict().find(" Try bias.constant_depth 0.5 instead of 0: about 0.2 % wrong."),
            std::string::npos)
      << c.verdict();
  // A smaller share of wrong pixels for a larger mean error is no gain.
  judged->advice[0].mean_now = 0.016, judged->advice[0].mean_instead = 0.017;
  EXPECT_EQ(c.verdict().find("Try "), std::string::npos) << c.verdict();
}

TEST(Verdict, AsksForAKindOfBiasByItsOptions) {
  Case c(100000, {4000, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  c.light.best_bias.feasible = true;
  BiasKind kind;
  kind.name = "normal offset", kind.wrong_fraction = 0.01;
  const std::pair<raster::Bias, std::string> cases[] = {
      {{.constant = 0.4, .unit = raster::BiasUnit::world, .normal_offset_texels = 1.0},
       " Try --slope-bias 0 --normal-offset 1 --bias 0.4: 1.0 % wrong (a bias of 32 texels)."},
      {{.constant = 0.0, .unit = raster::BiasUnit::world}, " Try --slope-bias 0 --bias 0: 1.0 % wrong."},
      {{.constant = 0.0, .unit = raster::BiasUnit::texel},
       " Try --slope-bias 0 --bias 0texel: 1.0 % wrong."}};
  for (const auto& [bias, words] : cases) {
    kind.bias = bias;
    c.light.bias_kinds = {kind};
    EXPECT_NE(c.verdict().find(words), std::string::npos) << c.verdict();
  }
}

// The drawing has the slope bias that would be recommended: only its constant is to change.
TEST(Verdict, NamesTheConstantWhereTheSlopeBiasIsSetAlready) {
  Case c(100000, {4000, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  c.light.best_bias.feasible = true;
  raster::Bias& drawn = c.made->comparison.raster.options.map.bias;
  drawn = {.constant = 0.0, .unit = raster::BiasUnit::world, .slope = 1.0};
  BiasKind slope, constant;
  slope.name = "slope bias", slope.of_slope = true, slope.wrong_fraction = 0.01;
  slope.bias = {.constant = 1.0, .unit = raster::BiasUnit::automatic, .slope = 1.0};
  slope.from = 0.8, slope.to = infinity;
  constant.name = "constant bias", constant.wrong_fraction = 0.01;
  constant.bias = {.constant = 1.0, .unit = raster::BiasUnit::automatic};
  c.light.bias_kinds = {slope, constant};
  EXPECT_NE(c.verdict().find(" Try --slope-bias 1 --bias auto: 1.0 % wrong."), std::string::npos)
      << c.verdict();
  EXPECT_EQ(c.verdict().find("about as well"), std::string::npos) << c.verdict();
  drawn = {.constant = 0.0, .unit = raster::BiasUnit::world, .slope = 0.5};
  EXPECT_NE(c.verdict().find(" Any slope bias from 0.8 on does about as well."), std::string::npos)
      << c.verdict();
  // Nor is a slope bias recommended that is neither set nor needed.
  drawn.slope = c.light.bias_kinds[0].from = 0.0;
  EXPECT_NE(c.verdict().find(" Try --bias auto: 1.0 % wrong."), std::string::npos) << c.verdict();
}

TEST(Verdict, NamesTheSmallerConstantOfAPlateau) {
  Case c(100000, {4100, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  c.light.best_bias = {0.5, 0.01, true, 0.4, 0.7, 0, 0};
  c.light.best_bias.smaller = {0.01, 0.0101};
  EXPECT_NE(c.verdict().find(" Try --slope-bias 1 --bias 0.01: 1.0 % wrong (a bias of 0.8 texel)."),
            std::string::npos)
      << c.verdict();
}

TEST(Verdict, SaysNothingOfABiasWhoseCurveIsWithheld) {
  Case c(100000, {3900, 0, 0, 0, 200, 0, 0, 0, 0, 0});
  c.made->comparison.raster.options.map.technique = raster::Technique::pcf;
  c.light.bias_curve_withheld = "It filters.";
  EXPECT_EQ(c.verdict(), "Shadow error 4.1 % of the pixels, mostly acne.");
}

TEST(Verdict, HandlesNoneFewAndNothing) {
  Case none(5000, {});
  none.light.best_bias = {0.01, 0.0, true, -infinity, infinity, 0, 0};
  EXPECT_EQ(none.verdict(), "No shadow error: all 5,000 pixels compared are right.");
  Case single(1, {});
  single.light.best_bias = none.light.best_bias;
  EXPECT_EQ(single.verdict(), "No shadow error: the one pixel compared is right.");
  Case one(1000000, {0, 0, 0, 0, 1, 0, 0, 0, 0, 0});
  one.light.best_bias = {0.02, 0.0, true, 0.01, 0.03, 0, 0};
  EXPECT_EQ(one.verdict(), "Shadow error in 1 of 1,000,000 pixels, aliasing.")
      << "a bias that lights it has lifted a shadow";
  Case split(1000, {10, 0, 12, 0, 5, 5, 0, 0, 0, 0});
  split.light.best_bias = {0.01, 0.032, true, 0, 1, 0, 0};
  EXPECT_NE(split.verdict().find("mainly peter-panning and acne."), std::string::npos) << split.verdict();
  Case nothing(1, {});
  nothing.light.pixels = {100, 60, 30, 8, 2, 0};
  EXPECT_EQ(nothing.verdict(),
            "No pixel could be compared: of 100, 60 show no surface, 30 face away from the light, 8 are "
            "silhouettes and 2 are uncertain.");
  nothing.made->scene.lights[nothing.light.light].type = LightType::spot;
  EXPECT_NE(nothing.verdict().find("30 face away from the light or lie outside its cone, 8 are"),
            std::string::npos)
      << nothing.verdict();
}

// Of many biases the best one mends two pixels of nine by chance.
TEST(Verdict, AdvisesNothingThatChanceExplains) {
  Case few(43000, {9, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  few.light.best_bias = {0.57, 7.0 / 43000.0, false, 0.6, 1e-9, 7, 2};
  EXPECT_EQ(few.verdict().find("Try "), std::string::npos) << few.verdict();
  EXPECT_NE(few.verdict().find("No other constant bias does clearly better."), std::string::npos)
      << few.verdict();
  few.light.best_bias.wrong_fraction = 1.0 / 43000.0;
  EXPECT_NE(few.verdict().find("Try "), std::string::npos) << few.verdict();
}

// Pixels whose texel lies elsewhere come right with any bias that lifts the shadow off its caster: that mends nothing.
TEST(Verdict, AdvisesNoConstantThatLiftsMoreThanItMends) {
  Case c(100000, {100, 0, 0, 0, 900, 0, 0, 0, 0, 0});
  c.light.best_bias = {20.0, 0.001, false, 20.0, 1e-9, 7, 2};
  EXPECT_EQ(c.verdict().find("Try "), std::string::npos) << c.verdict();
  c.light.best_bias.wrong_fraction = 0.0091;
  EXPECT_NE(c.verdict().find("Try "), std::string::npos) << c.verdict();
}

TEST(Verdict, LeadsWithTheMeanErrorWhereSomethingIsPartlyLit) {
  Case grey(5000, {});
  grey.light.error.fractional = 4000;
  grey.light.error.mean_absolute = 0.35;
  grey.light.best_bias = {0.01, 0.0, true, -infinity, infinity, 0, 0};
  EXPECT_EQ(grey.verdict(), "Shadow error 35.0 % on average; no pixel is off by more than one half.");
  grey.light.class_errors[static_cast<std::size_t>(Label::acne) - 1] = 0.35;
  EXPECT_EQ(grey.verdict(),
            "Shadow error 35.0 % on average, all of it acne; no pixel is off by more than one half.");
  grey.light.class_errors[static_cast<std::size_t>(Label::acne) - 1] = 0.2;
  grey.light.class_errors[static_cast<std::size_t>(Label::blur) - 1] = 0.15;
  EXPECT_NE(grey.verdict().find("average, mostly acne; no pixel"), std::string::npos) << grey.verdict();
  Case soft(5000, {0, 0, 0, 0, 100, 0, 0, 0, 0, 0});
  soft.light.error.fractional = 900;
  soft.light.error.mean_absolute = 0.03;
  soft.light.best_bias = {0.01, 0.02, true, 0, 1, 0, 0};
  EXPECT_EQ(soft.verdict(), "Shadow error 3.0 % on average, all of it aliasing; 2.0 % wrong.");
  soft.light.error.ties = 50, soft.light.error.wrong_fraction = 0.025;
  EXPECT_NE(soft.verdict().find("; 2.5 % wrong."), std::string::npos) << soft.verdict();
  soft.light.error.wrong = 0, soft.light.error.ties = 1, soft.light.error.wrong_fraction = 1e-4;
  EXPECT_NE(soft.verdict().find("; 1 pixel is off by exactly one half."), std::string::npos)
      << soft.verdict();
  // One meaning: what is told of the light as drawn is what would be told of a setting that leaves as much.
  Case fine(100000, {3});
  fine.light.error.fractional = 900, fine.light.error.ties = 3, fine.light.error.wrong_fraction = 4.5e-5;
  EXPECT_NE(fine.verdict().find("; 5 pixels wrong."), std::string::npos) << fine.verdict();
  fine.made->comparison.measure = find_measure("wrong");
  EXPECT_NE(fine.verdict().find("in 5 of 100,000 pixels, acne."), std::string::npos) << fine.verdict();
}

TEST(Verdict, NamesASoftTechniqueWhereTheLightsSizeIsMostOfTheError) {
  Case c(5000, {0, 0, 0, 0, 0, 0, 0, 0, 100, 0});
  c.light.error.fractional = 900;
  c.light.error.mean_absolute = 0.03;
  c.light.best_bias = {0.01, 0.01, false, 0.031, 0.012, 213, 97};
  c.light.budget = {};
  BudgetStep& size = c.light.budget[static_cast<std::size_t>(Cause::light_size)];
  size.absolute_mean = 0.015;
  const std::string cause = "The error is mostly the light's size, which no bias mends.";
  const auto says_so = [&] { return c.verdict().find(cause) != std::string::npos; };
  EXPECT_NE(c.verdict().find("Shadow error 3.0 % on average, all of it light size; 2.0 % wrong. " + cause),
            std::string::npos)
      << c.verdict();
  EXPECT_EQ(c.verdict().find("Try "), std::string::npos) << "nothing was drawn";
  raster::RasterFrame& drawn = c.made->comparison.raster;
  raster::MapOptions soft = drawn.options.map;
  soft.technique = raster::Technique::pcss;
  c.made->comparison.tried = {tried(c, soft, 0.001, 0.009)};
  EXPECT_NE(c.verdict().find("Try --technique pcss: 0.9 % on average, 0.1 % wrong. " + cause),
            std::string::npos)
      << c.verdict();
  c.made->comparison.tried = {tried(c, soft, 0.001, 0.031)};
  EXPECT_EQ(c.verdict().find("Try "), std::string::npos) << c.verdict();
  drawn.options.map.technique = raster::Technique::pcss;
  EXPECT_FALSE(says_so());
  drawn.options.map.technique = raster::Technique::pcf;
  EXPECT_TRUE(says_so());
  drawn.options.map.technique = raster::Technique::hard;
  size.absolute_mean = 0.0149;
  EXPECT_FALSE(says_so());
  size.absolute_mean = 0.0601;  // a filter made up for more than half of it
  EXPECT_FALSE(says_so());
  size.absolute_mean = 0.02;
  BudgetStep& filter = c.light.budget[static_cast<std::size_t>(Cause::filter)];
  filter.absolute_mean = 0.021;  // blurs more than the light does
  EXPECT_FALSE(says_so());
  filter.absolute_mean = 0.019;
  EXPECT_TRUE(says_so());
  c.light.class_errors[static_cast<std::size_t>(Label::blur) - 1] = 101.0 / 5000.0;
  EXPECT_FALSE(says_so());
}

// A larger map has to leave a fifth less; a smaller one has to have fine edges, wherever they are among how much ground.
TEST(Verdict, AdvisesTheMapsSize) {
  Case c(100000, {0, 0, 0, 0, 4000, 0, 0, 0, 0, 0});
  c.light.best_bias = {0.01, 0.04, true, 0.0, 1.0, 0, 0};
  const auto advice = [&](int size, double left) {
    c.made->comparison.tried = {tried(c, of_size(c, size), left, left)};
    return verdict_on(c.made->comparison, c.light).advice;
  };
  const int drawn = drawn_size(c);
  EXPECT_EQ(advice(2 * drawn, 0.022), fmt::format("Try --map-size {}: 2.2 % wrong.", 2 * drawn));
  EXPECT_EQ(advice(2 * drawn, 0.033), "No other constant bias does better.");
  c.light.edges.edges = 2000, c.light.edges.rms_pixels = 0.31;
  EXPECT_EQ(
      advice(drawn / 2, 0.003),
      fmt::format(
          "A map of {0} would do (--map-size {0}): its shadow edges are off by 0.31 pixel, 0.3 % wrong.",
          drawn / 2));
  EXPECT_EQ(advice(drawn / 2, 0.006), "No other constant bias does better.") << "the mean";
  c.light.edges.rms_pixels = 0.5;
  EXPECT_EQ(advice(drawn / 2, 0.003), "No other constant bias does better.") << "a saw";
  c.light.edges.rms_pixels = 0.31, c.light.edges.edges = 500;
  EXPECT_EQ(advice(drawn / 2, 0.003), "No other constant bias does better.")
      << "what the map lacks has no edge";
}

TEST(Verdict, CountsWhatIsUncertain) {
  Case c(5000, {});
  c.light.pixels.uncertain = 15000;
  c.light.best_bias = {0.01, 0.0, true, -infinity, infinity, 0, 0};
  EXPECT_EQ(c.verdict(),
            "No shadow error: all 5,000 pixels compared are right. 15,000 more (75.0 %) are "
            "uncertain: the truth there lies within its own error bound.");
}

}  // namespace
}  // namespace gnomon::compare
