// What each technique draws (V6) is its bias and its texel in double precision (V5), but for a few pixels on
// texel borders; and the whole ladder adds up. The same for every depth format.
#include "compare/truth/cascades.h"
#include "scene/load.h"
#include "tests/support/compare_support.h"
#include "tests/support/one_world.h"
#include "tests/support/raster_scenes.h"

namespace gnomon::test {
namespace {

using raster::DepthFormat;
using raster::Technique;

struct TwinCase {
  const char* name;
  Technique technique;
  LightType light;
  DepthFormat format = DepthFormat::d32f;
  bool adaptive = false;
  bool receiver_plane = false;
  bool texel_bias = false;   ///< the default: one texel
  double most_wrong = 0.03;  ///< a sanity check: acne and aliasing at this coarse map
};

class Twin : public testing::TestWithParam<TwinCase> {};

TEST_P(Twin, DrawnIsTheBiasedRung) {
  const TwinCase c = GetParam();
  Scene scene = still_life(c.light != LightType::spot);
  scene.lights = {c.light == LightType::directional ? sun({0.6, -1.0, 0.35})
                                                    : lamp(c.light, {1.5, 3.0, 2.0}, {0.0, 0.0, 0.0})};
  OneWorld one(std::move(scene));
  compare::CompareOptions options = test_options({320, 200}, 256, 0.01);
  options.raster.map.technique = c.technique;
  options.raster.map.depth_format = c.format;
  if (c.texel_bias) options.raster.map.bias = {1.0, raster::BiasUnit::texel};
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
    testing::Values(TwinCase{"csm", Technique::csm, directional},
                    TwinCase{"csm_texel", Technique::csm, directional, DepthFormat::d32f, false, false, true},
                    TwinCase{"lispsm_texel", Technique::lispsm, directional, DepthFormat::d32f, false, false,
                             true},
                    TwinCase{"csm_d16", Technique::csm, directional, DepthFormat::d16},
                    TwinCase{"lispsm", Technique::lispsm, directional},
                    TwinCase{"lispsm_reversed", Technique::lispsm, directional, DepthFormat::d32f_reversed},
                    TwinCase{"lispsm_adaptive", Technique::lispsm, directional, DepthFormat::d32f, true},
                    TwinCase{"lispsm_plane", Technique::lispsm, directional, DepthFormat::d32f, false, true},
                    TwinCase{"cube", Technique::cube, point, DepthFormat::d32f, false, false, false, 0.3},
                    TwinCase{"cube_adaptive", Technique::cube, point, DepthFormat::d32f, true},
                    TwinCase{"second_depth", Technique::second_depth, directional},
                    TwinCase{"second_depth_point", Technique::second_depth, point},
                    TwinCase{"midpoint", Technique::midpoint, directional},
                    TwinCase{"midpoint_spot", Technique::midpoint, spot, DepthFormat::d24},
                    TwinCase{"midpoint_reversed", Technique::midpoint, point, DepthFormat::d32f_reversed},
                    TwinCase{"hard_reversed", Technique::hard, point, DepthFormat::d32f_reversed, false,
                             false, false, 0.3},
                    TwinCase{"hard_adaptive", Technique::hard, spot, DepthFormat::d32f, true},
                    TwinCase{"csm_plane", Technique::csm, directional, DepthFormat::d32f, false, true}),
    [](const auto& chosen) { return std::string(chosen.param.name); });

// The mix of two cascades' hard tests, in double precision; the lower rungs stay those of the receiver's own cascade.
TEST(CascadeBlend, DrawnIsTheTwinsMix) {
  for (const double normal_offset : {0.0, 1.5}) {
    OneWorld one(still_life());
    one.scene.lights = {sun({0.6, -1.0, 0.35})};
    compare::CompareOptions options = test_options({320, 200}, 128, 0.01);
    raster::MapOptions& map = options.raster.map;
    map.technique = Technique::csm;
    map.cascades.count = 3, map.cascades.blend = 0.3;
    map.bias = {.constant = 0.5, .unit = raster::BiasUnit::texel, .slope = 1.0};
    map.bias.normal_offset_texels = normal_offset;
    const compare::Comparison result = one.compare(options);
    const compare::LightComparison& light = result.lights[0];
    const raster::LightRecord& record = result.raster.lights[0];
    std::size_t compared = 0, unlike = 0, mixed = 0, looked_up = 0;
    for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
      if (!compare::is_compared(light.labels.data[i])) continue;
      ++compared;
      const double twin = compare::visibility_by_face(record, result.raster.options.map, one.scene.lights[0],
                                                      result.raytraced.receiver.data[i], record.face.data[i]);
      const double drawn = double{light.rungs[6].data[i]};
      unlike += std::abs(drawn - twin) > 1e-3 ? 1 : 0;  // shares are told by floats in thousands of texels
      mixed += drawn > 0.0 && drawn < 1.0 ? 1 : 0;
      looked_up += record.lookups.data[i] == 2 ? 1 : 0;
    }
    EXPECT_GT(compared, 15000u);
    EXPECT_LE(unlike, compared / 1000) << "texel borders and depths that rounding decides";
    EXPECT_GT(mixed, 30u);
    EXPECT_GT(looked_up, mixed);
    EXPECT_FALSE(light.bias_curve_withheld.empty()) << "the gap of one cascade does not tell the mix";
    double steps = 0.0;
    for (const compare::BudgetStep& step : light.budget) steps += step.signed_mean;
    EXPECT_NEAR(steps, light.rung_mean[6] - light.rung_mean[0], 1e-12);
  }
}

// A floor under a slab, seen from between them. The bias, in texels of the cascade looked up, is less than the slab is
// high in the first cascade and more in the second: there the shadow is missed, and every receiver beside the change
// of cascades is a seam's. In world units it is the same in both, and a mix has no edge.
TEST(Seams, AreThePixelsWhereTheCascadeAloneDecides) {
  constexpr double height = 3.0;
  Scene scene = sunlit_scene({floor_mesh(20, 20), box_mesh({-20, height, -20}, {20, height + 0.1, 20})},
                             {0.0, -1.0, 0.0});
  scene.camera = {{0.0, 1.5, 18.0}, {0.0, 0.0, 15.0}, {0, 1, 0}, 0.7};
  OneWorld one(std::move(scene));
  compare::CompareOptions options = test_options({160, 100}, 64);
  raster::MapOptions& map = options.raster.map;
  map.technique = Technique::csm;
  map.cascades.count = 2, map.cascades.lambda = 1.0;
  const auto seams = [&](const raster::Bias& bias, double blend) {
    map.bias = bias, map.cascades.blend = blend;
    return one.compare(options);
  };
  const compare::Comparison first = seams({.constant = 0.01, .unit = raster::BiasUnit::world}, 0.0);
  const LightView& view = first.raster.lights[0].map.view;
  const Image<std::uint8_t>& face = first.raster.lights[0].face;
  std::uint64_t beside = 0;
  for (int y = 0; y < face.size.height; ++y)
    for (int x = 0; x < face.size.width; ++x) {
      ASSERT_TRUE(compare::is_compared(first.lights[0].labels.at(x, y))) << "the floor fills the picture";
      const int own = face.at(x, y);
      beside += (x > 0 && face.at(x - 1, y) != own) || (y > 0 && face.at(x, y - 1) != own) ||
                        (x + 1 < face.size.width && face.at(x + 1, y) != own) ||
                        (y + 1 < face.size.height && face.at(x, y + 1) != own)
                    ? 1
                    : 0;
    }
  ASSERT_GT(beside, 100u);
  EXPECT_EQ(first.lights[0].seams->at_border, beside);
  EXPECT_EQ(first.lights[0].seams->changed, 0u);
  const double texels = height / std::sqrt(texel_world_size(view, 0, 1.0) * texel_world_size(view, 1, 1.0));
  const raster::Bias by_texel{.constant = texels, .unit = raster::BiasUnit::texel};
  const compare::Comparison cut = seams(by_texel, 0.0);
  EXPECT_EQ(cut.lights[0].seams->at_border, beside);
  EXPECT_EQ(cut.lights[0].seams->changed, beside);
  EXPECT_EQ(seams(by_texel, 0.4).lights[0].seams->changed, 0u);
  map.technique = Technique::hard;
  EXPECT_FALSE(seams({}, 0.0).lights[0].seams.has_value());
}

// Under a lamp a floor has no slope in the face below it and half a texel's depth in the faces beside: a slope bias that
// reaches past a lid there, and does nothing below, makes a seam of every receiver where the two meet.
TEST(CubeSeams, AreThePixelsWhereTheFaceAloneDecides) {
  Scene scene;
  scene.materials.resize(1);
  scene.shapes = {{"floor", Plane{Vec3(0.0), Vec3(0.0, 1.0, 0.0)}, 0}};
  scene.meshes = {box_mesh({-20, 3.0, -20}, {20, 3.1, 20})};
  scene.instances = {{"lid", 0}};
  scene.lights = {lamp(LightType::point, {0.0, 6.0, 0.0}, {0.0, 0.0, 0.0})};
  scene.camera = {{0.0, 1.5, 9.0}, {0.0, 0.0, 6.0}, {0, 1, 0}, 0.5};
  OneWorld one(std::move(scene));
  compare::CompareOptions options = test_options({160, 100}, 64);
  raster::MapOptions& map = options.raster.map;
  for (const Technique technique : {Technique::cube, Technique::hard}) {
    map.technique = technique;
    map.bias = {.constant = 0.01, .unit = raster::BiasUnit::world};
    const compare::Comparison flat = one.compare(options);
    const Image<std::uint8_t>& face = flat.raster.lights[0].face;
    std::uint64_t beside = 0;
    for (int y = 0; y < face.size.height; ++y)
      for (int x = 0; x < face.size.width; ++x) {
        ASSERT_TRUE(compare::is_compared(flat.lights[0].labels.at(x, y))) << "the floor fills the picture";
        beside += (y > 0 && face.at(x, y - 1) != face.at(x, y)) ||
                          (y + 1 < face.size.height && face.at(x, y + 1) != face.at(x, y))
                      ? 1
                      : 0;
      }
    ASSERT_GE(beside, 320u);
    EXPECT_EQ(flat.lights[0].seams->at_border, beside);
    EXPECT_EQ(flat.lights[0].seams->changed, 0u);
    map.bias.slope = 40.0;  // a lid's gap there is 33 slopes
    const compare::Comparison cut = one.compare(options);
    EXPECT_EQ(cut.lights[0].seams->at_border, beside);
    EXPECT_EQ(cut.lights[0].seams->changed, beside);
  }
  map.technique = Technique::pcf;
  EXPECT_FALSE(one.compare(options).lights[0].seams.has_value());
}

// A floor seen from straight above, with pixel centres exactly where two faces of the cube meet.
TEST(CubeSeams, AReceiverOnASeamIsInTheMap) {
  Scene scene;
  scene.materials.resize(1);
  scene.shapes = {{"floor", Plane{Vec3(0.0), Vec3(0.0, 1.0, 0.0)}, 0}};
  scene.camera.eye = Vec3(0.0, 2.0, 0.0);
  scene.camera.target = Vec3(0.0);
  scene.camera.up = Vec3(0.0, 0.0, -1.0);
  scene.camera.vertical_fov = 0.5 * pi;  // a pixel n/4 from the middle sees the floor at 1
  scene.lights = {lamp(LightType::point, {0.0, 1.0, 0.0}, {0.0, 0.0, 0.0})};
  scene.shapes.push_back({"caster", Sphere{Vec3(0.0, 0.5, 0.0), 0.2}, 0});
  OneWorld one(std::move(scene));
  constexpr int side = 66;
  compare::CompareOptions options = test_options({side, side}, 64, 0.1);
  const compare::Comparison result = one.compare(options);
  const raster::LightRecord& record = result.raster.lights[0];
  int on_seams = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double across = 2.0 * std::abs((x + 0.5) / side * 2.0 - 1.0),
                   along = 2.0 * std::abs((y + 0.5) / side * 2.0 - 1.0);
      if (across != 1.0 && along != 1.0) continue;
      ++on_seams;
      EXPECT_EQ(record.outside_map.at(x, y), 0) << x << ", " << y;
      EXPECT_EQ(record.visibility.at(x, y), 1.0f) << x << ", " << y;
    }
  EXPECT_GT(on_seams, 100);
}

