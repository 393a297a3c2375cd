// gnomon judge on captures that Gnomon made of its own pictures: with the map the same ladder, right ones pass,
// each wrong convention is named, bad ones are refused in one line.
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>

#include "compare/result/judged.h"
#include "compare/result/outputs.h"
#include "compare/result/result_schema.h"
#include "judge/captured_map.h"
#include "report/write_outputs.h"
#include "scene/files/pictures/image_io.h"
#include "scene/files/read_file.h"
#include "tests/support/capture_support.h"
#include "tests/support/json_schema_check.h"
#include "tests/support/places.h"
#include "tests/support/small_scenes.h"

namespace gnomon::test {
namespace {

using judge::Capture;
using raster::Technique;

void expect_same_ladder(const Compared& drawn, const JudgeOutcome& judged) {
  ASSERT_TRUE(judged.result) << reason(judged);
  const compare::LightComparison &own = drawn.light(), &its = judged.result->lights[0];
  EXPECT_GT(judged.result->judged->biased_is_drawn, 1.0 - border_share);
  // The rasterizer's own edges, which the capture hides behind the ray tracer's positions, are silhouettes.
  const double allowed = border_share * static_cast<double>(own.pixels.compared);
  EXPECT_NEAR(double(own.pixels.compared), double(its.pixels.compared), allowed);
  for (std::size_t k = 0; k < compare::class_count; ++k)
    EXPECT_NEAR(double(own.classes[k]), double(its.classes[k]), allowed)
        << compare::label_name(static_cast<compare::Label>(k + 1));
  for (std::size_t k = 0; k < compare::rung_count; ++k)
    EXPECT_NEAR(own.rung_mean[k], its.rung_mean[k], border_share) << "V" << k;
  EXPECT_NEAR(own.best_bias.wrong_fraction, its.best_bias.wrong_fraction, border_share);
}

TEST(JudgeLadder, OfASunIsThatOfItsOwnMap) {
  const Compared drawn = draw_builtin("courtyard", small_picture, hard_map(256));
  const Capture capture = self_capture(drawn, folder_for("sun"), {.map = true});
  expect_same_ladder(drawn, judge(capture));
  const auto read = judge::read_capture(write_json(capture, folder_for("sun")));
  ASSERT_TRUE(read) << read.error().message();
  expect_same_ladder(drawn, judge(*read));
}

// Distances are compared along the texel's ray, Gnomon's own depths along the receiver's: a texel of 128 is
// 0.7 degrees wide, so that acne's stripes differ by a few pixels in a hundred.
TEST(JudgeLadder, OfAPointLightsCubeToo) {
  const Compared drawn = draw_builtin("sphere-plane", small_picture, hard_map(128));
  const JudgeOutcome judged = judge(self_capture(drawn, folder_for("cube"), {.map = true}));
  ASSERT_TRUE(judged.result) << reason(judged);
  EXPECT_GT(judged.result->judged->biased_is_drawn, 0.95);
  const compare::LightComparison &own = drawn.light(), &its = judged.result->lights[0];
  for (const std::size_t rung : {0U, 1U, 2U, 3U, 6U})
    EXPECT_NEAR(own.rung_mean[rung], its.rung_mean[rung], border_share) << "V" << rung;
}

TEST(JudgeLadder, WithoutAMapHasOneStepUnexplained) {
  const Compared drawn = draw_builtin("courtyard", small_picture, hard_map(128));
  const JudgeOutcome judged = judge(self_capture(drawn, folder_for("plain"), {}));
  ASSERT_TRUE(judged.result) << reason(judged);
  const compare::LightComparison& light = judged.result->lights[0];
  EXPECT_NEAR(double(light.error.wrong), double(drawn.light().error.wrong),
              border_share * double(light.pixels.compared));
  EXPECT_GT(light.error.wrong, 0U);
  EXPECT_EQ(light.classes[static_cast<std::size_t>(compare::Label::unexplained) - 1], light.error.wrong);
  EXPECT_NEAR(light.budget[1].signed_mean, light.rung_mean[6] - light.rung_mean[0], 1e-12);
}

TEST(JudgeOutputs, AreWholeWithAMapAndWithout) {
  const nlohmann::json schema = compare::result_schema();
  const Compared drawn = draw_builtin("courtyard", small_picture, hard_map(256));
  for (const bool map : {true, false}) {
    const JudgeOutcome judged = judge(self_capture(drawn, folder_for("outputs"), {.map = map}));
    ASSERT_TRUE(judged.result) << reason(judged);
    const std::string folder = folder_for(map ? "report-map" : "report-plain");
    std::filesystem::create_directories(folder);
    const auto written = report::write_outputs(*judged.result, {.folder = folder});
    ASSERT_TRUE(written) << written.error().message();
    const nlohmann::json result = nlohmann::json::parse(std::ifstream(folder + "/result.json"));
    EXPECT_EQ(SchemaCheck(schema).violations(result), std::vector<std::string>{});
    EXPECT_EQ(result["judged"]["map"], map);
    EXPECT_EQ(result["lights"][0]["budget"].size(), map ? 7U : 2U);
    EXPECT_EQ(judged.result->judged->advice_sought, map);
    EXPECT_EQ(result["lights"][0]["map"]["inferred"], false);
    const std::string page = *read_file(folder + "/report.html");
    EXPECT_EQ(page.find("a shadow whose map is not known") == std::string::npos, map);
    EXPECT_NE(page.find("[\"drawn by\","), std::string::npos);
    EXPECT_NE(compare::summary_table(*judged.result, false).find("drawn by"), std::string::npos);
  }
}

// Thin wires under a sun: nearly every bias from a few hundredths on is as good as the best, which lies far out.
TEST(JudgeAdvice, IsTheSmallestConstantThatIsHardlyWorseThanTheBest) {
  const Compared drawn = draw_builtin("wires", small_picture, hard_map(512));
  Capture capture = self_capture(drawn, folder_for("advice"), {.map = true});
  capture.bias->constant_depth = 0.0;
  draw_again(capture, drawn);
  const JudgeOutcome judged = judge(capture);
  ASSERT_TRUE(judged.result) << reason(judged);
  ASSERT_FALSE(judged.result->judged->advice.empty());
  const compare::Advice& advice = judged.result->judged->advice.front();
  const compare::BestBias& best = judged.result->lights[0].best_bias;
  EXPECT_LT(advice.instead * judged.result->judged->unit_world, 0.5 * best.constant_world);
  // compare/bias/bias_kinds.h: one pixel in 100,000, or one wrong pixel in fifty.
  EXPECT_LE(advice.wrong_instead, best.wrong_fraction + std::max(1e-5, best.wrong_fraction / 50.0));
  // Where it is used already no other one is advised.
  capture.bias->constant_depth = advice.instead;
  draw_again(capture, drawn);
  const JudgeOutcome again = judge(capture);
  ASSERT_TRUE(again.result) << reason(again);
  for (const compare::Advice& other : again.result->judged->advice) EXPECT_NE(other.setting, advice.setting);
}

// ---- conventions ----

struct Convention {
  std::string name;  ///< a part of what must be named
  CaptureParts parts;
  std::function<void(Capture&, const Compared&)> wrong;
};

void flip(const std::string& file, bool x, bool y) {
  spoil(file, [&](ChannelImage& image) {
    for (Channel& channel : image.channels) {
      const std::vector<float> from = channel.values;
      const int w = image.size.width, h = image.size.height;
      for (int j = 0; j < h; ++j)
        for (int i = 0; i < w; ++i)
          channel.values[std::size_t(j * w + i)] =
              from[std::size_t((y ? h - 1 - j : j) * w + (x ? w - 1 - i : i))];
    }
  });
}

/// The picture moved by so many pixels; what comes in at its border is the border's.
void move(const std::string& file, int x, int y) {
  spoil(file, [&](ChannelImage& image) {
    const int w = image.size.width, h = image.size.height;
    const auto at = [&](int i, int j) {
      return static_cast<std::size_t>(j) * static_cast<std::size_t>(w) + static_cast<std::size_t>(i);
    };
    for (Channel& channel : image.channels) {
      const std::vector<float> from = channel.values;
      for (int j = 0; j < h; ++j)
        for (int i = 0; i < w; ++i)
          channel.values[at(i, j)] = from[at(std::clamp(i - x, 0, w - 1), std::clamp(j - y, 0, h - 1))];
    }
  });
}

void map_places(const Capture& capture, const Mat3& captured_from_scene) {
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

/// The places that another view sees, so many pixels beside the centres.
void show_places(const Capture& capture, const Compared& drawn, const View& view, double shift) {
  const raytrace::Tracer tracer(*drawn.world, raytrace::Accel::bvh);
  spoil(capture.position, [&](ChannelImage& image) {
    for (int j = 0; j < small_picture.height; ++j)
      for (int i = 0; i < small_picture.width; ++i) {
        const Ray ray = pixel_ray(view, i + 0.5 + shift, j + 0.5 + shift);
        const auto hit = tracer.closest_hit(ray);
        const Vec3 p = hit ? ray.at(hit->t) : Vec3(0.0);
        for (Channel& channel : image.channels)
          channel.values[std::size_t(j * small_picture.width + i)] =
              channel.name == "A" ? (hit ? 1.0f : 0.0f) : static_cast<float>(p[channel.name[0] - 'X']);
      }
  });
}

/// The scene drawn by another camera or light than the file's.
Capture drawn_otherwise(const Compared& drawn, const std::string& name,
                        const std::function<void(Scene&)>& change, const CaptureParts& parts) {
  Scene scene = *drawn.scene;
  change(scene);
  compare::CompareOptions options = test_options(small_picture, 512);
  options.raster.map = drawn.result.raster.options.map;
  options.perceptual = false;
  const Compared other = run_comparison(std::move(scene), options);
  return self_capture(other, folder_for(name), parts);
}

const std::vector<Convention>& conventions() {
  const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  static const std::vector<Convention> all{
      {"upside down",
       {},
       [](Capture& c, const Compared&) { flip(c.visibility, false, true), flip(c.position, false, true); }},
      {"mirrored",
       {},
       [](Capture& c, const Compared&) { flip(c.visibility, true, false), flip(c.position, true, false); }},
      {"upside down",
       {.positions = false, .mask = true},
       [](Capture& c, const Compared&) { flip(c.visibility, false, true); }},
      {"half a pixel",
       {},
       [](Capture& c, const Compared& d) {
         show_places(c, d, make_view(d.scene->camera, small_picture), 0.5);
       }},
      {"some pixels off (x +2, y -1)",
       {.positions = false, .mask = true},
       [](Capture& c, const Compared&) { move(c.visibility, -2, 1); }},
      {"field of view",
       {.positions = false, .mask = true},
       [](Capture& c, const Compared& d) {
         c = drawn_otherwise(d, "fov",
                             [](Scene& s) {
                               const double aspect = double(small_picture.width) / small_picture.height;
                               s.camera.vertical_fov =
                                   2.0 * std::atan(std::tan(0.5 * s.camera.vertical_fov) / aspect);
                             },
                             {.positions = false, .mask = true});
       }},
      {"aspect",
       {},
       [](Capture& c, const Compared& d) {
         View view = make_view(d.scene->camera, small_picture);
         view.tan_half_x = view.tan_half_y * 4.0 / 3.0;
         show_places(c, d, view, 0.0);
       }},
      {"sRGB",
       {},
       [](Capture& c, const Compared&) {
         spoil(c.visibility, [](ChannelImage& image) {
           for (float& v : image.channels[0].values) v = srgb_from_linear(v);
         });
       }},
      {"gamma of 2.2",
       {},
       [](Capture& c, const Compared&) {
         spoil(c.visibility, [](ChannelImage& image) {
           for (float& v : image.channels[0].values) v = std::pow(v, 1.0f / 2.2f);
         });
       }},
      {"z-up", {}, [x, y, z](Capture& c, const Compared&) { map_places(c, Mat3(x, z, -y)); }},
      {"left-handed", {}, [x, y, z](Capture& c, const Compared&) { map_places(c, Mat3(x, y, -z)); }},
      {"centimetres", {}, [](Capture& c, const Compared&) { map_places(c, Mat3(100.0)); }}};
  return all;
}

// What temporal antialiasing shifts the camera by is no half pixel that somebody forgot, where the capture says it.
TEST(Judge, OfAShiftedCameraIsJudgedWhereItsPixelsLook) {
  const Compared drawn = draw_builtin("floating-box", small_picture, hard_map(256));
  Capture capture = self_capture(drawn, folder_for("jitter"), {});
  show_places(capture, drawn, make_view(drawn.scene->camera, small_picture), 0.3);
  const JudgeOutcome refused = judge(capture, *drawn.scene);
  capture.jitter = {0.3, 0.3};
  const JudgeOutcome judged = judge(capture, *drawn.scene);
  ASSERT_TRUE(judged.result.has_value()) << reason(judged);
  EXPECT_FALSE(refused.result.has_value());
}

class JudgeConventions : public testing::TestWithParam<const char*> {};

TEST_P(JudgeConventions, AreNamedAndMended) {
  raster::MapOptions soft = hard_map(256, Technique::pcf);
  soft.bias = {.constant = 1.0, .slope = 1.0};
  soft.filter.radius_texels = 2.5;
  const Compared drawn = draw_builtin(GetParam(), small_picture, soft);
  for (const Convention& convention : conventions()) {
    Capture capture = self_capture(drawn, folder_for(std::string("wrong-") + GetParam()), convention.parts);
    convention.wrong(capture, drawn);
    const JudgeOutcome refused = judge(capture);
    EXPECT_FALSE(refused.result) << convention.name;
    EXPECT_NE(reason(refused).find(convention.name), std::string::npos)
        << convention.name << ": " << reason(refused);
    judge::JudgeOptions fixing;
    fixing.fix = true;
    const JudgeOutcome mended = judge(capture, fixing);
    ASSERT_TRUE(mended.result) << convention.name << ": " << reason(mended);
    EXPECT_EQ(mended.result->judged->mended.size(), 1U) << convention.name;
  }
}
// GNOMON_JUDGE=all in the environment: three scenes and twenty right captures in place of one and five.
bool try_all() {
  return std::getenv("GNOMON_JUDGE") != nullptr;
}
INSTANTIATE_TEST_SUITE_P(OnScenes, JudgeConventions,
                         testing::ValuesIn(try_all()
                                               ? std::vector<const char*>{"courtyard", "fence", "teapot"}
                                               : std::vector<const char*>{"teapot"}));

/// The picture as it is under the sun turned round.
Capture drawn_with_light_turned(const Compared& drawn) {
  return drawn_otherwise(drawn, "light",
                         [&](Scene& scene) {
                           Light& light = scene.lights[drawn.light().light];
                           light.direction = -light.direction;
                         },
                         {});
}

JudgeOutcome judge_mending(const Capture& capture, const Scene& scene) {
  judge::JudgeOptions fixing;
  fixing.fix = true;
  return judge(capture, scene, fixing);
}

// Two boxes without a floor, seen from the side: whichever way the sun shines, it lights some of what is seen, and one
// box shadows the other.
TEST(JudgeAlignment, MendsALightThatShinesTheOtherWay) {
  Scene boxes = sunlit_scene(
      {box_mesh({-1.2, -0.2, -0.9}, {-0.2, 1.2, 0.9}), box_mesh({0.3, 0.1, -0.4}, {1.1, 0.9, 0.4})},
      {1.0, -0.3, -0.2});
  boxes.camera = {.eye = {3.0, 2.5, 3.0}, .target = {0.0, 0.5, 0.0}, .vertical_fov = 0.7};
  const Compared drawn = draw_scene(boxes, small_picture, hard_map(256));
  const Capture capture = drawn_with_light_turned(drawn);
  EXPECT_NE(reason(judge(capture, boxes)).find("shines the other way"), std::string::npos);
  const JudgeOutcome mended = judge_mending(capture, boxes);
  ASSERT_TRUE(mended.result) << reason(mended);
  ASSERT_EQ(mended.result->judged->mended.size(), 1U);
  const compare::LightComparison& light = mended.result->lights[0];
  EXPECT_GT(light.pixels.compared, 300U);
  EXPECT_GT(light.rung_mean[0], 0.1);
  EXPECT_LT(light.error.wrong_fraction, 0.05);
}

// From below a floor the sun lights nothing, and a black picture says nothing of its shadows.
TEST(JudgeAlignment, LeavesALightThatWouldLightNothing) {
  const Compared drawn = draw_builtin("teapot", small_picture, hard_map(256));
  const Capture turned = drawn_with_light_turned(drawn);
  Capture black = self_capture(drawn, folder_for("black"), {});
  spoil(black.visibility, [](ChannelImage& image) {
    std::fill(image.channels[0].values.begin(), image.channels[0].values.end(), 0.0f);
  });
  for (const Capture& capture : {turned, black}) {
    const JudgeOutcome outcome = judge_mending(capture, *drawn.scene);
    EXPECT_FALSE(outcome.result);
    EXPECT_NE(reason(outcome).find("the light shines the other way"), std::string::npos) << reason(outcome);
    EXPECT_NE(reason(outcome).find("then the light reaches nothing that the picture shows"),
              std::string::npos)
        << reason(outcome);
  }
}

/// What is said of a capture that is judged.
std::string notes_of(const Capture& capture, const Scene& scene) {
  const JudgeOutcome outcome = judge(capture, scene);
  if (!outcome.result) return reason(outcome);
  return fmt::format("{}", fmt::join(outcome.result->judged->notes, "\n"));
}

// Shadows that are some pixels off may be wrong ones: with nothing else in the capture nobody can tell.
TEST(JudgeAlignment, SaysWhenShadowsAloneTellTooLittle) {
  const Compared drawn = draw_builtin("teapot", small_picture, hard_map(256));
  const auto shifted = [](ChannelImage& image) {
    std::vector<float>& values = image.channels[0].values;
    std::rotate(values.begin(), values.begin() + 6, values.end());
  };
  const std::string note = "whether the rest are wrong or the picture is some pixels off";
  for (const bool positions : {false, true}) {
    Capture capture = self_capture(drawn, folder_for("shifted"), {.positions = positions});
    EXPECT_EQ(notes_of(capture, *drawn.scene), "");
    spoil(capture.visibility, shifted);
    EXPECT_EQ(notes_of(capture, *drawn.scene).find(note) != std::string::npos, !positions)
        << notes_of(capture, *drawn.scene);
  }
}

TEST(JudgeAlignment, DoesNotSuspectRightCaptures) {
  int judged = 0;
  const std::vector<const char*> scenes =
      try_all() ? std::vector{"courtyard", "fence", "teapot", "whitted"} : std::vector{"teapot"};
  for (const char* scene : scenes)
    for (const Technique technique :
         {Technique::hard, Technique::pcf, Technique::vsm, Technique::esm, Technique::second_depth}) {
      raster::MapOptions map = hard_map(judged % 2 == 0 ? 128 : 512, technique);
      if (judged % 3 == 0) map.bias = {.constant = 1.0, .slope = 1.0};
      const Compared drawn = draw_builtin(scene, small_picture, map);
      CaptureParts parts{.positions = judged % 2 == 0, .mask = judged % 4 == 1};
      const JudgeOutcome outcome = judge(self_capture(drawn, folder_for("right"), parts));
      EXPECT_TRUE(outcome.result) << scene << ": " << reason(outcome);
      ++judged;
    }
  EXPECT_EQ(judged, try_all() ? 20 : 5);
}

}  // namespace
}  // namespace gnomon::test
