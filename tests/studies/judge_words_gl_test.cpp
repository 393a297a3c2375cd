// What is said of another renderer's map is what its capture says, and nothing of Gnomon's own settings.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/result/judged.h"
#include "compare/result/layout.h"
#include "compare/result/map_words.h"
#include "compare/result/outputs.h"
#include "tests/support/capture_support.h"

namespace gnomon::test {
namespace {

using judge::Capture;
using judge::StoredDepth;

struct Said {
  JudgeOutcome judged;
  std::string map, filter, window;
  nlohmann::json json;  ///< lights[0].map of result.json
};

Said said_of(const Capture& capture, const Scene& scene) {
  Said out{judge(capture, scene), {}, {}, {}, {}};
  EXPECT_TRUE(out.judged.result) << reason(out.judged);
  if (!out.judged.result) return out;
  const compare::Comparison& c = *out.judged.result;
  out.map = compare::map_details(c, &c.lights[0]), out.filter = compare::filter_text(c.raster);
  out.window = compare::window_words(c, c.lights[0]);
  out.json = nlohmann::json::parse(compare::result_json(c))["lights"][0]["map"];
  return out;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(WordsOfACapture, SayItsFiltersParametersAlone) {
  const Compared drawn = draw_scene(scene_under("sun"), small_picture, hard_map(128));
  Capture capture = self_capture(drawn, folder_for("words-evsm"), {.map = true});
  capture.filter->kind = judge::FilterName::evsm, capture.filter->exponents = {15.0};
  capture.filter->light_bleeding_reduction = 0.1;
  store_moments(capture);
  const Said said = said_of(capture, *drawn.scene);
  EXPECT_TRUE(has(said.filter, ", exponent 15")) << said.filter;
  EXPECT_TRUE(has(said.filter, ", bleeding reduction 0.1")) << said.filter;
  EXPECT_FALSE(has(said.filter, "negative") || has(said.filter, "mipmaps")) << said.filter;
  EXPECT_TRUE(has(said.map, "moments") && !has(said.map, "d32f")) << said.map;
  EXPECT_EQ(said.json["filter"]["exponent"], 15.0);
  EXPECT_FALSE(said.json["filter"].contains("negative_exponent"));
  EXPECT_FALSE(said.json["filter"].contains("mipmaps"));
}

TEST(WordsOfACapture, SayNoKernelThatItDoesNot) {
  const Compared drawn = draw_scene(scene_under("sun"), small_picture, hard_map(128));
  Capture capture = self_capture(drawn, folder_for("words-pcf"), {.map = true});
  capture.filter->kind = judge::FilterName::pcf;
  const Said said = said_of(capture, *drawn.scene);
  EXPECT_EQ(said.filter, "pcf, radius 1.5 texels");
  EXPECT_EQ(said.json["filter"]["kind"], "pcf");
}

TEST(WordsOfACapture, SayWhatItsTexelsHold) {
  for (const StoredDepth stored : {StoredDepth::distance, StoredDepth::linear_z}) {
    const Compared drawn = draw_scene(scene_under("lamp"), small_picture, hard_map(128));
    const Said said = said_of(
        self_capture(drawn, folder_for("words-stored"), {.map = true, .stored = stored}), *drawn.scene);
    EXPECT_TRUE(has(said.map, stored == StoredDepth::distance ? ", distances" : ", linear depths"))
        << said.map;
    EXPECT_TRUE(said.json["depth_format"].is_null());
  }
}

// Depth between 0 and 1 of a perspective map: the unit grows with the square of the distance.
TEST(WordsOfACapture, SayBothEndsOfAConstantThatIsNoOneLength) {
  raster::MapOptions map = hard_map(128);
  map.bias.constant = 0.0;
  const Compared drawn = draw_scene(scene_under("lamp"), small_picture, map);
  Capture capture =
      self_capture(drawn, folder_for("words-ends"), {.map = true, .stored = StoredDepth::zero_to_one});
  capture.bias->constant_depth = 0.001;
  const Said said = said_of(capture, *drawn.scene);
  const auto& [near, far] = said.judged.result->judged->units;
  EXPECT_GT(far.distance, 1.2 * near.distance);
  EXPECT_NEAR(far.world / near.world, far.distance * far.distance / (near.distance * near.distance), 1e-9);
  EXPECT_TRUE(has(said.map, "bias 0.001 of stored depth (") && has(said.map, " from the light, "))
      << said.map;
  for (const compare::Advice& advice : said.judged.result->judged->advice) {
    const bool has_length = advice.setting == "bias.constant_depth" && advice.instead != 0.0;
    const std::string text = compare::advice_text(advice);
    EXPECT_TRUE(!has_length || has(text, "from the light")) << text;
  }
  // Distances have one.
  Capture distances =
      self_capture(drawn, folder_for("words-ends"), {.map = true, .stored = StoredDepth::distance});
  distances.bias->constant_depth = 0.001;
  EXPECT_FALSE(has(said_of(distances, *drawn.scene).map, "from the light"));
}

TEST(WordsOfACapture, SayItsWindowAndWhatIsDrawnBesideIt) {
  const Compared drawn = draw_scene(scene_under("sun"), small_picture, hard_map(128));
  Capture capture = self_capture(drawn, folder_for("words-window"), {.map = true});
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 2; ++row) (*capture.map[0].clip_from_world)[column][row] *= 3.0;
  for (const float outside : {0.0f, 1.0f}) {
    draw_again(capture, drawn, outside);
    const Said said = said_of(capture, *drawn.scene);
    EXPECT_TRUE(said.window.starts_with("The capture's map is ")) << said.window;
    EXPECT_EQ(has(said.window, "drawn as shadow"), outside == 0.0f) << said.window;
    EXPECT_EQ(has(said.window, "drawn as lit"), outside == 1.0f) << said.window;
  }
}

}  // namespace
}  // namespace gnomon::test
