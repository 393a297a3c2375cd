// An effect that no light or material calls for casts no ray and allocates nothing; what one that is called
// for will cost is forecast.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <functional>

#include "raytrace/forecast.h"
#include "scene/load.h"
#include "tests/support/allocation_count.h"
#include "tests/support/effects_support.h"

namespace gnomon {
namespace {

using raytrace::RayCounts;
using raytrace::RayTracedFrame;
using test::trace_picture;

/// Plain surfaces in the light of two hard lights.
Scene plain() {
  Scene scene = test::scene_of({}, {test::plane({0, 0, 0}, {0, 1, 0}), test::sphere({0, 1, 0}, 1.0, 1)});
  scene.materials.resize(2);
  scene.lights = {test::point_light({-4, 6, 4}), test::sun({1, -2, -1})};
  scene.camera.eye = {0.25, 2.25, 6}, scene.camera.target = {0, 0.875, 0};
  return scene;
}

struct EffectCase {
  Effect effect;
  std::function<void(Scene&)> call;
  std::function<std::uint64_t(const RayCounts&)> rays;
};

const std::vector<EffectCase>& effect_cases() {
  static const std::vector<EffectCase> cases{
      {Effect::soft_shadow, [](Scene& s) { s.lights[0].extent = SphereLight{0.3}; },
       [](const RayCounts& r) { return r.soft_shadow; }},
      {Effect::reflection, [](Scene& s) { s.materials[1].mirror = 0.5f; },
       [](const RayCounts& r) { return r.reflection; }},
      {Effect::refraction, [](Scene& s) { s.materials[1].transmission = 0.5f; },
       [](const RayCounts& r) { return r.for_refraction(); }},
      {Effect::glossy, [](Scene& s) { s.materials[1].mirror = 0.5f, s.materials[1].roughness = 0.3f; },
       [](const RayCounts& r) { return r.glossy; }},
      {Effect::indirect_light, [](Scene& s) { s.indirect_samples = 2; },
       [](const RayCounts& r) { return r.indirect; }},
      {Effect::antialiasing, [](Scene& s) { s.camera.samples_per_pixel = 2; },
       [](const RayCounts& r) { return r.antialiasing; }},
      {Effect::hard_shadow, [](Scene&) {}, [](const RayCounts& r) { return r.shadow; }},
  };
  return cases;
}

TEST(EffectCost, AnEffectNotCalledForCastsNoRay) {
  for (const EffectCase& on : effect_cases()) {
    Scene scene = plain();
    on.call(scene);
    const EffectPlan plan = plan_effects(scene);
    const RayTracedFrame frame = trace_picture(scene, {40, 30}, 0, false);
    for (const EffectCase& any : effect_cases()) {
      const bool rough_only = any.effect == Effect::reflection && plan.simulates(Effect::glossy);
      const bool casts = plan.simulates(any.effect) && !rough_only;
      EXPECT_EQ(any.rays(frame.rays) > 0, casts)
          << effect_name(any.effect) << " with " << effect_name(on.effect);
    }
  }
}

TEST(EffectCost, SoftLightsAloneCastNoHardRay) {
  Scene scene = plain();
  for (const auto& [effect, call, rays] : effect_cases()) {
    scene = plain();
    if (effect != Effect::hard_shadow) call(scene);
    scene.lights[0].extent = SphereLight{0.3}, scene.lights[1].extent = SunDisc{0.1};
    const RayTracedFrame frame = trace_picture(scene, {40, 30}, 0, false);
    EXPECT_EQ(frame.rays.shadow, 0u) << effect_name(effect);
    EXPECT_GT(frame.rays.soft_shadow, 0u);
  }
  EXPECT_GT(trace_picture(scene, {40, 30}, 0, true).rays.shadow, 0u) << "records hold the centres' shadows";
}

std::uint64_t bytes_of_a_frame(const Scene& scene) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const test::TestWorld w(scene);
  const raytrace::Tracer tracer(w.world(), raytrace::Accel::bvh);
  const EffectPlan plan = plan_effects(w.scene());
  raytrace::RaytraceOptions options;
  options.size = {64, 48}, options.records = false;
  options.samples_per_pixel = scene.camera.samples_per_pixel;
  const std::vector<std::uint32_t> lights{0, 1};
  std::uint64_t bytes = 0;
  for (int run = 0; run < 2; ++run) {  // the first one warms the threads' own memory
    const std::uint64_t before = test::allocated_bytes();
    const RayTracedFrame frame = trace_frame(tracer, plan, scene.camera, lights, options);
    bytes = test::allocated_bytes() - before;
  }
  return bytes;
}

TEST(EffectCost, AnEffectNotCalledForAllocatesNothing) {
  constexpr std::uint64_t pixels = std::uint64_t{64} * 48, kib = 1024;
  const std::uint64_t base = bytes_of_a_frame(plain());
  // Receivers, colours, shadows of two lights, counts per tile; and what primary and hard shadow rays are
  // traced with: the lists of the cells of eye and lights, and receivers as floats (packet/), 220 KiB here.
  const std::uint64_t images =
      pixels * (sizeof(raytrace::SurfacePoint) + sizeof(Vec3f) + 2 * sizeof(raytrace::PointVisibility));
  EXPECT_GE(base, images);
  EXPECT_LT(base, images + 320 * kib);
  // However many samples the effects would take: nobody asks for them.
  Scene ready = plain();
  ready.glossy_samples = max_samples;
  for (Light& light : ready.lights) light.shadow_samples = max_shadow_samples;
  ready.materials[0].roughness = 0.5f, ready.materials[0].priority = 7,
  ready.materials[0].absorption = Vec3f(1.0f);
  EXPECT_EQ(bytes_of_a_frame(ready), base);
  // The picture's own effects work without memory of their own; a soft light keeps what each pixel sees of
  // it, and the standard error of that.
  for (const EffectCase& on : effect_cases()) {
    Scene scene = plain();
    on.call(scene);
    const std::uint64_t bytes = bytes_of_a_frame(scene);
    const std::uint64_t visibility = pixels * (2 * sizeof(float) - sizeof(raytrace::PointVisibility));
    EXPECT_EQ(bytes > base + kib, on.effect == Effect::soft_shadow) << effect_name(on.effect);
    EXPECT_LE(bytes, base + visibility + kib) << effect_name(on.effect);
  }
}

TEST(EffectCost, ForecastIsWithinAFewPercent) {
  for (const char* name : {"whitted", "penumbra", "fence"}) {
    Scene scene = *load_scene(name);
    scene.camera.samples_per_pixel = 2, scene.indirect_samples = 1;
    const test::TestWorld w(scene);
    const raytrace::Tracer tracer(w.world(), raytrace::Accel::bvh);
    const EffectPlan plan = plan_effects(w.scene());
    raytrace::RaytraceOptions options;
    options.size = {400, 240}, options.samples_per_pixel = 2, options.shadow_samples = 4;
    const raytrace::Forecast forecast = forecast_rays(tracer, plan, scene.camera, options);
    EXPECT_FALSE(forecast.exact);
    std::vector<std::uint32_t> lights(scene.lights.size());
    for (std::uint32_t i = 0; i < lights.size(); ++i) lights[i] = i;
    options.records = false;
    const RayCounts real = trace_frame(tracer, plan, scene.camera, lights, options).rays;
    for (const EffectCase& effect : effect_cases()) {
      const double expected = double(effect.rays(forecast.rays)), cast = double(effect.rays(real));
      // 8192 pixels on a regular grid; what fills a small part of the picture is less sure.
      EXPECT_NEAR(expected, cast, 0.03 * cast + 0.002 * double(options.size.pixels()))
          << name << " " << effect_name(effect.effect);
      EXPECT_EQ(expected == 0.0, cast == 0.0);
    }
    EXPECT_NEAR(double(forecast.rays.primary), double(real.primary), 1.0);
  }
}

TEST(EffectCost, ForecastOfASmallPictureIsExact) {
  const Scene scene = *load_scene("whitted");
  const test::TestWorld w(scene);
  const raytrace::Tracer tracer(w.world(), raytrace::Accel::bvh);
  raytrace::RaytraceOptions options;
  options.size = {80, 60};
  const raytrace::Forecast forecast = forecast_rays(tracer, plan_effects(w.scene()), scene.camera, options);
  EXPECT_TRUE(forecast.exact);
  options.records = false;
  const std::vector<std::uint32_t> lights{0};
  const RayCounts real = trace_frame(tracer, plan_effects(w.scene()), scene.camera, lights, options).rays;
  EXPECT_EQ(forecast.rays.refraction, real.refraction);
  EXPECT_EQ(forecast.rays.shadow, real.shadow);
}

/// Foliage on the left over a ground, under a sun and a lamp with a size.
Scene half_foliage() {
  Mesh leaves = test::triangle_soup(30000, 1.0, 0.03, 7);
  for (Vec3& p : leaves.positions) p.x -= 1.25;
  Scene scene = test::scene_of({std::move(leaves)}, {test::plane({0, -1.5, 0}, {0, 1, 0})});
  scene.lights = {test::point_light({2, 4, 3}), test::sun({-0.3, -1.0, -0.2})};
  scene.lights[0].extent = SphereLight{0.2};
  scene.camera.eye = {0.3, 0.4, 5.0}, scene.camera.target = {0, 0, 0};
  return scene;
}

// What gnomon plan says of single rays against what is then cast: all rows of a small picture, a quarter of a large one.
TEST(EffectCost, SingleRaysAreForecast) {
  const test::TestWorld w(half_foliage());
  const raytrace::Tracer tracer(w.world(), raytrace::Accel::bvh);
  const EffectPlan plan = plan_effects(w.scene());
  const std::vector<std::uint32_t> sun{1};
  for (const ImageSize size : {ImageSize{200, 130}, ImageSize{1280, 720}}) {
    raytrace::RaytraceOptions options;
    options.size = size, options.picture = false;
    const auto forecast = forecast_single_rays(tracer, plan, w.scene().camera, sun, options);
    const auto frame = trace_frame(tracer, plan, w.scene().camera, sun, options);
    ASSERT_EQ(forecast.lights.size(), 1u);
    const raytrace::SingleRayForecast& forecast_sun = forecast.lights[0];
    const raytrace::LightTruth& truth = frame.lights[0];
    EXPECT_EQ(forecast_sun.light, 1u);
    const double share = static_cast<double>(truth.single_rays) / static_cast<double>(truth.rays);
    EXPECT_GT(share, 0.02);
    EXPECT_LT(share, 0.98);
    if (size.height == 130) {
      EXPECT_EQ(forecast.rows, 130);
      EXPECT_EQ(forecast_sun.rays, truth.rays);
      EXPECT_EQ(forecast_sun.single, truth.single_rays);
    } else {
      EXPECT_EQ(forecast.rows, 192);
      EXPECT_NEAR(forecast_sun.share(), share, 0.1);  // three rows of twelve
    }
  }
}

}  // namespace
}  // namespace gnomon
