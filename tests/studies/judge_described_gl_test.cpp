// What is said of the test that a capture describes: which bias would have been better, and where the map or the test
// is not that of the picture.
#include <fmt/ranges.h>

#include "compare/result/judged.h"
#include "compare/result/verdict.h"
#include "scene/files/pictures/image_io.h"
#include "tests/support/capture_support.h"

namespace gnomon::test {
namespace {

using judge::Capture;
using judge::StoredDepth;

/// A sun's map of 512 texels and the picture that another renderer draws on it with this bias.
struct OtherPicture {
  Compared drawn = draw_scene(scene_under("sun"), small_picture, hard_map(512));
  Capture capture;
  OtherPicture(const std::string& name, const judge::CapturedBias& bias) {
    capture = self_capture(drawn, folder_for(name), {.map = true, .stored = StoredDepth::zero_to_one});
    draw_with(bias);
  }
  void draw_with(const judge::CapturedBias& bias, const FilterTaps& filter = {}) {
    capture.bias = bias;
    draw_again(capture, drawn, 1.0f, false, filter);
  }
  JudgeOutcome judged() const { return judge(capture, *drawn.scene); }
};

/// The bias that the advice asks for.
judge::CapturedBias advised(const Capture& capture, const std::vector<compare::Advice>& advice) {
  judge::CapturedBias bias = *capture.bias;
  const compare::Advice& last = advice.back();
  (last.setting == "bias.normal_offset_world" ? bias.normal_offset_world : bias.constant_depth) =
      last.instead;
  if (last.with) bias.constant_depth = last.with->instead;
  return bias;
}

// A normal offset of many texels moves the shadows' edges: without it, or with less, a constant does better.
TEST(JudgeAdvice, LowersANormalOffsetThatIsTooLarge) {
  OtherPicture picture("offset", {.constant_depth = 0.0002, .normal_offset_world = 0.3});
  const JudgeOutcome judged = picture.judged();
  ASSERT_TRUE(judged.result) << reason(judged);
  const std::vector<compare::Advice>& advice = judged.result->judged->advice;
  ASSERT_FALSE(advice.empty());
  const compare::Advice& pair = advice.back();
  ASSERT_TRUE(pair.with.has_value()) << "what is set together is one line with one figure";
  EXPECT_EQ(pair.with->setting, "bias.constant_depth");
  EXPECT_EQ(pair.setting, "bias.normal_offset_world");
  EXPECT_LT(pair.instead, 0.15);
  EXPECT_LT(pair.wrong_instead, 0.5 * judged.result->lights[0].error.wrong_fraction);
  EXPECT_NE(compare::verdict_on(*judged.result, judged.result->lights[0])
                .headline()
                .find("bias.normal_offset_world"),
            std::string::npos);
  // What the advice promises is what the other renderer then draws.
  picture.draw_with(advised(picture.capture, advice));
  const JudgeOutcome again = picture.judged();
  ASSERT_TRUE(again.result) << reason(again);
  EXPECT_NEAR(again.result->lights[0].error.wrong_fraction, pair.wrong_instead, 2e-4);
}

// The same numbers by the names of the engine that drew, which its own name says, or --engine.
TEST(JudgeAdvice, SpeaksInTheEnginesSettings) {
  OtherPicture picture("engine", {.constant_depth = 0.0002, .normal_offset_world = 0.3});
  const auto advised_of = [&](const char* renderer, const compare::TunedEngine* engine) {
    judge::Capture capture = picture.capture;
    capture.renderer = renderer;
    judge::JudgeOptions options;
    options.engine = engine;
    const JudgeOutcome judged = judge(capture, *picture.drawn.scene, options);
    EXPECT_TRUE(judged.result) << reason(judged);
    return judged.result->judged->advice.back();
  };
  const compare::Advice three = advised_of("three.js", nullptr);
  ASSERT_EQ(three.in_engine.size(), 2U);
  EXPECT_EQ(three.in_engine[0].first, "shadow.bias");
  EXPECT_NEAR(three.in_engine[0].second, -three.with->instead, 1e-12);
  EXPECT_EQ(three.in_engine[1].first, "shadow.normalBias");
  EXPECT_NEAR(three.in_engine[1].second, three.instead, 1e-12);
  const compare::Advice bevy = advised_of("three.js", compare::find_engine("bevy"));
  ASSERT_EQ(bevy.in_engine.size(), 2U);
  EXPECT_EQ(bevy.in_engine[0].first, "shadow_depth_bias");
  EXPECT_NEAR(bevy.in_engine[0].second, bevy.with->instead * bevy.with->unit_world, 1e-12);
  EXPECT_NEAR(bevy.in_engine[1].second, bevy.instead / bevy.texel_world, 1e-9) << "texels";
  EXPECT_TRUE(advised_of("mine", nullptr).in_engine.empty());
}

// ---- the test that was drawn ----

std::string notes_of(const JudgeOutcome& judged) {
  return judged.result ? fmt::format("{}", fmt::join(judged.result->judged->notes, "\n")) : reason(judged);
}

std::uint64_t count_of(const JudgeOutcome& judged, compare::Label label) {
  return judged.result->lights[0].classes[static_cast<std::size_t>(label) - 1];
}

constexpr judge::CapturedBias enough_bias{.constant_depth = 0.001};

void turn_rows(Capture& capture) {
  judge::RowOrder& rows = *capture.map[0].rows;
  rows = rows == judge::RowOrder::top_down ? judge::RowOrder::bottom_up : judge::RowOrder::top_down;
}

/// That the test described is not the one drawn is said, with this in it, and no reason is given that would be that of
/// another test. Nor is advice, unless the constant alone is another.
void expect_other_test(const JudgeOutcome& judged, const std::string& named, bool advice = false) {
  ASSERT_TRUE(judged.result) << reason(judged);
  EXPECT_NE(notes_of(judged).find("is not the one that was drawn"), std::string::npos) << notes_of(judged);
  EXPECT_NE(notes_of(judged).find(named), std::string::npos) << notes_of(judged);
  EXPECT_EQ(judged.result->judged->advice_sought, advice);
  EXPECT_TRUE(advice || judged.result->judged->advice.empty());
  EXPECT_LT(double(count_of(judged, compare::Label::stored_depth)),
            1e-3 * double(judged.result->lights[0].pixels.compared));
}

TEST(JudgeDescribed, MapReadUpsideDownIsTheRenderersDoing) {
  OtherPicture picture("upside", enough_bias);
  turn_rows(picture.capture);
  picture.draw_with(enough_bias);
  turn_rows(picture.capture);
  const JudgeOutcome judged = picture.judged();
  expect_other_test(judged, "if the renderer reads its map upside down");
  EXPECT_GT(count_of(judged, compare::Label::unexplained), judged.result->lights[0].error.wrong / 2);
}

TEST(JudgeDescribed, RowsOfTheOtherOrderAreTheCapturesDoing) {
  OtherPicture picture("rows", enough_bias);
  turn_rows(picture.capture);
  expect_other_test(picture.judged(), "if `rows` of the map is the other one");
}

TEST(JudgeDescribed, BiasOfTheOtherSignIsNamed) {
  OtherPicture picture("sign", {.constant_depth = 0.0001});  // the other sign leaves some of it lit
  picture.capture.bias->constant_depth *= -1.0;
  expect_other_test(picture.judged(), "if `constant_depth` has the other sign", true);
  picture.draw_with(*picture.capture.bias);
  picture.capture.bias->constant_depth *= -1.0;
  expect_other_test(picture.judged(), "if the renderer applies its bias with the other sign");
}

TEST(JudgeDescribed, OtherMatricesAndConstantsAreNamed) {
  OtherPicture picture("matrix", enough_bias);
  const Capture right = picture.capture;
  Mat4& matrix = *picture.capture.map[0].clip_from_world;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 2; ++row) matrix[column][row] = 0.5 * (matrix[column][row] + matrix[column][3]);
  expect_other_test(picture.judged(),
                    "if `clip_from_world` holds the scale and shift to texture coordinates");
  // With the depths' scale and shift, too: three.js' shadow.matrix, said to make depths of -1 to 1.
  picture.capture.map[0].convention = StoredDepth::minus_one_to_one;
  expect_other_test(
      picture.judged(),
      "if `clip_from_world` holds the scale and shift to texture coordinates, and the matrix makes "
      "depths of 0 to 1");
  picture.capture = right;
  picture.capture.map[0].convention = StoredDepth::minus_one_to_one;
  expect_other_test(picture.judged(), "if the matrix makes depths of 0 to 1");
  picture.capture = right;
  picture.capture.bias->constant_depth = 0.2;
  expect_other_test(picture.judged(), "if `constant_depth` is about", true);
}

// All is dark then, as it would be without light.
TEST(JudgeDescribed, ABiasOfTheOtherSignIsNotTheLightsDoing) {
  struct Case {
    judge::CapturedBias drawn, described;
    const char* words;
  };
  for (const Case& c : {Case{{.constant_depth = -0.02},
                             {.constant_depth = 0.02},
                             "the renderer applies its bias with the other sign"},
                        Case{{.slope = 0.0}, {.slope = 8.0}, "no slope bias is drawn"},
                        Case{{.constant_depth = 0.0002, .normal_offset_world = -0.1},
                             {.constant_depth = 0.0002, .normal_offset_world = 0.1},
                             "the renderer applies its normal offset with the other sign"}})
    for (const double strength : {1.0, 0.6}) {
      OtherPicture picture("dark", c.drawn);
      spoil(picture.capture.visibility, [&](ChannelImage& image) {
        for (float& v : image.channels[0].values)
          v = static_cast<float>(1.0 - strength + strength * double{v});
      });
      picture.capture.bias = c.described;
      expect_other_test(picture.judged(), std::string("if ") + c.words);
    }
}

TEST(JudgeDescribed, ASwappedComparisonIsNamed) {
  OtherPicture picture("swapped", {.constant_depth = 0.001});
  const auto swap = [&] {
    spoil(picture.capture.visibility, [](ChannelImage& image) {
      for (float& v : image.channels[0].values) v = 1.0f - v;
    });
  };
  swap();
  EXPECT_NE(reason(picture.judged()).find("1 for shadow and 0 for light, or its comparison is swapped"),
            std::string::npos)
      << reason(picture.judged());
  picture.draw_with({.constant_depth = -0.02}), swap();  // all is lit: the truth does not tell that it is
  expect_other_test(picture.judged(),
                    "if the picture has 1 for shadow and 0 for light, or the comparison is swapped");
}

// A floor and a sun: a factor of the angle is one number nearly everywhere.
TEST(JudgeDescribed, AnotherConstantIsThePlainestCause) {
  const double lit = -glm::normalize(scene_under("sun").lights[0].direction).y;
  for (const auto& [drawn, described] :
       {std::pair(0.02, 0.3), std::pair(0.001, 0.1), std::pair(0.02, 0.02 / (1.0 - lit)),
        std::pair(0.04, 0.04 / (1.0 - lit))}) {
    OtherPicture picture("constant", {.constant_depth = drawn});
    picture.capture.bias->constant_depth = described;
    expect_other_test(picture.judged(), "if `constant_depth` is about ", true);
  }
  // Nothing is dark: any that is larger draws it as well.
  OtherPicture picture("constant", {.constant_depth = 0.5});
  picture.capture.bias->constant_depth = 0.02;
  expect_other_test(picture.judged(), " or more, it is the one drawn in 100 %", true);
}

// ---- a filter that is described ----

// Each tap compares once with what the sampler reads between four texels, which texels by themselves do not tell.
TEST(JudgeDescribed, AFilterWhoseTapsReadBetweenTexels) {
  OtherPicture picture("between-taps", {.constant_depth = 0.0002});
  picture.capture.filter = judge::CapturedFilter{
      .kind = judge::FilterName::pcf, .radius_texels = 2.0, .read = judge::FilterRead::linear_depths};
  picture.draw_with(*picture.capture.bias, square_taps(3));
  const JudgeOutcome right = picture.judged();
  ASSERT_TRUE(right.result) << reason(right);
  EXPECT_GT(right.result->judged->biased_is_drawn, 0.995) << notes_of(right);
  EXPECT_EQ(notes_of(right).find("is not the one that was drawn"), std::string::npos) << notes_of(right);
  const std::vector<compare::Advice>& advice = right.result->judged->advice;
  ASSERT_FALSE(advice.empty());
  EXPECT_FALSE(advice.back().about);
  EXPECT_LT(advice.back().wrong_instead, right.result->lights[0].error.wrong_fraction);
  Capture texels = picture.capture;
  texels.filter->read = judge::FilterRead::nearest, texels.filter->radius_texels = 1.5;
  const JudgeOutcome faulty = judge(texels, *picture.drawn.scene);
  ASSERT_TRUE(faulty.result) << reason(faulty);
  EXPECT_LT(faulty.result->judged->biased_is_drawn, right.result->judged->biased_is_drawn - 0.002);
  EXPECT_TRUE(faulty.result->judged->advice.empty() || faulty.result->judged->advice.back().about);
  // What the advice promises is what the other renderer then draws.
  picture.draw_with(advised(picture.capture, advice), square_taps(3));
  const JudgeOutcome again = picture.judged();
  ASSERT_TRUE(again.result) << reason(again);
  EXPECT_NEAR(again.result->lights[0].error.wrong_fraction, advice.back().wrong_instead, 5e-4);
}

// ---- a filter that is not described ----

// One comparison leaves nothing partly lit, and its rounding makes no greys.
TEST(JudgeDescribed, GreysOfAnUnsaidFilterAreUnexplainedAndTheFilterIsNamed) {
  struct Case {
    FilterTaps taps;
    const char* words;
  };
  const FilterTaps disc{.taps = {{1.9, 0.3}, {-1.1, 1.2}, {0.2, -1.7}, {-1.8, -0.6}, {0.9, 1.6}, {0.1, 0.2}}};
  for (const Case& c :
       {Case{square_taps(3), "3 x 3 comparisons draw them (`filter.kind` pcf, `filter.radius_texels` 1.5)"},
        Case{square_taps(5), "5 x 5 comparisons draw them"},
        Case{square_taps(1, true), "1 x 1 comparisons, each of four texels, draw them"},
        Case{disc, "texels to each side would draw them"}}) {
    OtherPicture picture("greys", enough_bias);
    picture.draw_with(enough_bias, c.taps);
    const JudgeOutcome judged = picture.judged();
    ASSERT_TRUE(judged.result) << reason(judged);
    EXPECT_NE(notes_of(judged).find(c.words), std::string::npos) << notes_of(judged);
    EXPECT_EQ(notes_of(judged).find("; if "), std::string::npos) << notes_of(judged);
    const compare::LightComparison& light = judged.result->lights[0];
    std::size_t greys = 0;
    for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
      const float drawn = light.rungs[6].data[i];
      if (!compare::has_cause(light.labels.data[i]) || drawn < 0.05f || drawn > 0.95f) continue;
      ++greys;
      EXPECT_EQ(light.labels.data[i], compare::Label::unexplained) << label_name(light.labels.data[i]);
    }
    EXPECT_GT(greys, 100U);
    EXPECT_EQ(count_of(judged, compare::Label::stored_depth), 0U);
  }
}

