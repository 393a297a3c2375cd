// The whole chain against closed forms (docs/design.md, section 3): acne on a tilted plane, the shadow of a sphere
// on a plane, the gap that a bias tears between a wall and its shadow; and the sums that must hold for any
// scene.
#include <fmt/core.h>

#include "tests/support/compare_support.h"
#include "tests/support/one_world.h"

namespace gnomon::test {
namespace {

using compare::Label;

std::uint64_t count(const compare::LightComparison& light, Label label) {
  return light.classes[static_cast<std::size_t>(label) - 1];
}

// The floor seen from above, nothing on it: every wrong pixel is acne.
Scene empty_floor(const Vec3& sun) {
  Scene scene = sunlit_scene({floor_mesh(10.0, 10.0)}, sun);
  scene.camera = {{1.3, 14.0, 9.0}, {0.2, 0.0, 0.5}, {0, 1, 0}, 0.6};
  return scene;
}

struct HalfTexelSlopes {
  double a, b;
};

// Depth change over half a texel along u and v, from the map's own frame.
HalfTexelSlopes floor_slopes(const LightView& view) {
  const Vec3 n(0, 1, 0);
  const LightFace& f = view.faces[0];
  const double n_forward = glm::dot(n, f.forward);
  return {std::abs(view.face(0).half_extent.x / view.size * glm::dot(n, f.right) / n_forward),
          std::abs(view.face(0).half_extent.y / view.size * glm::dot(n, f.up) / n_forward)};
}

struct AcneCase {
  int map_size;
  Vec3 sun;
};

class AcneClosedForm : public ::testing::TestWithParam<AcneCase> {};

// 0.005: the tolerance that the project set itself; an image of 640x360 samples each texel at few, evenly
// spread places, so the fraction is sampled to 0.003.
TEST_P(AcneClosedForm, FractionOfLitFloorPixels) {
  const AcneCase& c = GetParam();
  OneWorld floor(empty_floor(c.sun));
  const LightView view = floor.compare(test_options({64, 36}, c.map_size)).raster.lights[0].map.view;
  const HalfTexelSlopes slopes = floor_slopes(view);
  const double larger = std::max(slopes.a, slopes.b);
  for (const double factor : {0.0, 0.25, 0.5, 0.75, 1.1}) {
    const double bias = factor * larger;
    const compare::Comparison run = floor.compare(test_options({640, 360}, c.map_size, bias));
    const auto& light = run.lights[0];
    const double measured = double(count(light, Label::acne)) / double(light.pixels.compared);
    const double predicted = acne_fraction(slopes.a, slopes.b, bias);
    EXPECT_NEAR(measured, predicted, 0.005) << "map " << c.map_size << " bias " << factor << " a";
    EXPECT_LE(light.error.wrong - count(light, Label::acne), light.pixels.compared / 1000);
    std::printf("  map %4d  bias %.2f a  acne %.5f  closed form %.5f\n", c.map_size, factor, measured,
                predicted);
  }
}

// A factor of 1 stores the floor farther by the larger of both slopes over a texel: twice the larger of a and b.
TEST_P(AcneClosedForm, FractionUnderASlopeBiasOfCasters) {
  const AcneCase& c = GetParam();
  OneWorld floor(empty_floor(c.sun));
  for (const double factor : {0.25, 0.5, 0.7, 1.0}) {
    auto options = test_options({640, 360}, c.map_size);
    options.raster.map.bias.caster_slope = factor;
    const compare::Comparison run = floor.compare(options);
    const auto& light = run.lights[0];
    const HalfTexelSlopes slopes = floor_slopes(run.raster.lights[0].map.view);
    const double predicted = acne_fraction(slopes.a, slopes.b, 2.0 * factor * std::max(slopes.a, slopes.b));
    EXPECT_NEAR(double(count(light, Label::acne)) / double(light.pixels.compared), predicted, 0.005)
        << "map " << c.map_size << " factor " << factor;
  }
}

const Vec3 aligned(1.0, -1.5, 0.0), oblique(0.8, -1.3, 0.45), low(-0.9, -0.6, -0.35);
INSTANTIATE_TEST_SUITE_P(Maps, AcneClosedForm,
                         ::testing::Values(AcneCase{256, aligned}, AcneCase{256, oblique}, AcneCase{512, low},
                                           AcneCase{1024, oblique}, AcneCase{2048, aligned},
                                           AcneCase{2048, oblique}, AcneCase{2048, low}));

Scene sphere_over_plane() {
  Scene scene;
  scene.materials.push_back(Material{"grey"});
  scene.shapes.push_back({"ball", Sphere{{0.3, 1.2, -0.2}, 0.7}, 0});
  scene.shapes.push_back({"ground", Plane{{0, 0, 0}, {0, 1, 0}}, 0});
  Light light;
  light.name = "lamp";
  light.type = LightType::point;
  light.position = {1.5, 4.0, 1.0};
  scene.lights.push_back(light);
  scene.camera = {{2.0, 5.0, 6.0}, {0, 0.3, 0}, {0, 1, 0}, 0.7};
  return scene;
}

TEST(SphereOverPlane, TruthIsTheClosedForm) {
  const Scene scene = sphere_over_plane();
  const Compared run = run_comparison(scene, test_options({1280, 720}, 512));
  const Vec3 light = scene.lights[0].position;
  const auto& ball = std::get<Sphere>(scene.shapes[0].geometry);
  const Vec3 w = ball.center - light;
  std::size_t checked = 0;
  for (std::size_t i = 0; i < run.light().labels.data.size(); ++i) {
    const auto& receiver = run.result.raytraced.receiver.data[i];
    if (!compare::is_compared(run.light().labels.data[i]) || receiver.primitive != 1) continue;
    const Vec3 u = receiver.position - light;
    const double uw = glm::dot(u, w);
    const bool shadowed = uw > 0 && uw * uw >= (glm::dot(w, w) - ball.radius * ball.radius) * glm::dot(u, u);
    ASSERT_EQ(shadowed, run.light().rungs[0].data[i] < 0.5f) << "pixel " << i;
    ++checked;
  }
  EXPECT_GT(checked, 300000u);
  EXPECT_LT(double(run.light().pixels.uncertain), 1e-4 * double(run.light().pixels.total));
}

// A wall of thickness w on a floor, the sun across it at angle theta from the floor's normal: with bias d
// along the ray the shadow starts max(0, d sin(theta) - w) behind the wall.
TEST(WallOnFloor, DetachmentIsTheClosedForm) {
  const double w = 0.05;
  for (const double theta : {0.6, 0.9}) {
    Scene scene = sunlit_scene({floor_mesh(4, 4), box_mesh({-w, -0.5, -3}, {0, 1.5, 3})},
                               {std::sin(theta), -std::cos(theta), 0});
    scene.camera = {{2.5, 3.0, 1.0}, {0.4, 0, 0}, {0, 1, 0}, 0.6};
    OneWorld world(std::move(scene));
    for (const double bias : {0.02, 0.12, 0.3}) {
      const compare::Comparison run = world.compare(test_options({960, 540}, 1024, bias));
      const double expected = std::max(0.0, bias * std::sin(theta) - w);
      const double texel = run.lights[0].texel_world[1] / std::cos(theta);
      EXPECT_NEAR(run.lights[0].detachment.max_world, expected, texel)
          << "theta " << theta << " bias " << bias;
      if (expected > texel) {
        EXPECT_GT(count(run.lights[0], Label::peter_panning), 100u);
      }
      std::printf("  theta %.1f  bias %.2f  detachment %.4f  closed form %.4f  texel %.4f\n", theta, bias,
                  run.lights[0].detachment.max_world, expected, texel);
    }
  }
}

// Whoever has the constant, the shadow starts as far from the wall; and up to V4, where the stored depths are the map's own,
// nothing knows of the casters' bias: it is the bias step's.
TEST(WallOnFloor, CastersBiasIsTheBiasSteps) {
  const double w = 0.05, theta = 0.9, bias = 0.3;
  Scene scene = sunlit_scene({floor_mesh(4, 4), box_mesh({-w, -0.5, -3}, {0, 1.5, 3})},
                             {std::sin(theta), -std::cos(theta), 0});
  scene.camera = {{2.5, 3.0, 1.0}, {0.4, 0, 0}, {0, 1, 0}, 0.6};
  OneWorld world(std::move(scene));
  const compare::Comparison plain = world.compare(test_options({960, 540}, 1024));
  auto options = test_options({960, 540}, 1024);
  options.raster.map.bias.caster_constant = bias;
  for (const double slope : {0.0, 1.0}) {
    options.raster.map.bias.caster_slope = slope;
    const compare::Comparison run = world.compare(options);
    const compare::LightComparison& light = run.lights[0];
    for (std::size_t k = 0; k <= 4; ++k)
      EXPECT_EQ(light.rungs[k].data, plain.lights[0].rungs[k].data) << "V" << k;
    EXPECT_GT(count(light, Label::caster_bias), 1000u);
    EXPECT_LT(count(light, Label::stored_depth) + count(light, Label::peter_panning), 10u);
    EXPECT_GE(light.budget[static_cast<std::size_t>(compare::Cause::bias)].missed_shadow,
              count(light, Label::caster_bias));
    if (slope == 0.0) {
      EXPECT_NEAR(light.detachment.max_world, bias * std::sin(theta) - w,
                  light.texel_world[1] / std::cos(theta));
    }
  }
}

TEST(Sums, StepsAddUpAndLabelsAddUp) {
  OneWorld world(boxes_under_three_lights());
  for (const double bias : {0.0, 0.01, 0.2}) {
    const compare::Comparison run = world.compare(test_options({640, 360}, 256, bias));
    for (const auto& light : run.lights) {
      double steps = 0.0;
      for (const auto& step : light.budget) steps += step.signed_mean;
      double difference = 0.0;
      std::uint64_t classes = 0;
      for (std::size_t i = 0; i < light.labels.data.size(); ++i)
        if (compare::is_compared(light.labels.data[i]))
          difference += light.rungs[6].data[i] - light.rungs[0].data[i];
      for (const std::uint64_t c : light.classes) classes += c;
      EXPECT_NEAR(steps, difference / double(light.pixels.compared), 1e-9);
      EXPECT_EQ(classes, light.error.wrong);
      const auto& p = light.pixels;
      EXPECT_EQ(p.background + p.silhouette + p.facing_away + p.uncertain + p.compared, p.total);
    }
  }
}

// The exact count of another constant bias must be what a render at that bias shows.
TEST(BiasCurve, EqualsTheRenderAtThatBias) {
  OneWorld world(boxes_under_three_lights());
  const compare::Comparison base = world.compare(test_options({640, 360}, 256, 0.0));
  for (const double bias : {0.0, 0.003, 0.0171, 0.05, 0.23}) {
    const compare::Comparison render = world.compare(test_options({640, 360}, 256, bias));
    for (std::size_t i = 0; i < base.lights.size(); ++i) {
      const auto& record = base.raster.lights[i];
      std::uint64_t false_shadow = 0;
      std::uint64_t missed_shadow = 0;
      for (std::size_t p = 0; p < base.lights[i].labels.data.size(); ++p) {
        if (!compare::is_compared(base.lights[i].labels.data[p])) continue;
        const bool drawn_lit = !(record.gap.data[p] > static_cast<float>(bias));
        const bool truly_lit = base.lights[i].rungs[0].data[p] > 0.5f;
        false_shadow += truly_lit && !drawn_lit;
        missed_shadow += !truly_lit && drawn_lit;
      }
      EXPECT_EQ(false_shadow, render.lights[i].error.false_shadow);
      EXPECT_EQ(missed_shadow, render.lights[i].error.missed_shadow);
      bool on_curve = false;
      for (const auto& point : render.lights[i].bias_curve) {
        if (point.bias != bias) continue;
        on_curve = true;
        EXPECT_EQ(point.false_shadow, false_shadow);
        EXPECT_EQ(point.missed_shadow, missed_shadow);
      }
      EXPECT_TRUE(on_curve) << "the render's own bias is on its curve";
    }
  }
}

// No bias is better than the one called best, and a render at it leaves exactly what was promised.
std::uint64_t expect_best_bias_is_best(Scene scene, const ImageSize& size) {
  OneWorld world(std::move(scene));
  const compare::Comparison base = world.compare(test_options(size, 256, 0.0));
  std::uint64_t ties = 0;
  for (std::size_t i = 0; i < base.lights.size(); ++i) {
    const auto& light = base.lights[i];
    const double best = light.best_bias.constant_world;
    const compare::Comparison render = world.compare(test_options(size, 256, best));
    EXPECT_DOUBLE_EQ(render.lights[i].error.wrong_fraction, light.best_bias.wrong_fraction);
    const compare::BestBias::Setting advised = light.best_bias.advised();
    EXPECT_EQ(fmt::format("{:.3g}", advised.constant_world), fmt::format("{:.9g}", advised.constant_world));
    const compare::Comparison again = world.compare(test_options(size, 256, advised.constant_world));
    EXPECT_DOUBLE_EQ(again.lights[i].error.wrong_fraction, advised.wrong_fraction);
    const double tied = 0.5 * double(light.error.ties);
    for (const auto& point : light.bias_curve)
      EXPECT_GE((double(point.false_shadow + point.missed_shadow) + tied) / double(light.pixels.compared),
                light.best_bias.wrong_fraction);
    ties += light.error.ties;
  }
  return ties;
}

TEST(BiasCurve, BestBiasIsBest) {
  EXPECT_EQ(expect_best_bias_is_best(boxes_under_three_lights(), {640, 360}), 0U);
}

// Of a light with size just half may be seen, which no bias mends or breaks.
TEST(BiasCurve, BestBiasIsBestUnderALightWithSize) {
  Scene scene = boxes_under_three_lights();
  scene.lights.resize(1);
  scene.lights[0].extent = SunDisc{0.02};
  EXPECT_GT(expect_best_bias_is_best(std::move(scene), {320, 180}), 0U);
}

// What is said of the other kinds of bias from one drawing is what they draw, but for the pixels in which the
// shader's floats and the doubles that it is said from part: as below, at most one in a thousand.
TEST(BiasKinds, AreWhatTheyDraw) {
  OneWorld world(boxes_under_three_lights());
  const auto options = test_options({320, 180}, 256, 0.01);
  auto thorough = options;
  thorough.perceptual = true;
  const compare::Comparison said = world.compare(thorough);
  for (std::size_t i = 0; i < said.lights.size(); ++i) {
    const auto& kinds = said.lights[i].bias_kinds;
    ASSERT_EQ(kinds.size(), 5u);
    for (const compare::BiasKind& kind : kinds) {
      auto drawing = options;
      drawing.raster.map.bias = kind.bias;
      const compare::Comparison drawn = world.compare(drawing);
      EXPECT_NEAR(drawn.lights[i].error.wrong_fraction, kind.wrong_fraction, 1e-3)
          << kind.name << " light " << i;
    }
    EXPECT_LE(kinds.front().wrong_fraction, said.lights[i].error.wrong_fraction + 1e-3);
  }
}

// In the casters' own terms, too: where they have a slope, slopes of theirs are tried, and a constant is theirs.
TEST(BiasKinds, OfCastersAreWhatTheyDraw) {
  OneWorld world(boxes_under_three_lights());
  auto options = test_options({320, 180}, 256);
  options.perceptual = true;
  options.raster.map.bias.caster_constant = 0.02, options.raster.map.bias.caster_slope = 3.0;
  const compare::Comparison said = world.compare(options);
  for (std::size_t i = 0; i < said.lights.size(); ++i) {
    const auto& kinds = said.lights[i].bias_kinds;
    ASSERT_EQ(kinds.size(), 6u);
    bool slope = false, constant = false;
    for (const compare::BiasKind& kind : kinds) {
      slope = slope || kind.bias.caster_slope != 0.0, constant = constant || kind.bias.caster_constant != 0.0;
      auto drawing = options;
      drawing.raster.map.bias = kind.bias;
      const compare::Comparison drawn = world.compare(drawing);
      EXPECT_NEAR(drawn.lights[i].error.wrong_fraction, kind.wrong_fraction, 1e-3)
          << kind.name << " light " << i;
    }
    EXPECT_TRUE(slope && constant) << i;
  }
}

TEST(Units, ATexelGivenIsATexelReported) {
  for (const auto technique : {raster::Technique::hard, raster::Technique::cube}) {
    auto options = test_options({160, 90}, 256);
    options.raster.map.technique = technique;
    options.raster.map.bias = {1.0, raster::BiasUnit::texel};
    Scene scene = boxes_under_three_lights();
    if (technique == raster::Technique::cube) scene.lights = {scene.lights[2]};
    const Compared run = run_comparison(scene, options);
    for (std::size_t i = 0; i < run.result.lights.size(); ++i)
      EXPECT_DOUBLE_EQ(
          run.result.raster.lights[i].bias_constant_world / run.result.lights[i].bias_texel_world, 1.0);
  }
}

// V5 is computed in double from the exact receiver, V6 is what float shaders drew: they may part only where a
// receiver falls on a texel's border or a gap on the bias, at most one pixel in a thousand.
TEST(Ladder, DrawnEqualsBiasedForHard) {
  OneWorld world(boxes_under_three_lights());
  for (const double slope : {0.0, 1.0}) {
    for (const double offset : {0.0, 1.0}) {
      auto options = test_options({640, 360}, 512, 0.01);
      options.raster.map.bias.slope = slope;
      options.raster.map.bias.normal_offset_texels = offset;
      const compare::Comparison run = world.compare(options);
      for (const auto& light : run.lights) {
        std::uint64_t apart = 0;
        for (std::size_t i = 0; i < light.labels.data.size(); ++i)
          apart +=
              compare::is_compared(light.labels.data[i]) && light.rungs[5].data[i] != light.rungs[6].data[i];
        EXPECT_LE(apart, light.pixels.compared / 1000) << "slope " << slope << " normal offset " << offset;
      }
    }
  }
}

}  // namespace
}  // namespace gnomon::test
