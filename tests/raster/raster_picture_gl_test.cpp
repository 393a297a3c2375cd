// The picture: radiance against the shared formulas in double precision, lights that add up, and scenes far
// from the origin.
#include <cmath>

#include "scene/light.h"
#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

/// docs/design.md's local shading (shaders/blinn_phong.glsl) with the visibility that was drawn. What mirrors or
/// transmits is drawn as matte grey of one half.
Vec3 expected_radiance(const Drawn& drawn, std::size_t pixel, const Vec3& position, const Vec3& geometric,
                       const Vec3& shading, const Vec3& to_eye, const Material& material) {
  const double local = 1.0 - double(material.mirror) - double(material.transmission);
  const Vec3 diffuse = local * Vec3(material.diffuse) + Vec3(0.5 * (1.0 - local));
  Vec3 sum = Vec3(drawn.scene->ambient) * diffuse;
  for (const auto& record : drawn.frame.lights) {
    const Light& light = drawn.scene->lights[record.light];
    const LightAtPoint at = light_at(light, position);
    if (light_cannot_reach(light, position, geometric) || record.visibility.data[pixel] == 0.0f) continue;
    const double n_l = glm::dot(shading, at.to_light);
    if (!(n_l > 0.0)) continue;
    const double n_h = std::max(0.0, glm::dot(shading, glm::normalize(at.to_light + to_eye)));
    sum += Vec3(at.irradiance) *
           (diffuse * n_l + local * Vec3(material.specular) * std::pow(n_h, double(material.shininess)));
  }
  return sum + Vec3(material.emission);
}

Scene three_lights(const Vec3& offset = Vec3(0.0)) {
  Scene scene = still_life(true, offset);
  scene.lights = {sun({-0.5, -1.0, -0.6}), lamp(LightType::point, offset + Vec3(0.2, 2.2, 1.2), offset),
                  lamp(LightType::spot, offset + Vec3(-2.0, 3.0, 2.0), offset)};
  for (Light& light : scene.lights) light.intensity *= Vec3f(0.4f, 0.35f, 0.3f);
  scene.materials[0].specular = Vec3f(0.2f);
  scene.materials[0].mirror = 0.25f;
  scene.materials[1].emission = Vec3f(0.05f, 0.0f, 0.1f);
  return scene;
}

TEST(Picture, IsTheSharedFormulaUnderThreeLights) {
  const Drawn drawn = draw(three_lights());
  const View view = drawn.view();
  int tested = 0;
  for (int y = 0; y < view.size.height; ++y) {
    for (int x = 0; x < view.size.width; ++x) {
      const std::size_t pixel = drawn.frame.color.index(x, y);
      const auto hit = hit_away_from_edges(*drawn.world, view, x, y);
      if (!hit) continue;
      const Vec3 drawn_color(drawn.frame.color.data[pixel]);
      if (hit->primitive == no_id) {
        ASSERT_EQ(drawn.frame.color.data[pixel], drawn.scene->background);
        continue;
      }
      const Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
      const Vec3 p = ray.at(hit->t);
      const Vec3 n = face_forward(geometric_normal(*drawn.world, hit->primitive, p), ray.direction);
      const Material& material = drawn.scene->materials[drawn.world->material_of(hit->primitive)];
      bool grazing = false;  // a rounding error decides n.l > 0 there
      for (const Light& light : drawn.scene->lights)
        grazing = grazing || std::abs(glm::dot(n, light_at(light, p).to_light)) < 1e-5;
      if (grazing) continue;
      const Vec3 expected = expected_radiance(drawn, pixel, p, n, n, -ray.direction, material);
      const Vec3 error = glm::abs(drawn_color - expected);
      // Single precision; a highlight's exponent (32) multiplies the relative error of n.h.
      ASSERT_LT(std::max({error.x, error.y, error.z}), 1e-4 * (1.0 + expected.x)) << x << ", " << y;
      ++tested;
    }
  }
  EXPECT_GT(tested, 18000);
}

