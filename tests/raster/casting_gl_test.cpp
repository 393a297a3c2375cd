// Objects that cast no shadow or receive none: every technique, the ray tracer and the ladder agree with the scene without the
// object, or with light alone.
#include "hybrid/visibility.h"
#include "raytrace/shading/light_samples.h"
#include "tests/support/compare_support.h"
#include "tests/support/one_world.h"
#include "tests/support/raster_scenes.h"
#include "tests/support/solid_samples.h"

namespace gnomon::test {
namespace {

using raster::Technique;

constexpr ImageSize view_size{160, 120};

/// A floor, a pillar and a ball that cast; a screen, a ball and a torus over them that do not where `with`, and are not there
/// without; a shelf that receives nothing.
Scene scene_of(bool with, LightType type, bool shelf_receives = false) {
  Scene scene;
  scene.materials.resize(3);
  scene.materials[1].casts_shadow = false;
  scene.materials[2].receives_shadow = shelf_receives;
  scene.meshes = {square_mesh(6.0), box_mesh({-0.3, 0.0, -0.3}, {0.3, 1.2, 0.3}),
                  box_mesh({-1.5, 1.6, -0.6}, {1.5, 1.7, 0.6}), box_mesh({0.8, 0.0, -0.4}, {1.8, 0.25, 1.4})};
  scene.instances = {{"ground", 0, Mat4(1.0), 0}, {"pillar", 1, Mat4(1.0), 0}, {"shelf", 3, Mat4(1.0), 2}};
  scene.shapes = {{"ball", Sphere{{-1.2, 0.4, 0.9}, 0.4}, 0}};
  scene.meshes.push_back(box_mesh({-4.0, 0.0, -4.0}, {-3.9, 4.0, -3.9}));  // so that maps are laid alike
  scene.meshes.push_back(box_mesh({1.0, 1.0, 0.2}, {1.6, 1.1, 0.8}));      // over the shelf
  scene.instances.push_back({"post", 4, Mat4(1.0), 0});
  scene.instances.push_back({"roof", 5, Mat4(1.0), 0});
  if (with) {
    scene.instances.push_back({"screen", 2, Mat4(1.0), 1});
    scene.shapes.push_back({"pale ball", Sphere{{0.6, 1.1, 1.0}, 0.3}, 1});
    Shape torus = solid_samples(0.4, {-0.4, 1.0, 1.6})[11];
    torus.material = 1;
    scene.shapes.push_back(torus);
  }
  scene.lights = {type == LightType::directional ? sun({0.5, -1.0, -0.35})
                                                 : lamp(type, {-0.4, 3.4, 1.4}, {0, 0, 0})};
  scene.camera.eye = {2.5, 4.0, 5.5}, scene.camera.target = {0.0, 0.4, 0.2};
  return scene;
}

compare::Comparison compared(OneWorld& one, Technique technique, int map_size = 256) {
  compare::CompareOptions options = test_options(view_size, map_size, 0.01);
  options.raster.map.technique = technique;
  one.renderer->use_external_visibility(raster::Technique::hybrid, hybrid::make_visibility(one.world));
  return one.compare(options);
}

/// Pixels that show the same point in both scenes: what has no shadow hides others.
std::vector<std::size_t> shared_pixels(const compare::Comparison& a, const compare::Comparison& b) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < view_size.pixels(); ++i)
    if (a.raytraced.receiver.data[i].position == b.raytraced.receiver.data[i].position &&
        compare::is_compared(a.lights[0].labels.data[i]) && compare::is_compared(b.lights[0].labels.data[i]))
      out.push_back(i);
  return out;
}

class Casting : public testing::TestWithParam<LightType> {};
INSTANTIATE_TEST_SUITE_P(Under, Casting,
                         testing::Values(LightType::directional, LightType::spot, LightType::point));

// The truth, what was drawn and every rung between are those of the scene without what casts nothing. Its own shadows fall on it.
TEST_P(Casting, WhatCastsNoShadowIsSeenAndShadowsNothing) {
  OneWorld with(scene_of(true, GetParam())), without(scene_of(false, GetParam()));
  for (const Technique technique : {Technique::hard, Technique::pcf, Technique::vsm, Technique::second_depth,
                                    Technique::midpoint, Technique::izb, Technique::hybrid}) {
    const compare::Comparison a = compared(with, technique), b = compared(without, technique);
    const auto same = shared_pixels(a, b);
    EXPECT_GT(same.size(), view_size.pixels() / 4);
    std::size_t shadowed = 0, seen = 0, differ = 0;
    for (const std::size_t i : same) {
      EXPECT_EQ(a.raytraced.lights[0].centre.data[i], b.raytraced.lights[0].centre.data[i]);
      shadowed += a.lights[0].rungs[0].data[i] < 0.5f;
      for (const std::size_t rung : {0u, 1u})
        ASSERT_EQ(a.lights[0].rungs[rung].data[i], b.lights[0].rungs[rung].data[i])
            << "technique " << int(technique) << " rung " << rung;
      differ += std::abs(a.lights[0].rungs[6].data[i] - b.lights[0].rungs[6].data[i]) > 0.01f;
    }
    EXPECT_LE(differ, same.size() / 1000) << int(technique);  // other near depths, other roundings
    for (const raytrace::SurfacePoint& point : a.raytraced.receiver.data)
      seen += point.primitive != no_id && !with.world.casts_shadow(point.primitive);
    EXPECT_GT(shadowed, 200u);
    EXPECT_GT(seen, 500u);
    const bool exact = technique == Technique::izb || technique == Technique::hybrid;
    EXPECT_TRUE(!exact || a.lights[0].error.wrong == 0u);
  }
}

