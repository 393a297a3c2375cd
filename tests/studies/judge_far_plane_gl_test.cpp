// What lies behind a map's far plane is drawn as the renderer likes: it is a cause of its own, and no evidence of another.
#include <algorithm>

#include "scene/files/pictures/image_io.h"
#include "tests/support/judged_engine.h"

namespace gnomon::test {
namespace {

using compare::Label;

/// A sun's map that ends before this share of the picture's receivers, and what is drawn of these: `behind` of a pixel's place in
/// the picture and what the test says.
Engine engine_that_ends(const std::string& name, double share,
                        const std::function<float(std::size_t, float)>& behind) {
  Engine engine(name, 0.002);
  Mat4& matrix = *engine.capture.map[0].clip_from_world;
  const Image<raytrace::SurfacePoint>& receivers = engine.drawn.result.raytraced.receiver;
  std::vector<double> numbers;
  const auto number_of = [&](const raytrace::SurfacePoint& point) {
    return (matrix * Vec4(point.position, 1.0)).z;
  };
  for (const raytrace::SurfacePoint& point : receivers.data)
    if (point.primitive != no_id) numbers.push_back(number_of(point));
  std::sort(numbers.rbegin(), numbers.rend());
  const auto count = static_cast<std::size_t>(share * double(numbers.size())) + 1;
  const double end = 0.5 * (numbers.at(count - 1) + numbers.at(count));
  for (int column = 0; column < 4; ++column) matrix[column][2] /= end;
  engine.capture.bias->constant_depth /= end;
  spoil(engine.capture.map[0].depth, [&](ChannelImage& image) {
    for (float& v : image.channels[0].values) v = std::min(1.0f, static_cast<float>(double{v} / end));
  });
  draw_again(engine.capture, engine.drawn);
  spoil(engine.capture.visibility, [&](ChannelImage& image) {
    std::vector<float>& values = image.channels[0].values;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (receivers.data[i].primitive != no_id && number_of(receivers.data[i]) > 1.0)
        values[i] = behind(i, values[i]);
  });
  return engine;
}

float lit(std::size_t, float) {
  return 1.0f;
}
float dark(std::size_t, float) {
  return 0.0f;
}
float every_other(std::size_t i, float) {
  return i % 2 == 0 ? 1.0f : 0.0f;
}

constexpr const char* chance = "no better than chance";
constexpr const char* other_test = "is not the one that was drawn";

TEST(JudgeFarPlane, IsACauseAndNotChance) {
  for (const double share : {0.7, 0.8, 0.9, 0.96})
    for (const auto& behind : {lit, dark, every_other}) {
      const JudgeOutcome judged = engine_that_ends("far-most", share, behind).judged();
      ASSERT_TRUE(judged.result) << reason(judged);
      EXPECT_NE(notes_in(judged).find("lie behind the map's far plane"), std::string::npos) << share;
      EXPECT_EQ(notes_in(judged).find(chance), std::string::npos) << share << ": " << notes_in(judged);
    }
}

TEST(JudgeFarPlane, TellsNothingOfTheTest) {
  for (const double share : {0.003, 0.03, 0.2, 0.4, 0.6, 0.8, 0.9})
    for (const auto& behind : {lit, dark, every_other}) {
      const JudgeOutcome judged = engine_that_ends("far-some", share, behind).judged();
      ASSERT_TRUE(judged.result) << reason(judged);
      for (const char* words : {other_test, "if ", "for its reader"})
        EXPECT_EQ(notes_in(judged).find(words), std::string::npos) << share << ": " << notes_in(judged);
    }
}

// The constant that the capture says is another one: that is told by what lies before the far plane.
TEST(JudgeFarPlane, HidesNoOtherConstant) {
  for (const auto& behind : {lit, dark, every_other}) {
    Engine engine = engine_that_ends("far-constant", 0.2, behind);
    engine.capture.bias->constant_depth *= 60.0;
    const JudgeOutcome judged = engine.judged();
    ASSERT_TRUE(judged.result) << reason(judged);
    EXPECT_NE(notes_in(judged).find("if `constant_depth` is about"), std::string::npos) << notes_in(judged);
  }
}

}  // namespace
}  // namespace gnomon::test
