// Lights with size in JSON scenes: what is read, and what is refused with its place.
#include <fmt/core.h>
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

TEST(SizedLights, RectanglesAreReadByTheirSides) {
  const Light saved =
      light(lamp + R"("rectangle": {"half_width": [0.1, 0, 0.3], "half_height": [0, 0.7, 0]})");
  const RectangleLight sides{{0.1, 0.0, 0.3}, {0.0, 0.7, 0.0}};
  EXPECT_TRUE(saved.extent == LightExtent(sides));
  const Vec3 across = glm::normalize(Vec3(1, -2, 3));
  const Light disc = light(
      lamp + fmt::format(R"("disc": {{"radius": 1, "normal": [{}, {}, {}]}})", across.x, across.y, across.z));
  EXPECT_EQ(std::get<DiscLight>(disc.extent).normal, across);  // a unit vector stays as it is
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
      {lamp + R"("rectangle": {"half_width": [1, 0, 0], "half_height": [0, 1, 0], "up": [0, 1, 0]})",
       "lights[0].rectangle.up: cannot stand beside half_width and half_height"},
      {lamp + R"("rectangle": {"half_width": [1, 0, 0]})", "lights[0].rectangle.half_height: is missing"},
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
            "light 'lamp' has a size; a shadow map sees from its centre alone");
  EXPECT_FALSE(plan[Effect::hard_shadow].called_for);
  EXPECT_EQ(plan[Effect::hard_shadow].reason, "every light has a size");
  const Expected<Scene> hard = load_scene("fence");
  ASSERT_TRUE(hard);
  EXPECT_EQ(plan_effects(*hard)[Effect::soft_shadow].reason, "no light has a size");
}

// The keys of the picture's samples, in line 2 from column 3 on.
Expected<Scene> with_settings(const std::string& keys, const std::string& material = "") {
  return load_json_scene("{ \"schema\": \"gnomon/scene/1\",\n  " + keys + R"(
  "shapes": [{ "sphere": { "center": [0, 0, 0], "radius": 1 }, "material": "m" }],
  "materials": [{ "name": "m")" +
                             material + "}] }",
                         "s.json", ".", {});
}

const std::string camera = R"("camera": {"eye": [0, 0, 4], "target": [0, 0, 0], "samples_per_pixel": )";

TEST(PictureSamples, AreRead) {
  const Expected<Scene> none = with_settings("");
  ASSERT_TRUE(none) << none.error().message();
  EXPECT_EQ(none->glossy_samples, 16);
  EXPECT_EQ(none->indirect_samples, 0);
  EXPECT_EQ(none->camera.samples_per_pixel, 1);
  EXPECT_FALSE(none->materials[0].thin);
  EXPECT_EQ(none->materials[0].priority, 0);
  const Expected<Scene> all =
      with_settings(R"("glossy": {"samples": 5}, "indirect": {"samples": 7}, )" + camera + "9},",
                    R"(, "transmission": 1, "priority": -3, "thin": true, "roughness": 0.5)");
  ASSERT_TRUE(all) << all.error().message();
  EXPECT_EQ(all->glossy_samples, 5);
  EXPECT_EQ(all->indirect_samples, 7);
  EXPECT_EQ(all->camera.samples_per_pixel, 9);
  EXPECT_TRUE(all->materials[0].thin);
  EXPECT_EQ(all->materials[0].priority, -3);
  const EffectPlan plan = plan_effects(*all);
  EXPECT_EQ(
      plan[Effect::glossy].reason,
      "material 'm' has roughness > 0 on a mirror or transmissive surface; only the ray tracer shows it");
  EXPECT_EQ(plan[Effect::indirect_light].reason,
            "the scene asks for 7 samples per point; only the ray tracer's picture shows it");
  EXPECT_EQ(
      plan[Effect::antialiasing].reason,
      "the camera asks for 9 samples per pixel; gnomon raytrace does it, everything else stays at pixel "
      "centres");
}

TEST(PictureSamples, MistakesHaveTheirPlace) {
  const struct {
    std::string keys, material, message;
  } mistakes[] = {
      {R"("glossy": {"samples": 0},)", "",
       "glossy.samples: out of range (got 0, allowed a whole number in [1, 65536])"},
      {R"("indirect": {"samples": 1.5},)", "", "indirect.samples: "},
      {R"("indirect": {},)", "", "indirect.samples: is missing"},
      {R"("indirect": {"samples": 1, "bounces": 2},)", "", "indirect.bounces: unknown key"},
      {camera + "65537},", "", "camera.samples_per_pixel: out of range (got 65537, allowed "},
      {"", R"(, "priority": 0.5)", "materials[0].priority: "},
      {"", R"(, "priority": 1001)", "materials[0].priority: out of range (got 1001, allowed "},
      {"", R"(, "thin": 1)", "materials[0].thin: "},
  };
  for (const auto& [keys, material, message] : mistakes) {
    const Expected<Scene> scene = with_settings(keys, material);
    ASSERT_FALSE(scene) << keys << material;
    EXPECT_NE(scene.error().message().find(": " + message), std::string::npos) << scene.error().message();
  }
}

}  // namespace
}  // namespace gnomon
