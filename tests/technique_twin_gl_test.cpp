// What each technique draws (V6) is its bias and its texel in double precision (V5), but for a few pixels on
// texel borders; and the whole ladder adds up. The same for every depth format.
#include "support/compare_support.h"
#include "support/one_world.h"
#include "tests/raster_scenes.h"

namespace gnomon::test {
namespace {

using raster::DepthFormat;
using raster::Technique;

struct Case {
  const char* name;
  Technique technique;
  LightType light;
  DepthFormat format = DepthFormat::d32f;
  bool adaptive = false;
  bool receiver_plane = false;
  bool texel_bias = false;   ///< the default: one texel
  double most_wrong = 0.03;  ///< a sanity check: acne and aliasing at this coarse map
};

class Twin : public testing::TestWithParam<Case> {};

TEST_P(Twin, DrawnIsTheBiasedRung) {
  const Case c = GetParam();
  Scene scene = still_life(c.light != LightType::spot);
  scene.lights = {c.light == LightType::directional ? sun({0.6, -1.0, 0.35})
                                                    : lamp(c.light, {1.5, 3.0, 2.0}, {0.0, 0.0, 0.0})};
  OneWorld one(std::move(scene));
  compare::CompareOptions options = test_options({320, 200}, 256, 0.01);
  options.raster.map.technique = c.technique;
  options.raster.map.depth_format = c.format;
  if (c.texel_bias) options.raster.map.bias = {};
  options.raster.map.bias.adaptive = c.adaptive;
  options.raster.map.bias.receiver_plane = c.receiver_plane;
  const compare::Comparison result = one.compare(options);
  const compare::LightComparison& light = result.lights[0];
  std::size_t compared = 0, unlike = 0;
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    if (!compare::is_compared(light.labels.data[i])) continue;
    ++compared;
    unlike += light.rungs[5].data[i] != light.rungs[6].data[i];
  }
  std::printf("  %s: %zu of %zu unlike, wrong %.2f %%\n", c.name, unlike, compared,
              100 * light.error.wrong_fraction);
  EXPECT_GT(compared, 15000u);
  EXPECT_LE(unlike, compared / 1000) << "texel borders and depths that rounding decides";
  EXPECT_LT(light.error.wrong_fraction, c.most_wrong);
  EXPECT_EQ(light.classes[9], 0u) << "outside the map";
}

constexpr LightType directional = LightType::directional, point = LightType::point, spot = LightType::spot;
INSTANTIATE_TEST_SUITE_P(
    Techniques, Twin,
    testing::Values(
        Case{"csm", Technique::csm, directional},
        Case{"csm_texel", Technique::csm, directional, DepthFormat::d32f, false, false, true},
        Case{"lispsm_texel", Technique::lispsm, directional, DepthFormat::d32f, false, false, true},
        Case{"csm_d16", Technique::csm, directional, DepthFormat::d16},
        Case{"lispsm", Technique::lispsm, directional},
        Case{"lispsm_reversed", Technique::lispsm, directional, DepthFormat::d32f_reversed},
        Case{"lispsm_adaptive", Technique::lispsm, directional, DepthFormat::d32f, true},
        Case{"lispsm_plane", Technique::lispsm, directional, DepthFormat::d32f, false, true},
        Case{"cube", Technique::cube, point, DepthFormat::d32f, false, false, false, 0.3},
        Case{"cube_adaptive", Technique::cube, point, DepthFormat::d32f, true},
        Case{"second_depth", Technique::second_depth, directional},
        Case{"second_depth_point", Technique::second_depth, point},
        Case{"midpoint", Technique::midpoint, directional},
        Case{"midpoint_spot", Technique::midpoint, spot, DepthFormat::d24},
        Case{"midpoint_reversed", Technique::midpoint, point, DepthFormat::d32f_reversed},
        Case{"hard_reversed", Technique::hard, point, DepthFormat::d32f_reversed, false, false, false, 0.3},
        Case{"hard_adaptive", Technique::hard, spot, DepthFormat::d32f, true},
        Case{"csm_plane", Technique::csm, directional, DepthFormat::d32f, false, true}),
    [](const auto& chosen) { return std::string(chosen.param.name); });

}  // namespace
}  // namespace gnomon::test