// The filter that is said reaches less far than the one that draws.
TEST(JudgeDescribed, GreysBeyondTheSaidFilterAreUnexplained) {
  OtherPicture picture("wide-greys", {.constant_depth = 0.02});
  picture.draw_with({.constant_depth = 0.02}, square_taps(9));
  picture.capture.filter = judge::CapturedFilter{judge::FilterName::pcf, 1.5};
  const JudgeOutcome judged = picture.judged();
  ASSERT_TRUE(judged.result) << reason(judged);
  EXPECT_NE(notes_of(judged).find("9 x 9 comparisons draw them"), std::string::npos) << notes_of(judged);
  const compare::LightComparison& light = judged.result->lights[0];
  EXPECT_GT(light.class_errors[static_cast<std::size_t>(compare::Label::unexplained) - 1],
            0.2 * light.error.mean_absolute);
}

// A floor seen from its back: an offset along the front's normal goes into it, and it shadows itself.
TEST(JudgeDescribed, OffsetOfTheWrongSignOnBackFacesIsNamed) {
  Scene scene = scene_under("sun");
  for (auto& corners : scene.meshes[0].triangles) std::swap(corners[1], corners[2]);
  const Compared drawn = draw_scene(std::move(scene), small_picture, hard_map(512));
  Capture capture =
      self_capture(drawn, folder_for("back-faces"), {.map = true, .stored = StoredDepth::zero_to_one});
  capture.bias = judge::CapturedBias{.constant_depth = 0.0002, .normal_offset_world = 0.05};
  draw_again(capture, drawn);
  const JudgeOutcome right = judge(capture, *drawn.scene);
  EXPECT_EQ(notes_of(right).find("back faces"), std::string::npos) << notes_of(right);
  draw_again(capture, drawn, 1.0f, true);
  expect_other_test(judge(capture, *drawn.scene),
                    "if the renderer's normal offset has the wrong sign on back faces");
}

