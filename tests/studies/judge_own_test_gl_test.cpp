// Captures of real engines' kinds that a judge must believe: whatever is wrong with their shadows, their own test, map and
// matrix draw the picture. Each has a sibling without the oddity, and is judged as that one is.
#include <fmt/ranges.h>

#include "compare/result/judged.h"
#include "scene/files/pictures/image_io.h"
#include "tests/support/capture_support.h"

namespace gnomon::test {
namespace {

using compare::Capture;
using compare::Label;
using compare::StoredDepth;

/// A floor, a plate that hovers closely over it, turned, and a box that stands on it.
Scene hovering_box(const std::string& light) {
  Mesh high = box_mesh({-0.8, 0.0, -0.9}, {0.8, 0.03, 0.9}),
       low = box_mesh({1.2, 0.0, -1.4}, {2.0, 0.7, -0.5});
  for (Vec3& p : high.positions) p = Vec3(0.98 * p.x - 0.2 * p.y, 0.2 + 0.2 * p.x + 0.98 * p.y, p.z);
  Scene scene = sunlit_scene({floor_mesh(4, 4), high, low}, {0.9, -1.0, 0.5});
  scene.camera = {{3.5, 2.2, 4.5}, {0.4, 0.1, 0.2}, {0, 1, 0}, 0.8};
  if (light == "sun") return scene;
  Light& lamp = scene.lights[0];
  lamp.type = LightType::spot;
  lamp.position = {-1.5, 6.0, -1.0};
  lamp.direction = glm::normalize(-lamp.position);
  lamp.inner_angle = 0.6, lamp.outer_angle = 0.7;
  return scene;
}

/// A light's map and the picture that another renderer draws on it with this bias.
struct Engine {
  explicit Engine(const std::string& name, double constant_depth, const std::string& light = "sun",
                  StoredDepth stored = StoredDepth::zero_to_one, const raster::Bias& casters = {},
                  raster::Technique technique = raster::Technique::hard)
      : drawn(draw_scene(hovering_box(light), small_picture, map_with(casters, technique))),
        capture(self_capture(drawn, folder_for("own-" + name), {.map = true, .stored = stored})) {
    capture.bias = compare::CapturedBias{.constant_depth = constant_depth};
    draw_again(capture, drawn);
  }
  static raster::MapOptions map_with(const raster::Bias& casters, raster::Technique technique) {
    raster::MapOptions map = hard_map(512, technique);
    map.bias = casters;
    map.bias.constant = 0.0, map.bias.unit = raster::BiasUnit::world;
    return map;
  }
  JudgeOutcome judged(bool fix = false) const {
    compare::JudgeOptions options;
    options.fix = fix;
    return judge(capture, *drawn.scene, options);
  }
  const LightView& view() const { return drawn.result.raster.lights[0].map.view; }
  double range() const { return view().face(0).far_depth - view().face(0).near_depth; }
  void change_picture(const std::function<float(float)>& change) {
    spoil(capture.visibility, [&](ChannelImage& image) {
      for (float& v : image.channels[0].values) v = change(v);
    });
  }

