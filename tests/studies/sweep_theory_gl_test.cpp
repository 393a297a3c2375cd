// The closed forms that are printed beside the measurement, against what they predict.
#include "tests/support/compare_support.h"
#include "tests/support/one_world.h"

namespace gnomon::test {
namespace {

Scene floor_under(const Light& light) {
  Scene scene = sunlit_scene({floor_mesh(4, 4)}, {0.6, -1.0, 0.25});
  if (light.type != LightType::directional) scene.lights = {light};
  scene.camera = {{1.5, 2.0, 3.0}, {0, 0, 0}, {0, 1, 0}, 0.5};
  return scene;
}

Light lamp(LightType type) {
  Light light;
  light.name = "lamp";
  light.type = type;
  light.position = {0.8, 3.0, 0.5};
  light.direction = glm::normalize(Vec3(-0.8, -3.0, -0.5));
  light.inner_angle = 0.5;
  light.outer_angle = 0.7;
  return light;
}

// On a plane, pixels and texels are related by one smooth map: the predicted size of a texel is the measured
// one. Differences of neighbouring pixels stand for derivatives, and map positions are floats: a few percent.
TEST(Theory, TexelsAreAsLargeAsPredicted) {
  for (const LightType type : {LightType::directional, LightType::spot, LightType::point}) {
    const Compared run = run_comparison(floor_under(lamp(type)), test_options({320, 180}, 256, 0.5));
    const compare::TheoryStats& theory = run.light().theory;
    ASSERT_GT(theory.aliasing.count, 10000u);
    EXPECT_NEAR(theory.measured_aliasing.median / theory.aliasing.median, 1.0, 0.02);
    EXPECT_NEAR(theory.measured_aliasing.p90 / theory.aliasing.p90, 1.0, 0.03);
    EXPECT_GT(theory.perspective.median, 0.0);
  }
}

// With the bias called least, a plane has no acne; with a tenth less than the median, some pixels have.
TEST(Theory, AcneEndsAtTheBiasCalledLeast) {
  for (const LightType type : {LightType::directional, LightType::spot, LightType::point}) {
    OneWorld world(floor_under(lamp(type)));
    const auto wrong = [&world](double bias) {
      const compare::Comparison run = world.compare(test_options({320, 180}, 256, bias));
      return std::pair(run.lights[0].error.wrong, run.lights[0].theory.acne_free_bias);
    };
    const auto [at_zero, bias] = wrong(0.0);
    EXPECT_GT(at_zero, 1000u);
    EXPECT_GT(wrong(0.9 * bias.median).first, 0u);
    // Float depths move a gap by a part in ten million of the map's range.
    EXPECT_EQ(wrong(bias.max * 1.001).first, 0u) << "least bias " << bias.max;
  }
}

}  // namespace
}  // namespace gnomon::test
