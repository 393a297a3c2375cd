// gnomon judge on every kind of map, camera depth and pair of pictures that a capture may have. Each is judged twice: as
// Gnomon's own drawing, and as that of a shadow test written here with nothing but the capture's matrix and texels.
#include "scene/files/pictures/image_io.h"
#include "scene/light.h"
#include "tests/support/capture_support.h"

namespace gnomon::test {
namespace {

using judge::Capture;
using judge::PixelDepth;
using judge::RowOrder;
using judge::StoredDepth;
using raster::Technique;

struct Kind {
  std::string light;
  Technique technique;
  StoredDepth stored;
};

std::string name_of(const Kind& kind) {
  return kind.light + (kind.technique == Technique::csm ? "_cascades_" : "_") +
         std::string(judge::convention_of(kind.stored).name);
}

std::vector<Kind> kinds(bool distances) {
  std::vector<Kind> out;
  for (const StoredDepth stored :
       {StoredDepth::zero_to_one, StoredDepth::minus_one_to_one, StoredDepth::reversed}) {
    for (const char* light : {"sun", "lamp", "bulb"}) out.push_back({light, Technique::hard, stored});
    out.push_back({"sun", Technique::csm, stored});
  }
  if (!distances) return out;
  out.push_back({"lamp", Technique::hard, StoredDepth::distance});
  out.push_back({"bulb", Technique::hard, StoredDepth::distance});
  return out;
}

/// Without a constant: a world distance is one difference of stored numbers for a sun alone.
Compared draw(const Kind& kind) {
  raster::MapOptions map = hard_map(128, kind.technique);
  map.bias = {.constant = 0.0, .unit = raster::BiasUnit::world, .slope = 2.0};
  if (kind.stored == StoredDepth::reversed) map.depth_format = raster::DepthFormat::d32f_reversed;
  return draw_scene(scene_under(kind.light), small_picture, map);
}

double share_as_drawn(const JudgeOutcome& judged) {
  return judged.result ? judged.result->judged->biased_is_drawn : 0.0;
}

/// The share of the compared pixels whose V5 is what was drawn in Gnomon's own ladder, and not in the capture's.
double lost_share(const compare::LightComparison& own, const compare::LightComparison& its) {
  std::size_t count = 0, lost = 0;
  for (std::size_t i = 0; i < own.labels.data.size(); ++i) {
    if (!compare::is_compared(own.labels.data[i])) continue;
    const float drawn = own.rungs[6].data[i];
    ++count, lost += own.rungs[5].data[i] == drawn && its.rungs[5].data[i] != drawn ? 1 : 0;
  }
  return static_cast<double>(lost) / static_cast<double>(count);
}

class JudgeMaps : public testing::TestWithParam<Kind> {};

TEST_P(JudgeMaps, GiveTheLadderOfGnomonsOwn) {
  const Compared drawn = draw(GetParam());
  const CaptureParts parts{.map = true, .stored = GetParam().stored};
  const JudgeOutcome judged =
      judge(self_capture(drawn, folder_for(name_of(GetParam())), parts), *drawn.scene);
  ASSERT_TRUE(judged.result) << reason(judged);
  const compare::LightComparison &own = drawn.light(), &its = judged.result->lights[0];
  EXPECT_LT(lost_share(own, its), border_share);
  // A floor that squarely faces the bulb's map is one float deep, and shadowed by rounding in the rasterizer's floats.
  EXPECT_GT(share_as_drawn(judged), GetParam().light == "bulb" ? 0.98 : 1.0 - border_share);
  EXPECT_GT(own.error.wrong, 20U);
  for (std::size_t k = 0; k < compare::rung_count; ++k)
    EXPECT_NEAR(own.rung_mean[k], its.rung_mean[k], border_share) << "V" << k;
}
INSTANTIATE_TEST_SUITE_P(Of, JudgeMaps, testing::ValuesIn(kinds(false)),
                         [](const auto& kind) { return name_of(kind.param); });

// ---- a shadow test of its own ----

class JudgeOtherTests : public testing::TestWithParam<Kind> {};

// Both test in doubles at the same places: one pixel may lie on a texel's border to the last bit.
TEST_P(JudgeOtherTests, AreClimbedToWhatTheyDrew) {
  const Kind& kind = GetParam();
  const Compared drawn = draw(kind);
  for (const RowOrder rows : {RowOrder::bottom_up, RowOrder::top_down}) {
    Capture capture =
        self_capture(drawn, folder_for("other-" + name_of(kind)),
                     {.positions = false, .mask = true, .map = true, .stored = kind.stored, .rows = rows});
    const bool world = kind.stored == StoredDepth::distance;
    capture.bias = judge::CapturedBias{.constant_depth = world ? 0.03 : 0.0004, .normal_offset_world = 0.01};
    if (kind.technique != Technique::csm) std::reverse(capture.map.begin(), capture.map.end());
    draw_again(capture, drawn);
    const JudgeOutcome judged = judge(capture, *drawn.scene);
    ASSERT_TRUE(judged.result) << reason(judged);
    EXPECT_GT(share_as_drawn(judged), 1.0 - 1e-4);
    EXPECT_GT(judged.result->lights[0].error.wrong, 20U);
  }
}
INSTANTIATE_TEST_SUITE_P(Of, JudgeOtherTests, testing::ValuesIn(kinds(true)),
                         [](const auto& kind) { return name_of(kind.param); });

// Engines keep the back faces of single-sided materials in the map, which the eye looks through and light does not.
TEST(JudgeSides, BacksOfSingleSidedMaterialsAreFoundInTheMap) {
  Scene scene =
      sunlit_scene({floor_mesh(4, 4), box_mesh({-0.5, 0.6, -0.5}, {0.5, 1.0, 0.5})}, {0.1, -1.0, 0.05});
  scene.camera = {{2.5, 3.0, 4.0}, {0.2, 0.2, 0}, {0, 1, 0}, 0.7};
  for (Material& material : scene.materials) material.double_sided = false;
  raster::MapOptions map = hard_map(128);
  map.cull = raster::Cull::front;
  const Compared drawn = draw_scene(scene, small_picture, map);
  const JudgeOutcome judged =
      judge(self_capture(drawn, folder_for("single_sided"), {.map = true}), *drawn.scene);
  ASSERT_TRUE(judged.result) << reason(judged);
  EXPECT_EQ(judged.result->raster.options.map.cull, raster::Cull::front);
}

// ---- where the pixels are, and two pictures for one ----

using judge::CapturedDepth;

class JudgeCameraDepths : public testing::Test {
 protected:
  const Compared drawn_ = draw_scene(scene_under("sun"), small_picture, hard_map(256));
  Capture capture(const CapturedDepth& depth) const {
    return self_capture(drawn_, folder_for("depth"), {.positions = false, .map = true, .depth = &depth});
  }
};

TEST_F(JudgeCameraDepths, OfEveryConventionGiveTheSameVerdict) {
  for (const CapturedDepth& depth :
       {CapturedDepth{"", PixelDepth::view_z, {}, {}}, CapturedDepth{"", PixelDepth::distance, {}, {}},
        CapturedDepth{"", PixelDepth::zero_to_one, 0.1, 200.0},
        CapturedDepth{"", PixelDepth::reversed, 0.1, 200.0},
        CapturedDepth{"", PixelDepth::reversed, 0.1, {}}}) {
    const std::string_view name = judge::pixel_depth_names[static_cast<std::size_t>(*depth.convention)];
    const JudgeOutcome judged = judge(capture(depth), *drawn_.scene);
    ASSERT_TRUE(judged.result) << name << ": " << reason(judged);
    EXPECT_GT(share_as_drawn(judged), 1.0 - border_share) << name;
    double agreement = 0.0;
    for (const compare::Agreement& one : judged.result->judged->agreement)
      if (one.what == "depths") agreement = one.share;
    EXPECT_GT(agreement, 0.99) << name;
    EXPECT_NEAR(double(judged.result->lights[0].error.wrong), double(drawn_.light().error.wrong),
                border_share * double(drawn_.light().pixels.compared))
        << name;
  }
}

TEST_F(JudgeCameraDepths, AlongTheRayForThoseAlongTheAxisAreNamed) {
  for (const auto& [is, said] : {std::pair{PixelDepth::view_z, PixelDepth::distance},
                                 std::pair{PixelDepth::distance, PixelDepth::view_z}}) {
    Capture wrong = capture({"", is, {}, {}});
    wrong.depth->convention = said;
    EXPECT_NE(reason(judge(wrong, *drawn_.scene)).find("along the ray"), std::string::npos)
        << reason(judge(wrong, *drawn_.scene));
    judge::JudgeOptions fixing;
    fixing.fix = true;
    EXPECT_TRUE(judge(wrong, *drawn_.scene, fixing).result);
  }
  Capture wrong = capture({"", PixelDepth::reversed, 0.1, 200.0});
  wrong.depth->near = 0.2;
  EXPECT_NE(reason(judge(wrong, *drawn_.scene)).find("of the depths agree"), std::string::npos)
      << reason(judge(wrong, *drawn_.scene));
}

/// A sun's scene through an orthographic camera, far away.
Scene parallel_scene() {
  Scene scene = scene_under("sun");
  const double distance = glm::length(scene.camera.target - scene.camera.eye);
  scene.camera.orthographic_height = picture_height(scene.camera, distance);
  scene.camera.eye += 3.0 * (scene.camera.eye - scene.camera.target);
  return scene;
}

TEST(JudgeOrthographic, CapturesGiveTheLadderOfGnomonsOwn) {
  const Compared drawn = draw_scene(parallel_scene(), small_picture, hard_map(256));
  const CapturedDepth even{"", PixelDepth::zero_to_one, 0.1, 200.0},
      reversed{"", PixelDepth::reversed, 0.1, 200.0}, along{"", PixelDepth::view_z, {}, {}},
      ray{"", PixelDepth::distance, {}, {}};
  for (const CapturedDepth* depth :
       {static_cast<const CapturedDepth*>(nullptr), &even, &reversed, &along, &ray}) {
    const CaptureParts parts{.positions = depth == nullptr, .map = true, .depth = depth};
    const JudgeOutcome judged = judge(self_capture(drawn, folder_for("parallel"), parts), *drawn.scene);
    ASSERT_TRUE(judged.result) << reason(judged);
    EXPECT_GT(share_as_drawn(judged), 1.0 - border_share);
    for (const compare::Agreement& one : judged.result->judged->agreement)
      EXPECT_GT(one.share, 0.99) << one.what;
    EXPECT_NEAR(double(judged.result->lights[0].error.wrong), double(drawn.light().error.wrong),
                border_share * double(drawn.light().pixels.compared));
  }
  Capture capture = self_capture(drawn, folder_for("parallel"), {.positions = false, .depth = &reversed});
  capture.depth->far.reset();
  EXPECT_NE(reason(judge(capture, *drawn.scene)).find("depth.far: is missing"), std::string::npos);
}

// Engines name half of the height (Unity, glTF) or all of it (Godot).
TEST(JudgeOrthographic, HalfTheHeightForTheWholeIsNamedAndMended) {
  for (const double factor : {0.5, 2.0}) {
    Scene other = parallel_scene();
    other.camera.orthographic_height *= factor;
    const Compared drawn = draw_scene(other, small_picture, hard_map(256));
    const Capture capture = self_capture(drawn, folder_for("half"), {});
    const JudgeOutcome refused = judge(capture, parallel_scene());
    ASSERT_FALSE(refused.result);
    EXPECT_NE(reason(refused).find(factor < 1.0 ? "for half of it" : "for the whole"), std::string::npos)
        << reason(refused);
    judge::JudgeOptions fixing;
    fixing.fix = true;
    const JudgeOutcome mended = judge(capture, parallel_scene(), fixing);
    ASSERT_TRUE(mended.result) << reason(mended);
    EXPECT_NEAR(mended.scene->camera.orthographic_height, other.camera.orthographic_height, 1e-9);
  }
}

TEST(JudgeRatios, OfTwoPicturesAreTheirLightsVisibility) {
  const Compared drawn = draw_scene(scene_under("sun"), small_picture, hard_map(256));
  for (const bool positions : {true, false}) {
    const CaptureParts parts{.positions = positions, .map = true, .ratio = true};
    const JudgeOutcome judged = judge(self_capture(drawn, folder_for("ratio"), parts), *drawn.scene);
    ASSERT_TRUE(judged.result) << reason(judged);
    EXPECT_TRUE(judged.result->judged->of_ratio);
    EXPECT_GT(share_as_drawn(judged), 1.0 - border_share);
    const compare::LightComparison &own = drawn.light(), &its = judged.result->lights[0];
    const double allowed = border_share * double(own.pixels.compared);
    EXPECT_NEAR(double(its.pixels.compared), double(own.pixels.compared), allowed);
    EXPECT_NEAR(double(its.error.wrong), double(own.error.wrong), allowed);
    EXPECT_NEAR(double(its.pixels.facing_away), double(own.pixels.facing_away), allowed);
  }
}

// What was in shadow is then lit where the other picture is black, and no ratio says so.
TEST(JudgeRatios, OfExchangedPicturesAreNamed) {
  const Compared drawn = draw_scene(scene_under("sun"), small_picture, hard_map(256));
  for (const float ambient : {0.0f, 0.05f}) {
    Capture capture = self_capture(drawn, folder_for("ratio-exchanged"), {.ratio = true});
    for (const std::string& file : {capture.shadowed, capture.unshadowed})
      spoil(file, [=](ChannelImage& image) {
        for (Channel& channel : image.channels)
          for (float& v : channel.values) v += ambient;
      });
    const JudgeOutcome right = judge(capture, *drawn.scene);
    ASSERT_TRUE(right.result) << reason(right);
    std::swap(capture.shadowed, capture.unshadowed);
    EXPECT_NE(reason(judge(capture, *drawn.scene)).find("are exchanged"), std::string::npos);
    judge::JudgeOptions fixing;
    fixing.fix = true;
    const JudgeOutcome mended = judge(capture, *drawn.scene, fixing);
    ASSERT_TRUE(mended.result) << reason(mended);
    EXPECT_EQ(mended.result->judged->mended.size(), 1U);
    EXPECT_EQ(mended.result->lights[0].error.wrong, right.result->lights[0].error.wrong);
  }
}

// A path tracer's two pictures differ by noise where nothing is shadowed.
TEST(JudgeRatios, OfNoiseAreNotExchanged) {
  const Compared drawn = draw_scene(scene_under("sun"), small_picture, hard_map(256));
  const Capture capture = self_capture(drawn, folder_for("ratio-noise"), {.ratio = true});
  std::uint32_t random = 1;
  for (const std::string& file : {capture.shadowed, capture.unshadowed})
    spoil(file, [&](ChannelImage& image) {
      for (Channel& channel : image.channels)
        for (float& v : channel.values) {
          random = random * 1664525U + 1013904223U;
          v *= 0.8f + 0.4f * static_cast<float>(random >> 8) / 16777216.0f;
        }
    });
  const JudgeOutcome judged = judge(capture, *drawn.scene);
  ASSERT_TRUE(judged.result) << reason(judged);
  EXPECT_TRUE(judged.result->judged->mended.empty());
}

// Eight bits show nothing of a spot's rim, which fades out, and of surfaces that the light grazes.
TEST(JudgeRatios, OfEightBitsAreNotSuspectedWhereLittleLightArrives) {
  const Compared drawn = draw_scene(scene_under("lamp"), small_picture, hard_map(256));
  const Capture capture =
      self_capture(drawn, folder_for("ratio-coarse"), {.positions = false, .ratio = true});
  const raytrace::RayTracedFrame& frame = drawn.result.raytraced;
  const Light& light = drawn.scene->lights[0];
  const auto falloff = [&](std::size_t i) {
    const raytrace::SurfacePoint& point = frame.receiver.data[i];
    if (point.primitive == no_id) return 0.0F;
    const LightAtPoint at = light_at(light, point.position);
    return static_cast<float>(std::max(0.0, glm::dot(point.normal, at.to_light))) * at.irradiance.x;
  };
  float brightest = 0.0F;
  for (std::size_t i = 0; i < frame.receiver.data.size(); ++i) brightest = std::max(brightest, falloff(i));
  for (const std::string& file : {capture.shadowed, capture.unshadowed})
    spoil(file, [&](ChannelImage& image) {
      for (Channel& channel : image.channels)
        for (std::size_t i = 0; i < channel.values.size(); ++i) {
          const float before = channel.values[i];
          channel.values[i] = before > 0.0F ? std::round(255.0F * falloff(i) / brightest) / 255.0F : 0.0F;
        }
    });
  const JudgeOutcome judged = judge(capture, *drawn.scene);
  EXPECT_TRUE(judged.result) << reason(judged);
}

TEST(JudgeRatios, UpsideDownAreNamedByWhatTheLightReaches) {
  const Compared drawn = draw_scene(scene_under("sun"), small_picture, hard_map(256));
  const Capture capture =
      self_capture(drawn, folder_for("ratio-flipped"), {.positions = false, .ratio = true});
  for (const std::string& file : {capture.shadowed, capture.unshadowed})
    spoil(file, [](ChannelImage& image) {
      const auto width = static_cast<std::size_t>(image.size.width),
                 height = static_cast<std::size_t>(image.size.height);
      for (Channel& channel : image.channels)
        for (std::size_t y = 0; y < height / 2; ++y)
          std::swap_ranges(channel.values.begin() + std::ptrdiff_t(y * width),
                           channel.values.begin() + std::ptrdiff_t((y + 1) * width),
                           channel.values.begin() + std::ptrdiff_t((height - 1 - y) * width));
    });
  EXPECT_NE(reason(judge(capture, *drawn.scene)).find("upside down"), std::string::npos)
      << reason(judge(capture, *drawn.scene));
}

}  // namespace
}  // namespace gnomon::test