// A mesh whose normals are those of a sphere is shaded by them, on the viewer's side.
TEST(Picture, InterpolatesShadingNormals) {
  Scene scene;
  scene.materials.resize(1);
  Mesh mesh = square_mesh(2.0);
  for (const Vec3& p : mesh.positions) mesh.normals.emplace_back(glm::normalize(Vec3(p.x, 3.0, p.z)));
  scene.meshes = {mesh};
  scene.instances.push_back({"square", 0, Mat4(1.0), 0});
  scene.camera.eye = Vec3(0.5, 3.0, 4.0);
  scene.lights = {sun({-0.5, -1.0, -0.6})};
  raster::RasterOptions options = small_options();
  options.map.bias.constant = 10.0;
  const Drawn drawn = draw(scene, options);
  const View view = drawn.view();
  int tested = 0;
  for (int y = 0; y < view.size.height; ++y) {
    for (int x = 0; x < view.size.width; ++x) {
      const auto hit = hit_away_from_edges(*drawn.world, view, x, y);
      if (!hit || hit->primitive == no_id) continue;
      const Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
      const Vec3 p = ray.at(hit->t);
      // All four corner normals have one length before normalisation: interpolation over the square's halves
      // is linear in p.
      const auto corners = drawn.world->corners(hit->primitive);
      const Vec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0], n = glm::cross(e1, e2);
      const double wb = glm::dot(glm::cross(p - corners[0], e2), n) / glm::dot(n, n);
      const double wc = glm::dot(glm::cross(e1, p - corners[0]), n) / glm::dot(n, n);
      const auto t = drawn.world->triangle(hit->primitive);
      const Vec3 shading =
          glm::normalize((1.0 - wb - wc) * Vec3(drawn.world->normal(t[0])) +
                         wb * Vec3(drawn.world->normal(t[1])) + wc * Vec3(drawn.world->normal(t[2])));
      const std::size_t pixel = drawn.frame.color.index(x, y);
      const Vec3 expected = expected_radiance(drawn, pixel, p, Vec3(0, 1, 0), shading, -ray.direction,
                                              drawn.scene->materials[0]);
      ASSERT_NEAR(drawn.frame.color.data[pixel].x, expected.x, 1e-4);
      ++tested;
    }
  }
  EXPECT_GT(tested, 4000);
}

// Only the lights asked for have records, but all of them light the picture.
TEST(Picture, DoesNotDependOnWhichRecordsAreAskedFor) {
  Drawn drawn = draw(three_lights());
  const std::vector<std::uint32_t> second{1};
  const auto frame = drawn.renderer->render(drawn.frame.options, second);
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->color.data, drawn.frame.color.data);
  ASSERT_EQ(frame->lights.size(), 1u);
  EXPECT_EQ(frame->lights[0].light, 1u);
  EXPECT_EQ(frame->lights[0].gap.data, drawn.frame.lights[1].gap.data);
}

// What is timed after the picture has no picture of its own, and changes none that is drawn later.
TEST(Picture, TimesCanBeTakenAlone) {
  Drawn drawn = draw(three_lights());
  raster::RasterOptions times = drawn.frame.options;
  times.analysis = false, times.times_alone = true, times.runs = 2, times.shadow_cost = true;
  times.least_subtracted = 2;
  const auto timed = drawn.renderer->render(times, std::vector<std::uint32_t>{1, 2});
  ASSERT_TRUE(timed.has_value()) << timed.error().message();
  EXPECT_TRUE(timed->color.data.empty());
  ASSERT_EQ(timed->lights.size(), 2u);
  for (const raster::LightRecord& light : timed->lights) {
    EXPECT_EQ(light.map_pass.runs.size(), 2u);
    EXPECT_EQ(light.shade_pass.runs.size(), 2u);
    EXPECT_EQ(light.unshadowed_pass.runs.size(), 2u);
    EXPECT_FALSE(light.strips.empty());
    EXPECT_TRUE(light.visibility.data.empty());
  }
  const auto again = drawn.renderer->render(drawn.frame.options, std::vector<std::uint32_t>{0, 1, 2});
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(again->color.data, drawn.frame.color.data);
}

// What was drawn untimed is the first run of what is timed then, even when a map of another size was tried between: a run that
// takes long enough is not made twice.
TEST(Picture, TimesBeginWithTheDrawingThatWasMade) {
  Scene scene = three_lights();
  scene.lights.resize(1);
  Drawn drawn = draw(scene);
  raster::RasterOptions options = drawn.frame.options, times = options;
  const std::vector<std::uint32_t> light{0};
  times.analysis = false, times.times_alone = true, times.runs = 3, times.enough_ms = 1e-9;
  const StageLog log;
  const auto runs_ms = [&] {
    const TimeBudget budget = log.budget();
    const StageTime* stage = budget.find("map runs");
    return stage == nullptr ? 0.0 : stage->wall_ms;
  };
  options.map.size *= 2;
  ASSERT_TRUE(drawn.renderer->render(options, light));
  auto timed = drawn.renderer->render(times, light);
  ASSERT_TRUE(timed) << timed.error().message();
  EXPECT_EQ(timed->lights[0].map_pass.runs.size(), 1u);
  EXPECT_EQ(runs_ms(), 0.0);
  times.enough_ms = never_enough_ms;
  timed = drawn.renderer->render(times, light);
  ASSERT_TRUE(timed) << timed.error().message();
  EXPECT_EQ(timed->lights[0].map_pass.runs.size(), 3u);
  EXPECT_GT(runs_ms(), 0.0);
  const auto again = drawn.renderer->render(drawn.frame.options, light);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->lights[0].map.depth, drawn.frame.lights[0].map.depth);
  EXPECT_EQ(again->lights[0].visibility.data, drawn.frame.lights[0].visibility.data);
}