// What cascades and the warp are for, with the bias that each has where none is asked for.
TEST(Defaults, CascadesAndWarpAreWrongLessThanTheOneMap) {
  for (const char* name : {"fence", "courtyard"}) {
    auto scene = load_scene(name);
    ASSERT_TRUE(scene.has_value());
    OneWorld one(std::move(*scene));
    compare::CompareOptions options = test_options({640, 360}, 512);
    struct Figures {
      double wrong, by_sampling, texel_side;  ///< shares of the compared pixels; pixels
    };
    const auto measure = [&](Technique technique) {
      options.raster.map.technique = technique;
      options.raster.map.bias = raster::default_bias(options.raster.map);
      const compare::Comparison result = one.compare(options);
      const compare::LightComparison& light = result.lights[0];
      std::printf("  %s %d: wrong %.2f %%, acne %.2f %%\n", name, static_cast<int>(technique),
                  100 * light.error.wrong_fraction,
                  100.0 * static_cast<double>(light.classes[0]) / static_cast<double>(light.pixels.compared));
      std::uint64_t sampled = 0;
      for (const compare::Label label :
           {compare::Label::aliasing, compare::Label::missed_feature, compare::Label::false_feature})
        sampled += light.classes[static_cast<std::size_t>(label) - 1];
      return Figures{light.error.wrong_fraction,
                     static_cast<double>(sampled) / static_cast<double>(light.pixels.compared),
                     light.theory.measured_aliasing.median};
    };
    // What finer texels mend is what sampling makes wrong; the bias's own errors stay.
    const Figures hard = measure(Technique::hard), cascades = measure(Technique::csm);
    EXPECT_LT(cascades.texel_side, 0.6 * hard.texel_side) << name;     // measured: 0.51 and 0.55
    EXPECT_LT(cascades.by_sampling, 0.75 * hard.by_sampling) << name;  // measured: 0.69 and 0.71
    // The rest, which is the bias's own, does not grow: so much less is wrong in all.
    EXPECT_LT(cascades.wrong, hard.wrong - 0.25 * hard.by_sampling) << name;  // measured: 0.68 and 0.75 of it
    EXPECT_LT(measure(Technique::lispsm).wrong, hard.wrong) << name;
  }
}

}  // namespace
}  // namespace gnomon::test
