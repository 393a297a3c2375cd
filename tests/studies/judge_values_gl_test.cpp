// What a captured picture's values mean: encoded ones, those of other light, and those of a shadow that is not dark.
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "compare/result/judged.h"
#include "scene/files/pictures/image_io.h"
#include "tests/support/capture_support.h"

namespace gnomon::test {
namespace {

using judge::Capture;
using raster::Technique;

template <class Change>
void change_values(const std::string& file, const Change& change) {
  spoil(file, [&](ChannelImage& image) {
    for (Channel& channel : image.channels)
      for (float& v : channel.values) v = change(v);
  });
}

// In 8 bits a grey lies up to half a step beside the multiple that it is of, as it is stored.
TEST(JudgeValues, SrgbOfEightBitsIsNamed) {
  raster::MapOptions soft = hard_map(256, Technique::pcf);
  soft.filter.radius_texels = 1.5;
  const Compared drawn = draw_builtin("teapot", small_picture, soft);
  const Capture capture = self_capture(drawn, folder_for("srgb8"), {});
  EXPECT_TRUE(judge(capture, *drawn.scene).result);
  change_values(capture.visibility,
                [](float v) { return std::round(255.0f * srgb_from_linear(v)) / 255.0f; });
  EXPECT_NE(reason(judge(capture, *drawn.scene)).find("sRGB-encoded"), std::string::npos)
      << reason(judge(capture, *drawn.scene));
}

std::string notes_on(const Compared& drawn, const std::function<float(float)>& change) {
  const Capture capture = self_capture(drawn, folder_for("range"), {});
  change_values(capture.visibility, change);
  const JudgeOutcome judged = judge(capture, *drawn.scene);
  if (!judged.result) return "refused: " + reason(judged);
  return fmt::format("{}", fmt::join(judged.result->judged->notes, "\n"));
}

// One grey, that of a shadow which ambient light or a strength below one lightens, is no encoding.
TEST(JudgeValues, ShadowsThatAreNotDarkAreSaid) {
  const Compared drawn = draw_builtin("teapot", small_picture, hard_map(256));
  EXPECT_EQ(notes_on(drawn, [](float v) { return v; }), "");
  for (const float ambient : {0.1f, 0.2f, 0.35f, 0.4f})
    EXPECT_EQ(
        notes_on(drawn, [=](float v) { return ambient + (1.0f - ambient) * v; }),
        fmt::format(
            "the picture is nowhere darker than {:.3g}, where full shadow is 0: other light in it, or a "
            "shadow's strength, counts as error",
            ambient));
  for (const float strength : {0.55f, 0.8f})
    EXPECT_EQ(notes_on(drawn, [=](float v) { return strength * v; }),
              fmt::format(
                  "the picture is nowhere lighter than {:.3g}, where full light is 1: what is missing counts "
                  "as error",
                  strength));
}

// A picture of that part of the side, rounded down, is stretched over the whole; each of its pixels is one that stands under it.
void enlarge(const std::string& file, int block) {
  spoil(file, [&](ChannelImage& image) {
    const auto under = [block](int i, int side) {
      const int parts = side / block, part = (2 * i + 1) * parts / (2 * side);
      return (2 * part + 1) * side / (2 * parts);
    };
    for (Channel& channel : image.channels) {
      const std::vector<float> from = channel.values;
      for (int y = 0; y < image.size.height; ++y)
        for (int x = 0; x < image.size.width; ++x) {
          const auto at = [w = std::size_t(image.size.width)](int i, int j) {
            return std::size_t(j) * w + std::size_t(i);
          };
          channel.values[at(x, y)] = from[at(under(x, image.size.width), under(y, image.size.height))];
        }
    }
  });
}

TEST(JudgeValues, ShadowsOfLowerResolutionAreSaid) {
  for (const ImageSize size : {small_picture, ImageSize{128, 72}, ImageSize{130, 75}})
    for (const char* scene : {"fence", "teapot", "floating-box", "sphere-plane"}) {
      const Compared drawn = draw_builtin(scene, size, hard_map(256));
      for (const int block : {2, 3, 4, 5, 8}) {
        const Capture capture = self_capture(drawn, folder_for("blocks"), {});
        enlarge(capture.visibility, block);
        const JudgeOutcome judged = judge(capture, *drawn.scene);
        ASSERT_TRUE(judged.result) << reason(judged);
        EXPECT_NE(fmt::format("{}", fmt::join(judged.result->judged->notes, "\n"))
                      .find(fmt::format("blocks of {0} x {0} pixels", block)),
                  std::string::npos)
            << scene << ' ' << block << ' ' << size.width;
      }
      EXPECT_EQ(notes_on(drawn, [](float v) { return v; }), "") << scene;
    }
}

// Then something is drawn where the light does not arrive, which another camera seems to explain. A haze takes no surface's colour.
TEST(JudgeValues, AHazeInARatioIsNoOtherCameraAndIsUndone) {
  const Compared drawn = draw_builtin("courtyard", small_picture, hard_map(256));
  const Capture capture = self_capture(drawn, folder_for("ambient"), {.positions = false, .ratio = true});
  EXPECT_TRUE(judge(capture, *drawn.scene).result);
  for (const std::string& file : {capture.shadowed, capture.unshadowed})
    change_values(file, [](float v) { return v + 0.1f; });
  const JudgeOutcome judged = judge(capture, *drawn.scene);
  ASSERT_TRUE(judged.result) << reason(judged);
  EXPECT_TRUE(judged.result->judged->other_light);
  EXPECT_TRUE(judged.result->judged->mended.empty());
  const double allowed = 0.01 * double(drawn.light().pixels.compared);
  EXPECT_NEAR(double(judged.result->lights[0].error.wrong), double(drawn.light().error.wrong), allowed);
}

}  // namespace
}  // namespace gnomon::test