// V2 to V5 too, where both maps look alike: the texel's ray passes what casts nothing.
TEST_P(Casting, TheLadderClimbsOnCasters) {
  OneWorld with(scene_of(true, GetParam()));
  const compare::Comparison run = compared(with, Technique::hard, 512);
  std::size_t differ = 0;
  for (std::size_t i = 0; i < view_size.pixels(); ++i)
    differ += compare::is_compared(run.lights[0].labels.data[i]) &&
              run.lights[0].rungs[5].data[i] != run.lights[0].rungs[6].data[i];
  EXPECT_LE(differ, run.lights[0].pixels.compared / 1000);
  const auto& classes = run.lights[0].classes;
  EXPECT_EQ(classes[static_cast<std::size_t>(compare::Label::stored_depth) - 1], 0u);
}

// Every structure and arithmetic, and packets as single rays.
TEST_P(Casting, EveryWayOfTracingAgrees) {
  const Scene scene = scene_of(true, GetParam()), empty = scene_of(false, GetParam());
  const World world = make_world(scene), bare = make_world(empty);
  const raytrace::Tracer truth(bare, raytrace::Accel::brute, raytrace::Precision::exact);
  for (const raytrace::Precision precision : {raytrace::Precision::robust, raytrace::Precision::exact})
    for (const raytrace::Accel accel :
         {raytrace::Accel::bvh, raytrace::Accel::grid, raytrace::Accel::brute}) {
      const raytrace::Tracer tracer(world, accel, precision);
      raytrace::RaytraceOptions options;
      options.size = view_size;
      options.picture = false;
      const std::array<std::uint32_t, 1> light{0};
      const auto frame = trace_frame(tracer, plan_effects(scene), scene.camera, light, options);
      for (std::size_t i = 0; i < view_size.pixels(); ++i) {
        const raytrace::SurfacePoint& point = frame.receiver.data[i];
        if (point.primitive == no_id || light_cannot_reach(scene.lights[0], point.position, point.normal))
          continue;
        const auto got = frame.lights[0].centre.data[i];
        const auto single = tracer.centre_visibility(point, scene.lights[0]);
        ASSERT_EQ(got, single);
        const bool blocked = tracer.occluded(tracer.shadow_ray(point, scene.lights[0]));
        if (!world.receives_shadow(point.primitive)) {
          ASSERT_EQ(got, raytrace::PointVisibility::lit);
          continue;
        }
        if (got == raytrace::PointVisibility::uncertain) continue;
        ASSERT_EQ(blocked, got == raytrace::PointVisibility::shadowed);
        const bool nearest = tracer.nearest_occluder(point, scene.lights[0]).has_value();
        ASSERT_EQ(nearest, blocked);
      }
    }
}

// All that faces the light is lit on it, whatever lies between; its shadow falls on others.
TEST_P(Casting, WhatReceivesNoShadowIsLitInBothRenderers) {
  OneWorld pale(scene_of(true, GetParam())), usual(scene_of(true, GetParam(), true));
  for (const Technique technique :
       {Technique::hard, Technique::pcf, Technique::evsm, Technique::izb, Technique::hybrid}) {
    const compare::Comparison a = compared(pale, technique), b = compared(usual, technique);
    std::size_t spared = 0;
    for (std::size_t i = 0; i < view_size.pixels(); ++i) {
      if (!compare::is_compared(a.lights[0].labels.data[i])) continue;
      const bool receives = pale.world.receives_shadow(a.raytraced.receiver.data[i].primitive);
      spared += !receives && b.lights[0].rungs[0].data[i] < 0.5f;
      for (std::size_t rung = 0; rung < a.lights[0].rungs.size(); ++rung) {
        ASSERT_TRUE(receives || a.lights[0].rungs[rung].data[i] == 1.0f)
            << int(technique) << " rung " << rung;
      }
      ASSERT_TRUE(!receives || a.lights[0].rungs[6].data[i] == b.lights[0].rungs[6].data[i]);
    }
    EXPECT_GT(spared, 30u);
    EXPECT_EQ(a.raster.lights[0].map.depth, b.raster.lights[0].map.depth);
  }
}

TEST(CastingSoft, ALightWithSizeSeesPastWhatCastsNothing) {
  Scene scene = scene_of(true, LightType::point), empty = scene_of(false, LightType::point);
  for (Scene* s : {&scene, &empty}) s->lights[0].extent = SphereLight{0.3}, s->lights[0].shadow_samples = 64;
  OneWorld with(std::move(scene)), without(std::move(empty));
  const compare::Comparison a = compared(with, Technique::hybrid), b = compared(without, Technique::hybrid);
  for (const std::size_t i : shared_pixels(a, b)) {
    EXPECT_EQ(a.raytraced.lights[0].visibility.data[i], b.raytraced.lights[0].visibility.data[i]);
    EXPECT_TRUE(with.world.receives_shadow(a.raytraced.receiver.data[i].primitive) ||
                a.raytraced.lights[0].visibility.data[i] == 1.0f);
  }
}

}  // namespace
}  // namespace gnomon::test
