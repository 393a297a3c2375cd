// Lights with size in JSON scenes: what is read, and what is refused with its place.
#include <gtest/gtest.h>

#include "scene/effects.h"
#include "scene/files/formats.h"
#include "scene/light.h"
#include "scene/load.h"

namespace gnomon {
namespace {

// The light's keys stand in line 2 from column 15 on.
Expected<Scene> with_light(const std::string& keys) {
  return load_json_scene(R"({ "schema": "gnomon/scene/1",
  "lights": [{)" + keys + R"(}],
  "shapes": [{ "sphere": { "center": [0, 0, 0], "radius": 1 }, "material": "m" }],
  "materials": [{ "name": "m" }] })",
                         "s.json", ".", {});
}

Light light(const std::string& keys) {
  const Expected<Scene> scene = with_light(keys);
  EXPECT_TRUE(scene) << scene.error().message();
  return scene ? scene->lights[0] : Light{};
}

const std::string lamp = R"("type": "point", "position": [0, 5, 0], )";
const std::string sun = R"("type": "directional", "direction": [0, -1, 0], )";
const std::string spot = R"("type": "spot", "position": [0, 5, 0], "target": [3, 5, 0], )";

TEST(SizedLights, AreRead) {
  EXPECT_DOUBLE_EQ(
      std::get<SunDisc>(light(sun + R"("angular_diameter_degrees": 90)").extent).angular_diameter, 0.5 * pi);
  EXPECT_EQ(std::get<SphereLight>(light(lamp + R"("sphere": {"radius": 0.5})").extent).radius, 0.5);
  const auto disc = std::get<DiscLight>(light(spot + R"("disc": {"radius": 2})").extent);
  EXPECT_EQ(disc.radius, 2.0);
  EXPECT_EQ(disc.normal, Vec3(1, 0, 0));  // the spot's own direction
  const Light rectangle = light(
      lamp +
      R"("rectangle": {"width": 2, "height": 6, "normal": [0, -3, 0], "up": [0, 1, 5]}, "shadow_samples": 9)");
  const auto sides = std::get<RectangleLight>(rectangle.extent);
  EXPECT_EQ(glm::abs(sides.half_width), Vec3(1, 0, 0));
  EXPECT_EQ(sides.half_height, Vec3(0, 0, 3));
  EXPECT_EQ(rectangle.shadow_samples, 9);
  EXPECT_FALSE(has_size(light(lamp + R"("disc": {"radius": 0})")));
  EXPECT_FALSE(has_size(light(sun + R"("angular_diameter_degrees": 0)")));
  EXPECT_TRUE(has_size(light(lamp + R"("rectangle": {"width": 0, "height": 1})")));
}

TEST(SizedLights, MistakesHaveTheirPlace) {
  const struct {
    std::string keys, message;
  } mistakes[] = {
      {lamp + R"("disc": {"radius": -1})", "lights[0].disc.radius: out of range (got -1, allowed "},
      {lamp + R"("disc": {"normal": [0, 1, 0]})", "lights[0].disc.radius: is missing"},
      {lamp + R"("disc": {"radius": 1, "normal": [0, 0, 0]})", "lights[0].disc.normal: has no direction"},
      {lamp + R"("disc": {"radius": 1, "size": 1})", "lights[0].disc.size: unknown key"},
      {lamp + R"("sphere": {"radius": 1}, "disc": {"radius": 1})",
       "lights[0].disc: cannot stand beside sphere"},
      {lamp + R"("rectangle": {"width": 1})", "lights[0].rectangle.height: is missing"},
      {lamp + R"("rectangle": {"width": 1, "height": 1, "up": [0, 2, 0]})",
       "lights[0].rectangle.up: is parallel to the rectangle's normal"},
      {lamp + R"("angular_diameter_degrees": 1)",
       "lights[0].angular_diameter_degrees: applies to a directional"},
      {sun + R"("sphere": {"radius": 1})", "lights[0].sphere: does not apply to a directional light"},
      {sun + R"("angular_diameter_degrees": 91)",
       "lights[0].angular_diameter_degrees: out of range (got 91, allowed a number in [0, 90])"},
      {lamp + R"("shadow_samples": 4)", "lights[0].shadow_samples: applies to a light with a size only"},
      {lamp + R"("sphere": {"radius": 1}, "shadow_samples": 0)",
       "lights[0].shadow_samples: out of range (got 0, allowed a whole number in [1, 65536])"},
      {lamp + R"("sphere": {"radius": 1}, "shadow_samples": 1.5)", "lights[0].shadow_samples: "},
  };
  for (const auto& [keys, message] : mistakes) {
    const Expected<Scene> scene = with_light(keys);
    ASSERT_FALSE(scene) << keys;
    const std::string text = scene.error().message();
    EXPECT_EQ(text.substr(0, 9), "s.json:2:") << text;
    EXPECT_NE(text.find(": " + message), std::string::npos) << text;
  }
}

TEST(SizedLights, ThePlanNamesThem) {
  const Expected<Scene> scene = load_scene("penumbra");
  ASSERT_TRUE(scene) << scene.error().message();
  const EffectPlan plan = plan_effects(*scene);
  EXPECT_TRUE(plan[Effect::soft_shadow].simulated);
  EXPECT_EQ(plan[Effect::soft_shadow].reason,
            "light 'lamp' has a size; the rasterizer draws its centre alone");
  EXPECT_FALSE(plan[Effect::hard_shadow].called_for);
  EXPECT_EQ(plan[Effect::hard_shadow].reason, "every light has a size");
  const Expected<Scene> hard = load_scene("fence");
  ASSERT_TRUE(hard);
  EXPECT_EQ(plan_effects(*hard)[Effect::soft_shadow].reason, "no light has a size");
}

}  // namespace
}  // namespace gnomon