TEST(JudgeDescribed, MapReadMirroredIsTheRenderersDoing) {
  OtherPicture picture("mirrored", enough_bias);
  const auto mirror = [](ChannelImage& image) {
    std::vector<float>& values = image.channels[0].values;
    const auto n = static_cast<std::ptrdiff_t>(image.size.width);
    for (auto row = values.begin(); row != values.end(); row += n) std::reverse(row, row + n);
  };
  spoil(picture.capture.map[0].depth, mirror);
  picture.draw_with(enough_bias);
  spoil(picture.capture.map[0].depth, mirror);
  expect_other_test(picture.judged(), "if the renderer reads its map mirrored (u runs the other way)");
}

// A normal offset that the capture does not say moves edges by some pixels, and nothing usual explains it.
TEST(JudgeDescribed, WhatIsNotSaidIsUnexplained) {
  OtherPicture picture("unsaid", {.constant_depth = 0.001, .normal_offset_world = 0.2});
  picture.capture.bias->normal_offset_world = 0.0;
  const JudgeOutcome judged = picture.judged();
  expect_other_test(
      judged, "the wrong ones among them are unexplained, and advice leaves them as they were drawn", true);
  EXPECT_GT(count_of(judged, compare::Label::unexplained), 20U);
}

TEST(JudgeDescribed, RightCapturesAreNotDoubted) {
  const OtherPicture picture("described", enough_bias);
  raster::MapOptions soft = hard_map(512, raster::Technique::pcf);
  soft.filter.radius_texels = 2.5;
  const Compared filtered = draw_scene(scene_under("sun"), small_picture, soft);
  Capture capture = self_capture(filtered, folder_for("described-pcf"), {.map = true});
  capture.filter = judge::CapturedFilter{judge::FilterName::pcf, 2.5};
  for (const JudgeOutcome& judged : {picture.judged(), judge(capture, *filtered.scene)}) {
    EXPECT_EQ(notes_of(judged), "");
    ASSERT_TRUE(judged.result) << reason(judged);
    EXPECT_TRUE(judged.result->judged->advice_sought);
    EXPECT_EQ(count_of(judged, compare::Label::unexplained), 0U);
  }
}

