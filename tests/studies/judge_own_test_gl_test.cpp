// Captures of real engines' kinds that a judge must believe: whatever is wrong with their shadows, their own test, map and
// matrix draw the picture. Each has a sibling without the oddity, and is judged as that one is.
#include "compare/result/judged.h"
#include "scene/files/pictures/image_io.h"
#include "tests/support/judged_engine.h"

namespace gnomon::test {
namespace {

using compare::Label;
using judge::Capture;
using judge::StoredDepth;

std::uint64_t called(const JudgeOutcome& judged, Label label) {
  return judged.result->lights[0].classes[static_cast<std::size_t>(label) - 1];
}

/// V5 is V6 but for the borders of texels, and labels and advice are the sibling's.
void expect_judged_as(const JudgeOutcome& judged, const JudgeOutcome& sibling) {
  ASSERT_TRUE(judged.result) << reason(judged);
  ASSERT_TRUE(sibling.result) << reason(sibling);
  EXPECT_GT(judged.result->judged->biased_is_drawn, 0.999);
  const auto allowed =
      static_cast<std::uint64_t>(border_share * double(sibling.result->lights[0].pixels.compared));
  for (std::size_t k = 1; k <= compare::class_count; ++k)
    EXPECT_NEAR(double(called(judged, static_cast<Label>(k))), double(called(sibling, static_cast<Label>(k))),
                double(allowed))
        << label_name(static_cast<Label>(k));
  const auto &its = judged.result->judged->advice, &own = sibling.result->judged->advice;
  ASSERT_EQ(its.empty(), own.empty());
  if (!own.empty()) {
    EXPECT_NEAR(its[0].wrong_instead, own[0].wrong_instead, border_share);
  }
}

// ---- verdicts, not conventions ----

TEST(JudgeOwnTest, ABiasThatLeavesNoShadowIsAVerdict) {
  const Engine engine("no-shadow", 0.6);
  const JudgeOutcome judged = engine.judged();
  ASSERT_TRUE(judged.result) << reason(judged);
  EXPECT_NE(notes_in(judged).find("no shadow is drawn: the bias of"), std::string::npos) << notes_in(judged);
  const compare::LightComparison& light = judged.result->lights[0];
  EXPECT_GT(4 * called(judged, Label::peter_panning), 3 * light.error.wrong);
  const std::vector<compare::Advice>& advice = judged.result->judged->advice;
  ASSERT_FALSE(advice.empty());
  EXPECT_LT(advice.back().wrong_instead, 0.2 * advice[0].wrong_now);
}

TEST(JudgeOwnTest, AStrengthIsToldAndTakenOut) {
  Engine engine("strength", 0.002);
  const JudgeOutcome plain = engine.judged();
  for (const double strength : {0.3, 0.6}) {
    Engine weak("strength", 0.002);
    weak.change_picture([&](float v) { return static_cast<float>(1.0 - strength + strength * double{v}); });
    const JudgeOutcome judged = weak.judged();
    expect_judged_as(judged, plain);
    EXPECT_NE(notes_in(judged).find(fmt::format("a strength of {:.3g}", strength)), std::string::npos)
        << notes_in(judged);
    weak.capture.strength = strength;
    const JudgeOutcome said = weak.judged();
    expect_judged_as(said, plain);
    EXPECT_EQ(notes_in(said).find("a strength of"), std::string::npos) << notes_in(said);
  }
}

// Half a percent of the picture is dark for another reason: the bias is advised on all the same.
TEST(JudgeOwnTest, AContactShadowTakesNoAdviceAway) {
  Engine engine("contact", 0.0);
  const JudgeOutcome plain = engine.judged();
  ASSERT_TRUE(plain.result) << reason(plain);
  std::size_t darkened = 0;
  spoil(engine.capture.visibility, [&](ChannelImage& image) {
    for (int y = 60; y < 80; ++y)
      for (int x = 20; x < 34; ++x) {
        float& v = image.channels[0].values[small_picture.width * std::size_t(y) + std::size_t(x)];
        darkened += v > 0.5f ? 1 : 0, v = 0.0f;
      }
  });
  ASSERT_GT(darkened, 50U);  // where acne has not darkened it
  const JudgeOutcome judged = engine.judged();
  ASSERT_TRUE(judged.result) << reason(judged);
  EXPECT_NE(notes_in(judged).find("is not the one that was drawn in"), std::string::npos) << notes_in(judged);
  const auto &its = judged.result->judged->advice, &own = plain.result->judged->advice;
  ASSERT_FALSE(its.empty());
  EXPECT_EQ(its[0].instead, own[0].instead);
  EXPECT_LE(called(judged, Label::unexplained), darkened);
}

// ---- advice ----

// Of two layers one has a bias that leaves no shadow: no one constant mends both.
TEST(JudgeAdvice, GivesEachLayerAConstantOfItsOwn) {
  Engine engine("layers", 0.002);
  Capture& capture = engine.capture;
  capture.map.assign(2, judge::CapturedLayer(capture.map[0]));
  capture.map[0].select = judge::CapturedSelect{0.0, 5.6};
  capture.map[1].select = judge::CapturedSelect{5.6, 1e3};
  capture.map[1].bias = judge::CapturedBias{.constant_depth = 0.06};
  draw_again(capture, engine.drawn);
  const JudgeOutcome judged = engine.judged();
  ASSERT_TRUE(judged.result) << reason(judged);
  ASSERT_FALSE(judged.result->judged->advice.empty());
  const compare::Advice& advice = judged.result->judged->advice.back();
  EXPECT_EQ(advice.setting, "map[0].bias.constant_depth");
  ASSERT_EQ(advice.layers.size(), 1U);
  EXPECT_EQ(advice.layers[0].setting, "map[1].bias.constant_depth");
  EXPECT_EQ(advice.layers[0].now, 0.06);
  EXPECT_LT(advice.layers[0].instead, 0.02);
  EXPECT_NEAR(advice.layers[0].unit_world, engine.range(), 1e-6);
  EXPECT_LT(advice.wrong_instead, 0.5 * advice.wrong_now);
  EXPECT_NE(advice_text(advice).find(" texel)"), std::string::npos) << advice_text(advice);
  // Taken, it leaves what is promised.
  for (const compare::AdvisedSetting& layer : advice.layers)
    capture.map[1].bias = judge::CapturedBias{.constant_depth = layer.instead};
  capture.bias->constant_depth = advice.instead;
  draw_again(capture, engine.drawn);
  const JudgeOutcome taken = engine.judged();
  ASSERT_TRUE(taken.result) << reason(taken);
  EXPECT_NEAR(taken.result->lights[0].error.wrong_fraction, advice.wrong_instead, border_share);
}

// A few pixels look up the second layer, and the capture does not say so: `select` would.
TEST(JudgeOwnTest, NamesSelectWhereAFewPixelsLookAnotherLayerUp) {
  Engine engine("another-layer", 0.002);
  Capture& capture = engine.capture;
  capture.map.assign(2, judge::CapturedLayer(capture.map[0]));
  capture.map[0].select = judge::CapturedSelect{0.0, 6.0};
  capture.map[1].select = judge::CapturedSelect{6.0, 1e3};
  capture.map[1].bias = judge::CapturedBias{.constant_depth = 0.06};
  draw_again(capture, engine.drawn);
  const char* words = "`map[].select` of gnomon/capture/2";
  EXPECT_EQ(notes_in(engine.judged()).find(words), std::string::npos);
  for (judge::CapturedLayer& layer : capture.map) layer.select.reset();
  const JudgeOutcome judged = engine.judged();
  ASSERT_TRUE(judged.result) << reason(judged);
  EXPECT_NE(notes_in(judged).find(words), std::string::npos)
      << notes_in(judged) << called(judged, Label::unexplained);
}

// Layers of different depths under one stored number, which is too much on one and too little on the other: a constant in
// texels suits both.
TEST(JudgeAdvice, GivesLayersOneConstantInTexels) {
  Engine engine("texels", 0.0);
  Capture& capture = engine.capture;
  capture.map.assign(2, judge::CapturedLayer(capture.map[0]));
  capture.map[0].select = judge::CapturedSelect{0.0, 5.6};
  capture.map[1].select = judge::CapturedSelect{5.6, 1e3};
  // The second keeps its texels, in a hundred times the depths.
  constexpr float times = 100.0f;
  capture.map[1].depth += ".deep.exr";
  const auto shallow = read_channels(capture.map[0].depth);
  ASSERT_TRUE(shallow);
  Channel deep = shallow->channels[0];
  for (float& v : deep.values) v /= times;
  for (float& v : deep.values) v = v < 1.0f / times ? v : 1.0f;
  ASSERT_TRUE(write_exr(capture.map[1].depth, shallow->size, std::array{deep}));
  Mat4& matrix = *capture.map[1].clip_from_world;
  for (int column = 0; column < 4; ++column) matrix[column][2] /= double{times};
  capture.bias->constant_depth = 0.0002;
  draw_again(capture, engine.drawn);
  const JudgeOutcome judged = engine.judged();
  ASSERT_TRUE(judged.result) << reason(judged);
  ASSERT_FALSE(judged.result->judged->advice.empty());
  const compare::Advice& advice = judged.result->judged->advice.back();
  ASSERT_TRUE(advice.texels_of_each.has_value()) << advice_text(advice);
  ASSERT_EQ(advice.layers.size(), 1U);
  EXPECT_NEAR(advice.layers[0].instead * double{times}, advice.instead, 1e-3 * advice.instead);
  EXPECT_NE(advice_text(advice).find("a bias of 0.4 texel on each layer"), std::string::npos)
      << advice_text(advice);
  // Taken, it leaves what is promised.
  capture.bias->constant_depth = advice.instead;
  capture.map[1].bias = judge::CapturedBias{.constant_depth = advice.layers[0].instead};
  draw_again(capture, engine.drawn);
  const JudgeOutcome taken = engine.judged();
  ASSERT_TRUE(taken.result) << reason(taken);
  EXPECT_NEAR(taken.result->lights[0].error.wrong_fraction, advice.wrong_instead, border_share);
}

// Something else darkens a part of the picture: it stays dark with any bias, and is part of every promise.
TEST(JudgeAdvice, PromisesNothingOfWhatIsNotExplained) {
  Engine engine("not-explained", 0.0);
  const auto darken = [&] {
    spoil(engine.capture.visibility, [](ChannelImage& image) {
      for (int y = 60; y < 80; ++y)
        for (int x = 20; x < 34; ++x)
          image.channels[0].values[small_picture.width * std::size_t(y) + std::size_t(x)] = 0.0f;
    });
  };
  darken();
  const JudgeOutcome judged = engine.judged();
  ASSERT_TRUE(judged.result) << reason(judged);
  ASSERT_FALSE(judged.result->judged->advice.empty());
  const compare::Advice& advice = judged.result->judged->advice.front();
  ASSERT_EQ(advice.setting, "bias.constant_depth");
  EXPECT_EQ(advice.wrong_now, judged.result->lights[0].error.wrong_fraction);
  EXPECT_GT(advice.wrong_instead, 200.0 / double(judged.result->lights[0].pixels.compared));
  engine.capture.bias->constant_depth = advice.instead;
  draw_again(engine.capture, engine.drawn);
  darken();
  const JudgeOutcome taken = engine.judged();
  ASSERT_TRUE(taken.result) << reason(taken);
  EXPECT_NEAR(taken.result->lights[0].error.wrong_fraction, advice.wrong_instead,
              advice.about ? 0.2 * advice.wrong_instead : 1e-3);
}

TEST(JudgeAdvice, OfAFilterDoesNotRaiseTheMeanError) {
  for (const double constant : {0.01, 0.05, 0.3}) {
    raster::MapOptions map = Engine::map_with({.slope = 0.0}, raster::Technique::pcf);
    map.bias.constant = constant, map.filter.radius_texels = 3.5;
    const Compared drawn = draw_scene(hovering_box("sun"), small_picture, map);
    Capture capture = self_capture(drawn, folder_for("own-mean"), {.map = true});
    capture.filter = judge::CapturedFilter{judge::FilterName::pcf, 3.5};
    const JudgeOutcome judged = judge(capture, *drawn.scene);
    ASSERT_TRUE(judged.result) << reason(judged);
    EXPECT_TRUE(judged.result->judged->advice_sought);
    if (judged.result->judged->advice.empty()) continue;
    const compare::Advice& advice = judged.result->judged->advice[0];
    ASSERT_TRUE(advice.mean_now && advice.mean_instead);
    EXPECT_LT(*advice.mean_instead, *advice.mean_now);
    EXPECT_EQ(*advice.mean_now, judged.result->lights[0].error.mean_absolute);
  }
}

// ---- the casters' bias ----

struct CasterCase {
  const char* name;
  const char* light;
  StoredDepth stored;
  double constant_world, slope;  ///< as drawn
};

class JudgeCasterBias : public testing::TestWithParam<CasterCase> {};

// Drawn by the rasterizer with a bias of casters, handed over without a word, and again with the key that says it.
TEST_P(JudgeCasterBias, IsFoundChargedToTheBiasAndAdvisedOn) {
  const CasterCase& c = GetParam();
  raster::Bias casters{.slope = 0.0};
  casters.caster_constant = c.constant_world, casters.caster_slope = c.slope;
  Engine engine(std::string("casters-") + c.name, 0.0, c.light, c.stored, casters);
  const JudgeOutcome found = engine.judged();
  ASSERT_TRUE(found.result) << reason(found);
  EXPECT_NE(notes_in(found).find("the map was drawn with "), std::string::npos) << notes_in(found);
  EXPECT_GT(found.result->judged->biased_is_drawn, 0.995);
  const compare::LightComparison& light = found.result->lights[0];
  EXPECT_GT(called(found, Label::caster_bias), 50U);
  EXPECT_LT(called(found, Label::stored_depth) + called(found, Label::missing_caster),
            light.error.wrong / 20 + 2);
  EXPECT_LT(light.budget[compare::cause_count].absolute_mean, 1e-3) << "no caster lacks";
  EXPECT_GE(light.budget[static_cast<std::size_t>(compare::Cause::bias)].missed_shadow,
            called(found, Label::caster_bias));
  const std::vector<compare::Advice>& advice = found.result->judged->advice;
  ASSERT_FALSE(advice.empty());
  EXPECT_TRUE(advice[0].setting.starts_with("map[].caster_bias.constant")) << advice[0].setting;
  EXPECT_LT(advice.back().wrong_instead, 0.5 * advice[0].wrong_now);
  // The rule is the drawing's own, within one percent.
  const bool world = advice[0].setting.ends_with("_world"), parallel = std::string(c.light) == "sun";
  if (parallel || world) {
    EXPECT_NEAR(advice[0].now * (world ? 1.0 : engine.range()), c.constant_world,
                0.01 * c.constant_world + 1e-4);
  }
  if (advice.back().setting == "map[].caster_bias.slope") {
    EXPECT_NEAR(advice.back().now, c.slope, 0.01 * c.slope);
  }
  engine.capture.map[0].caster_bias =
      judge::CapturedCasterBias{.constant_world = c.constant_world, .slope = c.slope};
  const JudgeOutcome given = engine.judged();
  expect_judged_as(given, found);
  EXPECT_EQ(notes_in(given).find("the map was drawn with "), std::string::npos) << notes_in(given);
}

INSTANTIATE_TEST_SUITE_P(
    Maps, JudgeCasterBias,
    testing::Values(CasterCase{"sun_constant", "sun", StoredDepth::zero_to_one, 0.4, 0.0},
                    CasterCase{"sun_slope", "sun", StoredDepth::zero_to_one, 0.0, 32.0},
                    CasterCase{"sun_both", "sun", StoredDepth::minus_one_to_one, 0.3, 10.0},
                    CasterCase{"sun_both_reversed", "sun", StoredDepth::reversed, 0.3, 10.0},
                    CasterCase{"spot_constant", "lamp", StoredDepth::zero_to_one, 0.4, 0.0},
                    CasterCase{"spot_slope", "lamp", StoredDepth::zero_to_one, 0.0, 120.0}),
    [](const auto& chosen) { return chosen.param.name; });

// A capture may have a cube's faces in any order.
TEST(JudgeCubeBias, IsSaidByTheDirectionsOfTheFaces) {
  raster::Bias casters{.slope = 0.0};
  casters.caster_constant = 0.4;
  Engine engine("casters-cube", 0.0, "bulb", StoredDepth::zero_to_one, casters);
  const std::string notes = notes_in(engine.judged());
  EXPECT_NE(notes.find("face -y: an offset of"), std::string::npos) << notes;
  EXPECT_EQ(notes.find("layer"), std::string::npos) << notes;
}

// ---- worlds and projections ----

/// The capture as a renderer hands it over whose places are `captured_from_scene` times the scene's.
void turn_world(Capture& capture, const Mat3& captured_from_scene, bool positions = true) {
  for (judge::CapturedLayer& layer : capture.map)
    *layer.clip_from_world *= Mat4(glm::inverse(captured_from_scene));
  if (!positions) return;
  spoil(capture.position, [&](ChannelImage& image) {
    for (std::size_t i = 0; i < image.size.pixels(); ++i) {
      std::array<float*, 3> c{};
      for (Channel& channel : image.channels)
        if (channel.name != "A") c[std::size_t(channel.name[0] - 'X')] = &channel.values[i];
      const Vec3 p = captured_from_scene * Vec3(*c[0], *c[1], *c[2]);
      for (int k = 0; k < 3; ++k) *c[std::size_t(k)] = static_cast<float>(p[k]);
    }
  });
}

struct WorldCase {
  const char* name;
  const char* words;
  Mat3 scene_from_captured;
  bool positions = true;
};

class JudgeWorld : public testing::TestWithParam<WorldCase> {};

TEST_P(JudgeWorld, IsNamedAndMendedOfPositionsAndMapTogether) {
  const WorldCase& c = GetParam();
  Engine engine(std::string("world-") + c.name, 0.002);
  const JudgeOutcome plain = engine.judged();
  turn_world(engine.capture, glm::inverse(c.scene_from_captured), c.positions);
  const JudgeOutcome refused = engine.judged();
  ASSERT_FALSE(refused.result);
  EXPECT_NE(reason(refused).find(c.words), std::string::npos) << reason(refused);
  EXPECT_NE(reason(refused).find("--fix undoes it"), std::string::npos) << reason(refused);
  const JudgeOutcome mended = engine.judged(true);
  expect_judged_as(mended, plain);
  ASSERT_EQ(mended.result->judged->mended.size(), 1U);
  EXPECT_NE(mended.result->judged->mended[0].what.find(c.words), std::string::npos);
}

const Vec3 x_of_scene(1, 0, 0), y_of_scene(0, 1, 0), z_of_scene(0, 0, 1);
INSTANTIATE_TEST_SUITE_P(Worlds, JudgeWorld,
                         testing::Values(WorldCase{"z_up", "the positions are z-up",
                                                   Mat3(x_of_scene, -z_of_scene, y_of_scene)},
                                         WorldCase{"left_handed", "left-handed (z the other way)",
                                                   Mat3(x_of_scene, y_of_scene, -z_of_scene)},
                                         WorldCase{"centimetres", "in centimetres", Mat3(0.01)},
                                         WorldCase{"unreal", "z-up, the scene y-up, left-handed",
                                                   0.01 * Mat3(-z_of_scene, x_of_scene, y_of_scene)},
                                         WorldCase{"map_alone", "the map's world is z-up",
                                                   Mat3(x_of_scene, -z_of_scene, y_of_scene), false}),
                         [](const auto& chosen) { return chosen.param.name; });

// Stored is near / depth: the matrix's row of z has no direction.
TEST(JudgeOwnTest, AReversedInfiniteProjectionIsNotSingular) {
  Engine engine("infinite", 0.0002, "lamp", StoredDepth::reversed);
  const LightFace& face = engine.view().face(0);
  LightView reversed = engine.view();
  reversed.reversed = true;
  Capture& capture = engine.capture;
  spoil(capture.map[0].depth, [&](ChannelImage& image) {
    for (float& v : image.channels[0].values)
      if (v > 0.0f) v = static_cast<float>(face.near_depth / depth_from_stored(reversed, 0, 0.5, double{v}));
  });
  Mat4& matrix = *capture.map[0].clip_from_world;
  for (int column = 0; column < 4; ++column) matrix[column][2] = column == 3 ? face.near_depth : 0.0;
  draw_again(capture, engine.drawn);
  const JudgeOutcome judged = engine.judged();
  ASSERT_TRUE(judged.result) << reason(judged);
  EXPECT_GT(judged.result->judged->biased_is_drawn, 0.999);
  EXPECT_TRUE(judged.result->judged->advice_sought);
  EXPECT_LT(called(judged, Label::unexplained) + called(judged, Label::stored_depth), 10U);
}

}  // namespace
}  // namespace gnomon::test