// A viewer moves the camera and the light between calls.
TEST(Picture, FollowsTheScenesCameraAndLights) {
  Drawn moved = draw(three_lights());
  Scene scene = three_lights();
  for (Scene* s : {moved.scene.get(), &scene}) {
    s->camera.eye += Vec3(-2.0, 0.5, 1.0);
    s->lights[0].direction = glm::normalize(Vec3(0.4, -1.0, 0.2));
    s->lights[1].position += Vec3(0.3, 0.4, -0.2);
    s->lights[2].type = LightType::directional;
  }
  moved.render(moved.frame.options);
  const Drawn fresh = draw(scene);
  EXPECT_EQ(moved.frame.color.data, fresh.frame.color.data);
  EXPECT_EQ(moved.frame.primitive.data, fresh.frame.primitive.data);
}

TEST(Picture, OfASceneWithoutLightsIsAmbientAndEmission) {
  Scene scene = three_lights();
  scene.lights.clear();
  const Drawn drawn = draw(scene);
  const View view = drawn.view();
  const auto hit = closest_hit(*drawn.world, pixel_ray(view, 96.5, 100.5));
  ASSERT_EQ(drawn.world->material_of(hit.primitive), 0u);
  const Vec3f expected =
      scene.ambient * (scene.materials[0].diffuse * 0.75f + Vec3f(0.5f * 0.25f));  // a quarter mirrors
  EXPECT_NEAR(drawn.frame.color.at(96, 100).x, expected.x, 1e-6);
}

// HARD_CASES.md, 37: camera and scene at 1e7. The scene's numbers themselves are rounded there (to 2e-9), so
// pixels whose shadow depends on less may differ; the rest are equal to float rounding.
TEST(Picture, FarFromTheOriginIsThePictureAtTheOrigin) {
  const Drawn near = draw(three_lights());
  for (const Vec3 offset : {Vec3(1e7, -1e7, 1e7), Vec3(0.0, 3e6, 1e7)}) {
    const Drawn far = draw(three_lights(offset));
    std::size_t different = 0, ids = 0;
    for (std::size_t i = 0; i < near.frame.color.data.size(); ++i) {
      const Vec3f error = glm::abs(near.frame.color.data[i] - far.frame.color.data[i]);
      different += std::max({error.x, error.y, error.z}) > 1e-3f ? 1 : 0;
      ids += near.frame.primitive.data[i] != far.frame.primitive.data[i] ? 1 : 0;
    }
    EXPECT_LE(ids, 4u);
    EXPECT_LE(different, near.frame.color.data.size() / 500);
  }
}

// A camera that looks through a telescope: receivers keep to their surfaces, so the test against their own
// plane meets no noise from the eye's distance (11,600 units, where floats are 1e-3 apart).
TEST(Picture, TelescopeSeesNoNoise) {
  Scene scene = still_life(false);
  scene.instances.erase(scene.instances.begin());
  scene.shapes.clear();
  const Vec3 up = glm::normalize(Vec3(0.21, 1.0, 0.13));
  Vec3 t, b;
  orthonormal_basis(up, t, b);
  scene.instances[0].world_from_object =
      Mat4(Vec4(t, 0), Vec4(up, 0), Vec4(glm::cross(t, up), 0), Vec4(0, 0, 0, 1));
  scene.lights = {sun({-0.5, -1.0, -0.6})};
  scene.camera.eye = Vec3(3000.0, 5000.0, 10000.0);
  scene.camera.vertical_fov = 6.0 / 11600.0;
  raster::RasterOptions options = small_options(512);
  options.map.bias = {.constant = 2e-5, .unit = raster::BiasUnit::world};
  options.map.bias.receiver_plane = true;
  const Drawn drawn = draw(scene, options);
  std::size_t seen = 0, shadowed = 0;
  for (std::size_t i = 0; i < drawn.frame.primitive.data.size(); ++i) {
    seen += drawn.frame.primitive.data[i] != no_id ? 1 : 0;
    shadowed += drawn.light().visibility.data[i] == 0.0f ? 1 : 0;
  }
  EXPECT_GT(seen, 5000u);
  EXPECT_EQ(shadowed, 0u);
}

}  // namespace
}  // namespace gnomon::test
