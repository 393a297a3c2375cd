// Camera, light and depth-map geometry: round trips between every pair of conventions, and the fit's
// promises.
#include <gtest/gtest.h>

#include "scene/camera.h"
#include "scene/effects.h"
#include "scene/generate/random.h"
#include "scene/light.h"
#include "scene/light_map/light_view.h"
#include "tests/support/small_scenes.h"

namespace gnomon {
namespace {

Scene scene_with(Light light) {
  Scene scene =
      test::sunlit_scene({test::floor_mesh(5, 4), test::box_mesh({-1, 0, -1}, {1, 1.5, 0.5})}, {1, -2, 0.5});
  light.direction = scene.lights[0].direction;
  scene.lights[0] = light;
  scene.camera = {{6, 5, 7}, {0, 0.5, 0}, {0, 1, 0}, 0.8};
  return scene;
}

Light light_of(LightType type) {
  Light light;
  light.name = "light";
  light.type = type;
  light.position = {-2.0, 4.0, 1.0};
  light.inner_angle = 0.5;
  light.outer_angle = 0.9;
  return light;
}

LightView fitted(LightType type, int size) {
  const Scene scene = scene_with(light_of(type));
  const World world = make_world(scene);
  const auto view = fit_light_view(world, scene.lights[0], scene.camera, 16.0 / 9.0, size);
  EXPECT_TRUE(view.has_value());
  return view.value_or(LightView{});
}

class LightViews : public ::testing::TestWithParam<LightType> {};
INSTANTIATE_TEST_SUITE_P(All, LightViews,
                         ::testing::Values(LightType::directional, LightType::spot, LightType::point));

TEST_P(LightViews, TexelRayReturnsToItsTexel) {
  const LightView view = fitted(GetParam(), 64);
  Random random(42);
  for (int i = 0; i < 20000; ++i) {
    const int face = static_cast<int>(random.between(0, view.face_count));
    const double u = random.between(0.01, 63.99), v = random.between(0.01, 63.99);
    const Ray ray = texel_ray(view, face, u, v);
    EXPECT_NEAR(glm::length(ray.direction), 1.0, 1e-14);
    const TexelCoordinate t = project_to_texel(view, ray.at(random.between(0.5, 20.0)));
    EXPECT_EQ(t.face, face);
    EXPECT_NEAR(t.u, u, 1e-9);
    EXPECT_NEAR(t.v, v, 1e-9);
  }
}

TEST_P(LightViews, ClipMatrixAgreesWithProjection) {
  const LightView view = fitted(GetParam(), 256);
  const Vec3 reference(3.0, -2.0, 11.0);
  Random random(42);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = 6.0 * random.in_ball();
    const TexelCoordinate t = project_to_texel(view, p);
    if (!t.inside) continue;
    const Vec4 clip = light_clip_from_relative(view, t.face, reference) * Vec4(p - reference, 1.0);
    EXPECT_NEAR(0.5 * (clip.x / clip.w + 1.0) * view.size, t.u, 1e-8);
    EXPECT_NEAR(0.5 * (clip.y / clip.w + 1.0) * view.size, t.v, 1e-8);
    EXPECT_NEAR(clip.z / clip.w, stored_from_depth(view, t.face, t.v, t.depth), 1e-10);
    EXPECT_NEAR(depth_from_stored(view, t.face, t.v, stored_from_depth(view, t.face, t.v, t.depth)), t.depth,
                1e-9 * std::abs(t.depth) + 1e-12);
  }
}

TEST_P(LightViews, NothingThatTheCameraSeesIsCutOff) {
  const Scene scene = scene_with(light_of(GetParam()));
  const World world = make_world(scene);
  const LightView view = fitted(GetParam(), 512);
  Random random(42);
  for (int i = 0; i < 20000; ++i) {
    const auto c = world.corners(static_cast<std::uint32_t>(random.between(0, world.triangle_count())));
    double a = random.between(0, 1), b = random.between(0, 1);
    if (a + b > 1) a = 1 - a, b = 1 - b;
    const Vec3 p = c[0] + a * (c[1] - c[0]) + b * (c[2] - c[0]);
    const Vec3 pixel = project_to_pixels(make_view(scene.camera, {160, 90}), p);
    const bool seen = pixel.z > 0 && pixel.x >= 0 && pixel.y >= 0 && pixel.x < 160 && pixel.y < 90;
    const TexelCoordinate t = project_to_texel(view, p);
    if (!seen || (scene.lights[0].type == LightType::spot && !t.inside)) continue;
    EXPECT_TRUE(t.inside);
    EXPECT_GT(t.depth, view.face(t.face).near_depth);
    EXPECT_LT(t.depth, view.face(t.face).far_depth);
  }
}

TEST(Fit, FollowsTheCamera) {
  Scene scene = scene_with(light_of(LightType::directional));
  const World world = make_world(scene);
  const auto whole = fit_light_view(world, scene.lights[0], scene.camera, 1.0, 64);
  scene.camera.vertical_fov = 0.05;
  const auto part = fit_light_view(world, scene.lights[0], scene.camera, 1.0, 64);
  ASSERT_TRUE(whole && part);
  const auto area = [](const LightView& view) {
    return view.face(0).half_extent.x * view.face(0).half_extent.y;
  };
  EXPECT_LT(area(*part), 0.5 * area(*whole));
}

// What is seen lies between two casters, in light space, too: no caster says how deep the map is.
TEST(Fit, AWindowWithoutCastersHasDepths) {
  Scene scene = scene_with(light_of(LightType::directional));
  scene.lights[0].direction = Vec3(0.0, -1.0, 0.0);
  scene.meshes.clear(), scene.instances.clear();
  scene.shapes = {{"left", Sphere{{-50.0, 0.0, 0.0}, 1.0}, 0}, {"right", Sphere{{50.0, 0.0, 0.0}, 1.0}, 0}};
  scene.camera = {{0.0, 0.0, 20.0}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 0.1};
  const World world = make_world(scene);
  const auto view = fit_light_view(world, scene.lights[0], scene.camera, 1.0, 64);
  ASSERT_TRUE(view);
  EXPECT_LT(view->face(0).near_depth, view->face(0).far_depth);
  EXPECT_TRUE(std::isfinite(view->face(0).near_depth) && std::isfinite(view->face(0).far_depth));
}

TEST(Fit, AnEmptySceneIsAnError) {
  Scene scene;
  scene.lights.push_back(light_of(LightType::directional));
  const World world = make_world(scene);
  EXPECT_FALSE(fit_light_view(world, scene.lights[0], scene.camera, 1.0, 64).has_value());
}

TEST(CubeFaces, TiesGoToXThenY) {
  EXPECT_EQ(cube_face({1, 1, 1}), 0);
  EXPECT_EQ(cube_face({-1, 1, -1}), 1);
  EXPECT_EQ(cube_face({0, 1, 1}), 2);
  EXPECT_EQ(cube_face({0, -1, -1}), 3);
  EXPECT_EQ(cube_face({0, 0, -1}), 5);
}

TEST(Camera, PixelRayAndProjectionAreInverse) {
  const View view = make_view({{1, 2, 3}, {-4, 0, 1}, {0.1, 1, 0}, 0.9}, {640, 360});
  Random random(42);
  for (int i = 0; i < 10000; ++i) {
    const double x = random.between(0, 640), y = random.between(0, 360), t = random.between(0.1, 100);
    const Vec3 p = pixel_ray(view, x, y).at(t);
    const Vec3 pixel = project_to_pixels(view, p);
    EXPECT_NEAR(pixel.x, x, 1e-8);
    EXPECT_NEAR(pixel.y, y, 1e-8);
    const Vec4 clip = clip_from_view(view, 0.01) * view_from_eye_relative(view) * Vec4(p - view.eye, 1.0);
    EXPECT_NEAR((clip.x / clip.w + 1) * 320, x, 1e-8);
    EXPECT_NEAR((1 - clip.y / clip.w) * 180, y, 1e-8);
    EXPECT_NEAR(clip.z / clip.w, 0.01 / pixel.z, 1e-12);
  }
}

TEST(Camera, ParallelRaysAndProjectionAreInverse) {
  const Camera camera{.eye = {1, 2, 3}, .target = {-4, 0, 1}, .up = {0.1, 1, 0}, .orthographic_height = 5.0};
  const View view = make_view(camera, {640, 360});
  const double reach = 250.0;
  EXPECT_EQ(picture_height(camera, 3.0), 5.0);
  EXPECT_EQ(pixel_footprint(view, 77.0), 5.0 / 360);
  Random random(42);
  for (int i = 0; i < 10000; ++i) {
    const double x = random.between(0, 640), y = random.between(0, 360), t = random.between(0.1, 100);
    const Ray ray = pixel_ray(view, x, y);
    EXPECT_EQ(ray.direction, view.forward);
    EXPECT_NEAR(glm::dot(ray.origin - view.eye, view.forward), 0.0, 1e-12);
    EXPECT_NEAR(glm::dot(ray.origin - view.eye, view.right), (x - 320) * 5.0 / 360, 1e-12);
    EXPECT_NEAR(glm::dot(ray.origin - view.eye, view.up), (180 - y) * 5.0 / 360, 1e-12);
    const Vec3 p = ray.at(t), pixel = project_to_pixels(view, p);
    EXPECT_NEAR(pixel.x, x, 1e-8);
    EXPECT_NEAR(pixel.y, y, 1e-8);
    EXPECT_NEAR(pixel.z, t, 1e-10);
    EXPECT_NEAR(view.distance(p), t, 1e-10);
    EXPECT_NEAR(glm::distance(ray_to(view, p).origin, ray.origin), 0.0, 1e-10);
    const Vec4 clip = clip_from_view(view, reach) * view_from_eye_relative(view) * Vec4(p - view.eye, 1.0);
    EXPECT_EQ(clip.w, 1.0);
    EXPECT_NEAR((clip.x + 1) * 320, x, 1e-8);
    EXPECT_NEAR((1 - clip.y) * 180, y, 1e-8);
    EXPECT_NEAR(clip.z, 1.0 - pixel.z / reach, 1e-12);
  }
}

TEST(FacingAway, LightInThePlaneOfTheReceiverIsUnlit) {
  Light light = light_of(LightType::point);
  light.position = {5, 0, 0};
  EXPECT_TRUE(light_cannot_reach(light, {0, 0, 0}, {0, 1, 0}));
  light.position = {5, 1e-12, 0};
  EXPECT_FALSE(light_cannot_reach(light, {0, 0, 0}, {0, 1, 0}));
  EXPECT_TRUE(light_cannot_reach(light, {0, 0, 0}, Vec3(std::nan(""))));
}

TEST(Effects, OnlyWhatTheSceneCallsFor) {
  Scene scene = scene_with(light_of(LightType::directional));
  EXPECT_TRUE(plan_effects(scene).simulates(Effect::hard_shadow));
  EXPECT_FALSE(plan_effects(scene).simulates(Effect::reflection));
  Material mirror{"mirror"};
  mirror.mirror = 0.5f;
  mirror.roughness = 0.2f;
  scene.materials.push_back(mirror);
  EXPECT_FALSE(plan_effects(scene).simulates(Effect::reflection)) << "no object uses it yet";
  scene.instances[1].material = 1;
  const EffectPlan plan = plan_effects(scene);
  EXPECT_TRUE(plan.simulates(Effect::reflection));
  EXPECT_TRUE(plan.simulates(Effect::glossy));
  EXPECT_NE(plan[Effect::glossy].reason.find("mirror"), std::string::npos);
  EXPECT_FALSE(plan[Effect::indirect_light].called_for || plan[Effect::antialiasing].called_for);
  scene.indirect_samples = 1, scene.camera.samples_per_pixel = 2;
  EXPECT_TRUE(plan_effects(scene).simulates(Effect::indirect_light));
  EXPECT_TRUE(plan_effects(scene).simulates(Effect::antialiasing));
}

}  // namespace
}  // namespace gnomon
