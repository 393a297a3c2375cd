// Surfaces that light passes, in whole or in part: holes cut by alpha masks, and glass, which casts shadows
// like any surface. And lights that are new: traced until their sheets pay, and the same at every frame.
#include <gtest/gtest.h>

#include "scene/load.h"
#include "tests/hybrid/hybrid_support.h"
#include "tests/support/places.h"

namespace gnomon {
namespace {

using hybrid::LightCache;
using hybrid::Sheets;
using test::Outcome;
using test::run;
using test::Stage;

Mesh with_uvs(Mesh mesh, std::uint64_t seed) {
  test::Random random(seed);
  mesh.uvs.clear();
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.uvs.emplace_back(Vec2{random.uniform(0.0, 4.0), random.uniform(0.0, 4.0)});
  return mesh;
}

/// Triangles without any order over a plane, in the materials of masks, glass and neither.
Scene mixed_scene(std::uint64_t seed) {
  Scene scene = test::scene_of({with_uvs(test::triangle_soup(120, 1.0, 0.5, seed), seed),
                                with_uvs(test::uv_sphere({0.3, 0.2, 0.1}, 0.4, 12, 20, 0.05, seed), seed + 1),
                                test::box(Vec3(-0.7), Vec3(-0.2))},
                               {test::sphere({-0.4, 0.5, 0.4}, 0.3), test::plane({0, -1.1, 0}, {0, 1, 0})});
  scene.name = "holes and glass " + std::to_string(seed);
  Texture holes;
  holes.size = {2, 2}, holes.nearest = true;
  holes.texels = {{255, 255, 255, 255}, {255, 255, 255, 0}, {255, 255, 255, 0}, {255, 255, 255, 255}};
  scene.textures = {holes};
  scene.materials.resize(3);
  scene.materials[1].diffuse_texture = 0, scene.materials[1].alpha_mode = AlphaMode::mask;
  scene.materials[2].transmission = 0.9f;
  for (std::size_t i = 0; i < 3; ++i) {
    Mesh& mesh = scene.meshes[i];
    mesh.triangle_materials.assign(mesh.triangles.size(), static_cast<std::uint32_t>((i + 1) % 3));
  }
  scene.shapes[0].material = 2;
  scene.lights = {test::sun(glm::normalize(Vec3(-0.3, -1, -0.2))), test::point_light({0.5, 1.6, 1.2})};
  scene.camera.eye = {1.2, 1.5, 3.0}, scene.camera.target = Vec3(0.0);
  return scene;
}

TEST(HybridSurfaces, HolesAndGlassEqualRayTracing) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Stage stage(mixed_scene(seed), {160, 90});
    const auto& materials = stage.scene.materials;
    ASSERT_TRUE(std::any_of(materials.begin(), materials.end(),
                            [](const Material& m) { return m.alpha_mode == AlphaMode::mask; }));
    for (std::uint32_t light = 0; light < stage.scene.lights.size(); ++light)
      for (const int size : {16, 300}) EXPECT_EQ(run(stage, light, size).different, 0u);
  }
}

TEST(HybridSurfaces, FilesWithHolesAndGlassEqualRayTracing) {
  const std::string data = gnomon::test::shared_data();
  for (const char* file : {"/alpha_blend_mode_test/AlphaBlendModeTest.glb", "/glass_table/glass-table.glb",
                           "/bevy_palmtree/PalmTree.gltf"}) {
    auto scene = load_scene(data + file);
    if (!scene) GTEST_SKIP() << "no " << file << ": " << scene.error().message();
    const Stage stage(std::move(*scene), {240, 135});
    for (std::uint32_t light = 0; light < stage.scene.lights.size(); ++light)
      EXPECT_EQ(run(stage, light, 512).different, 0u);
  }
}

TEST(HybridCosts, ANewLightIsTracedUntilItsSheetsPay) {
  for (const char* name : {"thin-wall", "floating-box", "sphere-plane"}) {
    auto scene = load_scene(name);
    ASSERT_TRUE(scene);
    const Stage stage(std::move(*scene), {160, 90});
    LightCache cache(stage.tracer, stage.topology, stage.scene.lights[0], stage.map(0, 64),
                     Sheets::when_they_pay);
    const std::uint64_t wait = cache.frames_to_pay(stage.size.pixels());
    ASSERT_GT(wait, 1u);
    const Outcome first = test::compare_pass(stage, 0, cache);
    EXPECT_FALSE(cache.sheets.is_built());
    EXPECT_EQ(first.different, 0u) << name;
    EXPECT_EQ(first.counts.shadowed, 0u);  // without sheets nothing tells
    Outcome last = first;
    for (std::uint64_t frame = 1; frame <= wait; ++frame) {
      last = test::compare_pass(stage, 0, cache);
      EXPECT_EQ(last.different, 0u) << name;
      EXPECT_EQ(cache.sheets.is_built(), frame == wait) << frame;
    }
    EXPECT_LT(last.counts.rays, first.counts.rays / 2) << name;
  }
}

// Looking closely costs more than the rays that it saves once: a camera on the move would pay it every frame.
TEST(HybridCosts, SheetsAreLookedAtCloselyForReceiversThatAskAgain) {
  auto scene = load_scene("courtyard");
  ASSERT_TRUE(scene);
  const Stage stage(std::move(*scene), {320, 180});
  LightCache cache(stage.tracer, stage.topology, stage.scene.lights[0], stage.map(0, 128));
  const auto look = [&](const Camera& camera) {
    raytrace::RaytraceOptions options;
    options.size = stage.size, options.picture = false;
    const auto frame = trace_frame(stage.tracer, plan_effects(stage.scene), camera, {}, options);
    Image<raytrace::PointVisibility> visibility;
    return trace_hard_shadows(stage.tracer, cache, raytrace::make_receivers(frame.receiver), visibility,
                              nullptr);
  };
  const auto first = look(stage.scene.camera);
  const double refined = cache.sheets.stats().refine_ms;
  EXPECT_GT(refined, 0.0);
  Camera moved = stage.scene.camera;
  moved.eye += Vec3(0.05, 0.0, 0.03);
  const auto passing = look(moved);
  EXPECT_EQ(cache.sheets.stats().refine_ms, refined);
  EXPECT_GT(passing.rays, 2 * first.rays);
  const auto staying = look(moved);
  EXPECT_GT(cache.sheets.stats().refine_ms, refined);
  EXPECT_LT(2 * staying.rays, passing.rays);
}

// Beside an orthographic map of everything finite there is the plane alone.
TEST(HybridCosts, ANewLightTracesNothingBesideItsMap) {
  Scene scene = test::scene_of({test::box(Vec3(-0.3), Vec3(0.3))}, {test::plane({0, -0.5, 0}, {0, 1, 0})});
  scene.name = "box on a plane";
  scene.lights = {test::sun(glm::normalize(Vec3(-0.3, -1, -0.2)))};
  scene.camera.eye = {0, 2, 8}, scene.camera.target = {0, 0, 0};
  const Stage stage(std::move(scene), {160, 90});
  LightCache cache(stage.tracer, stage.topology, stage.scene.lights[0], stage.map(0, 256),
                   Sheets::when_they_pay);
  const Outcome out = test::compare_pass(stage, 0, cache);
  EXPECT_FALSE(cache.sheets.is_built());
  EXPECT_EQ(out.different, 0u);
  EXPECT_GT(out.counts.lit, out.counts.asked / 2);
}

}  // namespace
}  // namespace gnomon