  Compared drawn;
  Capture capture;
};

std::string notes_in(const JudgeOutcome& judged) {
  return judged.result ? fmt::format("{}", fmt::join(judged.result->judged->notes, "\n")) : reason(judged);
}

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
  Engine engine("contact", 0.002);
  const JudgeOutcome plain = engine.judged();
  ASSERT_TRUE(plain.result) << reason(plain);
  std::size_t darkened = 0;
  spoil(engine.capture.visibility, [&](ChannelImage& image) {
    for (int y = 60; y < 80; ++y)
      for (int x = 20; x < 34; ++x) {
        float& v = image.channels[0].values[std::size_t(y * small_picture.width + x)];
        darkened += v > 0.5f ? 1 : 0, v = 0.0f;
      }
  });
  ASSERT_GT(darkened, 100U);
  const JudgeOutcome judged = engine.judged();
  ASSERT_TRUE(judged.result) << reason(judged);
  EXPECT_NE(notes_in(judged).find("is not the one that was drawn in"), std::string::npos) << notes_in(judged);
  const auto &its = judged.result->judged->advice, &own = plain.result->judged->advice;
  ASSERT_FALSE(its.empty());
  EXPECT_EQ(its[0].instead, own[0].instead);
  EXPECT_LE(called(judged, Label::unexplained), darkened);
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
      compare::CapturedCasterBias{.constant_world = c.constant_world, .slope = c.slope};
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

// ---- worlds and projections ----

/// The capture as a renderer hands it over whose places are `captured_from_scene` times the scene's.
void turn_world(Capture& capture, const Mat3& captured_from_scene, bool positions = true) {
  for (compare::CapturedLayer& layer : capture.map)
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
  EXPECT_FALSE(judged.result->judged->advice.empty());
  EXPECT_LT(called(judged, Label::unexplained) + called(judged, Label::stored_depth), 10U);
}

// ---- what a capture's keys say of a map ----

void expect_own_test(const JudgeOutcome& judged) {
  ASSERT_TRUE(judged.result) << reason(judged);
  EXPECT_GT(judged.result->judged->biased_is_drawn, 0.999);
  EXPECT_EQ(called(judged, Label::unexplained), 0U) << notes_in(judged);
  EXPECT_FALSE(judged.result->judged->advice.empty());
}

/// Three cascades chosen by the distance from the camera, which is not the first that holds a place.
Engine cascades(const std::string& name, bool by_distance) {
  Engine engine(name, 0.002, "sun", StoredDepth::zero_to_one, {}, raster::Technique::csm);
  const double ends[] = {0.0, 5.0, 6.5, 1e3};
  for (std::size_t i = 0; i < engine.capture.map.size(); ++i)
    engine.capture.map[i].select = compare::CapturedSelect{
        ends[std::min<std::size_t>(i, 2)], ends[std::min<std::size_t>(i + 1, 3)], by_distance};
  engine.capture.map.resize(3);
  return engine;
}

TEST(JudgeKeys, CascadesAreChosenByDistance) {
  for (const bool by_distance : {false, true}) {
    Engine engine = cascades("select", by_distance);
    // Each layer with its own bias, too.
    for (const std::size_t layer : {1, 2})
      engine.capture.map[layer].bias =
          compare::CapturedBias{.constant_depth = 0.05, .normal_offset_world = 0.01};
    draw_again(engine.capture, engine.drawn);
    expect_own_test(engine.judged());
    // Without the key another cascade is looked up somewhere, and without the layer's bias another test is drawn.
    Engine unsaid = cascades("select", by_distance);
    for (const std::size_t layer : {1, 2}) unsaid.capture.map[layer].bias = engine.capture.map[layer].bias;
    draw_again(unsaid.capture, unsaid.drawn);
    for (compare::CapturedLayer& layer : unsaid.capture.map) layer.bias.reset();
    const JudgeOutcome without_bias = unsaid.judged();
    ASSERT_TRUE(without_bias.result) << reason(without_bias);
    EXPECT_LT(without_bias.result->judged->biased_is_drawn, 0.999);
    for (compare::CapturedLayer& layer : engine.capture.map) layer.select.reset();
    const JudgeOutcome without_select = engine.judged();
    ASSERT_TRUE(without_select.result) << reason(without_select);
    EXPECT_LT(without_select.result->judged->biased_is_drawn, 0.999);
  }
}

TEST(JudgeKeys, DepthsMayBeReadBetweenTexels) {
  Engine engine("linear", 0.002);
  engine.capture.filter = compare::CapturedFilter{.linear_depths = true};
  draw_again(engine.capture, engine.drawn);
  expect_own_test(engine.judged());
  engine.capture.filter->linear_depths = false;
  const JudgeOutcome unsaid = engine.judged();
  ASSERT_TRUE(unsaid.result) << reason(unsaid);
  EXPECT_LT(unsaid.result->judged->biased_is_drawn, 0.999);
}

/// The layer in a part of a larger picture, its matrix into the whole of that.
void put_into_atlas(Capture& capture, const compare::CapturedRect& rect, ImageSize atlas) {
  spoil(capture.map[0].depth, [&](ChannelImage& image) {
    std::vector<float> whole(atlas.pixels(), 0.37f);
    for (int y = 0; y < rect.height; ++y)
      for (int x = 0; x < rect.width; ++x)
        whole[std::size_t((rect.y + y) * atlas.width + rect.x + x)] =
            image.channels[0].values[std::size_t(y * image.size.width + x)];
    image.size = atlas, image.channels[0].values = std::move(whole);
  });
  const double below =
      capture.map[0].rows == compare::RowOrder::top_down ? atlas.height - rect.y - rect.height : rect.y;
  Mat4 atlas_from_rect(1.0);
  atlas_from_rect[0][0] = double(rect.width) / atlas.width,
  atlas_from_rect[1][1] = double(rect.height) / atlas.height;
  atlas_from_rect[3][0] = 2.0 * (rect.x + 0.5 * rect.width) / atlas.width - 1.0;
  atlas_from_rect[3][1] = 2.0 * (below + 0.5 * rect.height) / atlas.height - 1.0;
  *capture.map[0].clip_from_world = atlas_from_rect * *capture.map[0].clip_from_world;
  capture.map[0].rect = rect;
}

TEST(JudgeKeys, ALayerMayBePartOfAnAtlas) {
  for (const char* light : {"sun", "lamp"})
    for (const compare::RowOrder rows : {compare::RowOrder::top_down, compare::RowOrder::bottom_up}) {
      Engine engine("atlas", std::string(light) == "sun" ? 0.002 : 0.0004, light);
      const JudgeOutcome alone = engine.judged();
      if (rows != engine.capture.map[0].rows) {
        engine.capture.map[0].rows = rows;
        spoil(engine.capture.map[0].depth, [](ChannelImage& image) {
          std::vector<float>& v = image.channels[0].values;
          for (int y = 0; y < image.size.height / 2; ++y)
            std::swap_ranges(v.begin() + y * image.size.width, v.begin() + (y + 1) * image.size.width,
                             v.begin() + (image.size.height - 1 - y) * image.size.width);
        });
      }
      put_into_atlas(engine.capture, {512, 100, 512, 512}, {1024, 700});
      expect_judged_as(engine.judged(), alone);
    }
}

// A part of the window, whose texels are those of the whole: what lies beside it is outside the map.
TEST(JudgeKeys, ALayerNeedNotBeSquare) {
  for (const char* light : {"sun", "lamp"}) {
    Engine engine("oblong", std::string(light) == "sun" ? 0.002 : 0.0004, light);
    Capture& capture = engine.capture;
    constexpr int low = 224, height = 64;
    spoil(capture.map[0].depth, [&](ChannelImage& image) {
      std::vector<float>& v = image.channels[0].values;
      v = std::vector<float>(v.begin() + low * 512, v.begin() + (low + height) * 512);
      image.size.height = height;
    });
    Mat4 part_from_whole(1.0);
    part_from_whole[1][1] = 512.0 / height;
    *capture.map[0].clip_from_world = part_from_whole * *capture.map[0].clip_from_world;
    draw_again(capture, engine.drawn);
    const JudgeOutcome judged = engine.judged();
    ASSERT_TRUE(judged.result) << reason(judged);
    EXPECT_GT(judged.result->judged->biased_is_drawn, 0.999);
    EXPECT_EQ(called(judged, Label::unexplained), 0U) << notes_in(judged);
    EXPECT_GT(called(judged, Label::outside_map), 20U);
  }
}

}  // namespace
}  // namespace gnomon::test