// ---- what the map holds ----

// Rounded or truncated alike; what the numbers have in common is said.
TEST(JudgeDescribed, CoarseDepthsAreAMatterOfPrecision) {
  for (const bool truncated : {false, true}) {
    OtherPicture picture("coarse", enough_bias);
    spoil(picture.capture.map[0].depth, [truncated](ChannelImage& image) {
      for (float& v : image.channels[0].values)
        v = (truncated ? std::floor(255.0f * v) : std::round(255.0f * v)) / 255.0f;
    });
    picture.draw_with(enough_bias);
    const JudgeOutcome judged = picture.judged();
    EXPECT_NE(notes_of(judged).find("the map's depths are multiples of 1/255: eight bits"),
              std::string::npos);
    ASSERT_TRUE(judged.result) << reason(judged);
    EXPECT_GT(20 * count_of(judged, compare::Label::stored_depth), 19 * judged.result->lights[0].error.wrong);
    EXPECT_EQ(count_of(judged, compare::Label::unexplained), 0U);
  }
}

// ---- a map that covers a part of the picture ----

/// The middle of the map alone, each texel of it as several.
void crop_map(Capture& capture, int times) {
  judge::CapturedLayer& layer = capture.map[0];
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 2; ++row) (*layer.clip_from_world)[column][row] *= times;
  spoil(layer.depth, [=](ChannelImage& image) {
    std::vector<float>& texels = image.channels[0].values;
    const std::vector<float> from = texels;
    const auto n = static_cast<std::size_t>(image.size.width), part = static_cast<std::size_t>(times);
    const std::size_t first = n / 2 - n / (2 * part);
    for (std::size_t y = 0; y < n; ++y)
      for (std::size_t x = 0; x < n; ++x) texels[y * n + x] = from[(first + y / part) * n + first + x / part];
  });
}

// Most of the picture is then dark, and what is lit is right: the light does not shine the other way.
TEST(JudgeDescribed, DarknessBesideTheMapIsNoReversedLight) {
  OtherPicture picture("cropped", enough_bias);
  crop_map(picture.capture, 3);
  picture.capture.bias->constant_depth = 0.02;
  draw_again(picture.capture, picture.drawn, 0.0f);
  const JudgeOutcome judged = picture.judged();
  ASSERT_TRUE(judged.result) << reason(judged);
  const compare::LightComparison& light = judged.result->lights[0];
  EXPECT_GT(double(count_of(judged, compare::Label::outside_map)), 0.4 * double(light.pixels.compared));
  EXPECT_NE(notes_of(judged).find("lie outside the map"), std::string::npos) << notes_of(judged);
  EXPECT_EQ(judged.result->judged->notes.size(), 1U) << notes_of(judged);
  picture.capture.map.clear();
  picture.capture.bias.reset(), picture.capture.filter.reset();
  const JudgeOutcome without = picture.judged();
  ASSERT_TRUE(without.result) << reason(without);
  EXPECT_EQ(without.result->lights[0].error.wrong, light.error.wrong);
}

}  // namespace
}  // namespace gnomon::test
