// What is said of the test that a capture describes: which bias would have been better, and where the map or the test
// is not that of the picture.
#include "compare/verdict.h"
#include "scene/files/image_io.h"
#include "support/capture_support.h"
#include "support/other_renderer.h"

namespace gnomon::test {
namespace {

using compare::Capture;
using compare::StoredDepth;

/// A sun's map of 512 texels and the picture that another renderer draws on it with this bias.
struct OtherPicture {
  Compared drawn = draw_scene(scene_under("sun"), small_picture, hard_map(512));
  Capture capture;
  OtherPicture(const std::string& name, const compare::CapturedBias& bias) {
    capture = self_capture(drawn, folder_for(name), {.map = true, .stored = StoredDepth::zero_to_one});
    draw_with(bias);
  }
  void draw_with(const compare::CapturedBias& bias) {
    capture.bias = bias;
    draw_again(capture, drawn);
  }
  JudgeOutcome judged() const { return judge(capture, *drawn.scene); }
};

/// The bias that the advice asks for.
compare::CapturedBias advised(const Capture& capture, const std::vector<compare::Advice>& advice) {
  compare::CapturedBias bias = *capture.bias;
  for (const compare::Advice& one : advice)
    (one.setting == "bias.normal_offset_world" ? bias.normal_offset_world : bias.constant_depth) =
        one.instead;
  return bias;
}

// A normal offset of many texels moves the shadows' edges: without it, or with less, a constant does better.
TEST(JudgeAdvice, LowersANormalOffsetThatIsTooLarge) {
  OtherPicture picture("offset", {.constant_depth = 0.0002, .normal_offset_world = 0.3});
  const JudgeOutcome judged = picture.judged();
  ASSERT_TRUE(judged.result) << reason(judged);
  const std::vector<compare::Advice>& advice = judged.result->judged->advice;
  ASSERT_EQ(advice.size(), 3U);
  EXPECT_EQ(advice[1].setting, "bias.normal_offset_world");
  EXPECT_LT(advice[1].instead, 0.15);
  EXPECT_LT(advice[1].wrong_instead, 0.5 * judged.result->lights[0].error.wrong_fraction);
  EXPECT_NE(
      compare::verdict_on(*judged.result, judged.result->lights[0]).headline.find("bias.normal_offset_world"),
      std::string::npos);
  // What the advice promises is what the other renderer then draws.
  picture.draw_with(advised(picture.capture, advice));
  const JudgeOutcome again = picture.judged();
  ASSERT_TRUE(again.result) << reason(again);
  EXPECT_NEAR(again.result->lights[0].error.wrong_fraction, advice[1].wrong_instead, 2e-4);
}

}  // namespace
}  // namespace gnomon::test
