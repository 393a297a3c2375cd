// The Whitted tracer's picture: Fresnel's laws, closed forms for glass and mirrors, limits, and independence
// of threads.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <chrono>
#include <thread>

#include "raytrace/frame.h"
#include "raytrace/shading/fresnel.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using raytrace::Accel;
using raytrace::PointVisibility;
using raytrace::RayTracedFrame;
using raytrace::RaytraceOptions;
using raytrace::Tracer;
using test::TestWorld;

/// min_contribution 0: what is tested is the physics and the recursion limit, unless a test says otherwise.
RayTracedFrame trace(const Scene& scene, ImageSize size = {64, 64}, double min_contribution = 0.0) {
  const TestWorld w(scene);
  std::vector<std::uint32_t> lights(scene.lights.size());
  for (std::uint32_t i = 0; i < lights.size(); ++i) lights[i] = i;
  RaytraceOptions options;
  options.size = size;
  options.min_contribution = min_contribution;
  return trace_frame(Tracer(w.world(), Accel::bvh), plan_effects(w.scene()), scene.camera, lights, options);
}

Material glass(float ior) {
  Material m;
  m.diffuse = Vec3f(0.0f), m.transmission = 1.0f, m.ior = ior;
  return m;
}
Material mirror(float share) {
  Material m;
  m.diffuse = Vec3f(0.0f), m.mirror = share;
  return m;
}

/// Glass and mirror spheres over a floor, textured and shiny: every effect at once.
Scene everything() {
  Scene scene =
      test::scene_of({}, {test::plane({0, 0, 0}, {0, 1, 0}), test::sphere({-0.625, 1.25, 1.25}, 1.0, 1),
                          test::sphere({1.25, 1.0, -0.75}, 1.0, 2)});
  Texture checker;
  checker.size = {2, 2};
  checker.texels = {{255, 255, 0, 255}, {200, 30, 30, 255}, {200, 30, 30, 255}, {255, 255, 0, 255}};
  scene.textures = {checker};
  scene.materials[0].diffuse_texture = 0;
  scene.materials.push_back(glass(1.5f));
  scene.materials[1].absorption = {0.3f, 0.1f, 0.2f}, scene.materials[1].specular = Vec3f(0.5f);
  scene.materials.push_back(mirror(0.8f));
  scene.lights = {test::point_light({-4, 6, 4}), test::sun({1, -2, -1})};
  scene.lights[0].intensity = Vec3f(40.0f);
  scene.background = {0.3f, 0.5f, 0.8f}, scene.ambient = Vec3f(0.1f);
  scene.camera.eye = {0.25, 2.25, 6}, scene.camera.target = {0, 0.875, 0};
  return scene;
}

TEST(Fresnel, Case29ReflectedAndRefractedShareAddUpToOne) {
  constexpr double ulp = DBL_EPSILON;
  for (const double ior : {1.0, 1.0 + 1e-9, 1.33, 1.5, 2.4})
    for (const double eta : {1.0 / ior, ior}) {
      const double critical = eta > 1.0 ? std::asin(1.0 / eta) : pi / 2.0;
      std::vector<double> angles{critical - 1e-12, critical, critical + 1e-12, pi / 2.0};
      for (int i = 0; i < 900; ++i) angles.push_back(i * pi / 1800.0);
      for (const double wanted : angles) {
        const double angle = std::min(wanted, pi / 2.0);
        const Vec3 incoming(std::sin(angle), -std::cos(angle), 0.0);
        const raytrace::Refraction r = raytrace::refract(incoming, {0, 1, 0}, eta);
        ASSERT_TRUE(r.reflectance >= 0.0 && r.reflectance <= 1.0 + 4.0 * ulp) << angle;
        if (r.direction == Vec3(0.0)) {
          ASSERT_GE(angle, critical - 2e-12);
          ASSERT_EQ(r.reflectance, 1.0);
          continue;
        }
        // The transmitted power (Born & Wolf 1.5.2, eqs. 20 and 34), in extended precision from the cosine
        // itself.
        const long double e = eta, cos_in = std::max(0.0, -incoming.y);
        const long double cos_out =
            std::sqrt(std::max(0.0L, (1.0L - e) * (1.0L + e) + e * e * cos_in * cos_in));
        const long double s = 2.0L * e * cos_in / (e * cos_in + cos_out),
                          p = 2.0L * e * cos_in / (cos_in + e * cos_out);
        const double transmitted = static_cast<double>(0.5L * (s * s + p * p) * cos_out / (e * cos_in));
        const double sin_out = eta * std::sin(angle);
        // Four units in the last place, and what a rounding of cos_out's square becomes under the root.
        const double tolerance = (4.0 + 8.0 * eta * eta / std::max(static_cast<double>(cos_out), 1e-8)) * ulp;
        ASSERT_NEAR(r.reflectance + transmitted, 1.0, tolerance) << ior << " at " << angle;
        ASSERT_NEAR(r.direction.x, sin_out, std::max(tolerance, 64.0 * ulp));
        ASSERT_NEAR(glm::length(r.direction), 1.0, 4.0 * ulp);
      }
    }
  EXPECT_NEAR(raytrace::refract({0, -1, 0}, {0, 1, 0}, 1.0 / 1.5).reflectance, 0.04, 4.0 * ulp);
  const raytrace::Refraction total = raytrace::refract(glm::normalize(Vec3(1, -0.5, 0)), {0, 1, 0}, 1.5);
  EXPECT_TRUE(total.reflectance == 1.0 && total.direction == Vec3(0.0));
}

TEST(Frame, SlabOfGlassFollowsFresnelAndBeerLambert) {
  // Straight through a slab of thickness 2 at normal incidence: (1 - 0.04)^2 exp(-2 absorption), and 0.04 of
  // the background behind the viewer by the first reflection; internal reflections end at the recursion
  // limit.
  Scene scene = test::scene_of({test::box({-9, -9, -2}, {9, 9, 0})});
  scene.materials[0] = glass(1.5f);
  scene.materials[0].absorption = {0.0f, 0.5f, 1.0f};
  scene.background = Vec3f(1.0f);
  scene.camera.eye = {0, 0, 5}, scene.camera.target = {0, 0, 0}, scene.camera.vertical_fov = 0.001;
  scene.max_depth = 2;
  const auto frame = trace(scene, {5, 5});
  const Vec3f c = frame.color.at(2, 2);
  EXPECT_NEAR(c.x, 0.96 * 0.96 + 0.04, 1e-6);
  EXPECT_NEAR(c.y, 0.96 * 0.96 * std::exp(-1.0) + 0.04, 1e-6);
  EXPECT_NEAR(c.z, 0.96 * 0.96 * std::exp(-2.0) + 0.04, 1e-6);
}

TEST(Frame, Case30GlassOfIndexOneIsNotThere) {
  Scene with = everything();
  with.materials[1] = glass(1.0f);
  Scene without = with;
  without.shapes.erase(without.shapes.begin() + 1);
  const auto a = trace(with, {120, 90}), b = trace(without, {120, 90});
  double worst = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < a.color.data.size(); ++i) {
    const Vec3f d = glm::abs(a.color.data[i] - b.color.data[i]);
    const double difference = std::max({d.x, d.y, d.z});
    worst = std::max(worst, difference), sum += difference;
  }
  // Refraction by an index of 1 turns the ray by rounding alone; a far point of the floor moves by 1e-13, its
  // colour in floats by 1e-6. The mirror sphere magnifies no more than that.
  EXPECT_LT(worst, 2e-5);
  EXPECT_LT(sum / static_cast<double>(a.color.data.size()), 1e-6);
}

TEST(Frame, MirrorsRecurseExactlyToTheLimit) {
  Scene scene = test::scene_of({}, {test::plane({0, 0, -1}, {0, 0, 1}), test::plane({0, 0, 1}, {0, 0, 1})});
  scene.materials[0] = mirror(1.0f);
  scene.materials[0].emission = Vec3f(1.0f);
  scene.camera.eye = {0, 0, 0}, scene.camera.target = {0, 0, -1}, scene.camera.up = {0, 1, 0};
  for (const int depth : {0, 1, 5}) {
    scene.max_depth = depth;
    const auto frame = trace(scene, {8, 8});
    EXPECT_EQ(frame.rays.reflection, 64U * static_cast<unsigned>(depth));
    EXPECT_NEAR(frame.color.at(3, 3).x, 1.0 + depth, 1e-5);  // every mirror on the way glows
  }
  scene.max_depth = 100;
  scene.materials[0].mirror = 0.5f;
  const auto cut = trace(scene, {8, 8}, 1.0 / 500.0);
  EXPECT_EQ(cut.rays.reflection, 64U * 8U);  // 2^-8 > 1/500 > 2^-9
}

TEST(Frame, TotalReflectionStaysInsideAndEnds) {
  // From within a glass cube, at 45 degrees beyond the critical angle of both walls: nothing is refracted.
  Scene scene = test::scene_of({test::box({-1, -1, -1}, {1, 1, 1})});
  scene.materials[0] = glass(1.5f);
  scene.background = Vec3f(1.0f);
  scene.camera.eye = {0.1, 0, 0.05}, scene.camera.target = {1.1, 0, 1.05}, scene.camera.vertical_fov = 0.01;
  scene.max_depth = 12;
  const auto frame = trace(scene, {4, 4});
  EXPECT_EQ(frame.rays.refraction, 0U);
  EXPECT_EQ(frame.rays.reflection, 16U * 12U);
  EXPECT_EQ(frame.color.at(1, 1), Vec3f(0.0f));
}

TEST(Frame, ShadowBehindGlassIsTheStraightTransmittance) {
  Scene scene = test::scene_of({test::box({-5, 1, -5}, {5, 2, 5})}, {test::plane({0, 0, 0}, {0, 1, 0}, 1)});
  scene.materials[0] = glass(1.5f);
  scene.materials[0].absorption = Vec3f(0.7f);
  scene.materials.emplace_back();
  scene.materials[1].diffuse = Vec3f(1.0f);
  scene.lights = {test::sun({0, -1, 0})};
  scene.camera.eye = {0, 0.9, 0}, scene.camera.target = {0, 0, 0}, scene.camera.up = {0, 0, 1};
  const auto frame = trace(scene, {9, 9});
  EXPECT_EQ(frame.lights[0].centre.at(4, 4), PointVisibility::shadowed);  // geometry's answer
  EXPECT_NEAR(frame.color.at(4, 4).x, 0.96 * 0.96 * std::exp(-0.7), 1e-6);
  // The verdict's ray, and for the picture one to the glass, one through it and one behind it.
  EXPECT_EQ(frame.rays.shadow, frame.lights[0].rays + 3U * 81U);
}

TEST(Frame, LocalShadingIsBlinnPhongWithoutPi) {
  Scene scene = test::scene_of({}, {test::plane({0, 0, 0}, {0, 1, 0})});
  scene.materials[0].diffuse = {0.5f, 0.25f, 1.0f}, scene.materials[0].specular = Vec3f(0.5f);
  scene.materials[0].shininess = 10.0f, scene.materials[0].emission = Vec3f(0.125f);
  scene.ambient = Vec3f(0.2f);
  scene.lights = {test::sun({1, -1, 0})};
  scene.lights[0].intensity = Vec3f(2.0f);
  scene.camera.eye = {0, 3, 0}, scene.camera.target = {0, 0, 0}, scene.camera.up = {0, 0, 1};
  const Vec3f c = trace(scene, {1, 1}).color.at(0, 0);
  const double n_dot_l = std::sqrt(0.5), n_dot_h = std::cos(pi / 8.0);
  const auto expected = [&](double diffuse) {
    return 2.0 * (diffuse * n_dot_l + 0.5 * std::pow(n_dot_h, 10.0)) + 0.2 * diffuse + 0.125;
  };
  EXPECT_NEAR(c.x, expected(0.5), 1e-6);
  EXPECT_NEAR(c.y, expected(0.25), 1e-6);
  EXPECT_NEAR(c.z, expected(1.0), 1e-6);
}

TEST(Frame, SmoothNormalsShadeAndGeometryDecides) {
  Scene scene = test::scene_of({test::quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0})});
  scene.meshes[0].normals.assign(4, Vec3f(glm::normalize(Vec3(1, 1, 0))));
  scene.materials[0].diffuse = Vec3f(1.0f);
  scene.lights = {test::sun({-1, -1, 0}), test::sun({-1, 1e-3, 0})};  // the second comes from just below
  scene.camera.eye = {0, 3, 0}, scene.camera.target = {0, 0, 0}, scene.camera.up = {0, 0, 1};
  const auto frame = trace(scene, {1, 1});
  EXPECT_NEAR(frame.color.at(0, 0).x, 1.0, 1e-6);
  EXPECT_EQ(frame.lights[1].centre.at(0, 0), PointVisibility::shadowed);
  EXPECT_EQ(frame.lights[1].rays, 0U);
}

TEST(Frame, EffectsNotCalledForCastNoRay) {
  Scene scene = everything();
  scene.materials[1] = scene.materials[2] = Material{};
  const auto frame = trace(scene, {64, 48});
  EXPECT_EQ(frame.rays.primary, 64U * 48U);
  EXPECT_EQ(frame.rays.reflection + frame.rays.refraction, 0U);
  EXPECT_EQ(frame.rays.shadow, frame.lights[0].rays + frame.lights[1].rays);
}

TEST(Frame, ReceiversOnlyMakesNoPicture) {
  const TestWorld w(everything());
  RaytraceOptions options;
  options.size = {32, 24}, options.picture = false, options.runs = 3;
  const auto frame = trace_frame(Tracer(w.world(), Accel::bvh), plan_effects(w.scene()), w.scene().camera,
                                 std::vector<std::uint32_t>{1}, options);
  EXPECT_TRUE(frame.color.data.empty());
  EXPECT_EQ(frame.primary_rays.runs.size(), 3U);
  ASSERT_EQ(frame.lights.size(), 1U);
  EXPECT_EQ(frame.lights[0].light, 1U);
  EXPECT_EQ(frame.lights[0].shadow_rays.runs.size(), 3U);
}

TEST(Frame, Case24AnEyeLevelWithAFloorDoesNotSeeIt) {
  Scene scene = test::scene_of({test::quad({-4, 0, -4}, {8, 0, 0}, {0, 0, 8})});
  scene.camera = {.eye = {0.3, 0.0, 2.1}, .target = {0.0, 0.2, 0.0}};
  for (const raytrace::SurfacePoint& point : trace(scene, {160, 90}).receiver.data)
    ASSERT_EQ(point.primitive, no_id);
}

TEST(Frame, SameForAnyNumberOfThreads) {
  const Scene scene = everything();
  const auto render = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return trace(scene, {101, 67}, 1.0 / 512.0);
  };
  const auto a = render(1), b = render(2), c = render(2);
  for (const auto* other : {&b, &c}) {
    EXPECT_EQ(a.color.data, other->color.data);
    EXPECT_EQ(a.rays.shadow, other->rays.shadow);
    EXPECT_EQ(a.rays.reflection, other->rays.reflection);
    EXPECT_EQ(a.rays.refraction, other->rays.refraction);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(a.lights[i].centre.data, other->lights[i].centre.data);
    for (std::size_t i = 0; i < a.receiver.data.size(); ++i) {
      ASSERT_EQ(a.receiver.data[i].primitive, other->receiver.data[i].primitive);
      if (a.receiver.data[i].primitive == no_id) continue;
      ASSERT_TRUE(a.receiver.data[i].position == other->receiver.data[i].position);
    }
  }
}

// The window gives a comparison up at any moment: no structure may be left half made, and the tracer goes on.
TEST(Frame, AStopAtAnyMomentLeavesTheTracerWhole) {
  const Scene scene = everything();
  const TestWorld w(scene);
  const Tracer tracer(w.world(), Accel::bvh);
  const EffectPlan plan = plan_effects(w.scene());
  const std::vector<std::uint32_t> lights{0, 1};
  RaytraceOptions options;
  options.size = {320, 180};
  const RayTracedFrame whole = trace_frame(tracer, plan, scene.camera, lights, options);
  for (int moment = 0; moment < 40; ++moment) {
    std::stop_source stop;
    RaytraceOptions stopped = options;
    stopped.stop = stop.get_token();
    std::thread asking([&] {
      std::this_thread::sleep_for(std::chrono::microseconds(200 * moment));
      stop.request_stop();
    });
    if (moment == 0) asking.join();
    const RayTracedFrame frame = trace_frame(tracer, plan, scene.camera, lights, stopped);
    if (moment == 0)
      EXPECT_TRUE(frame.lights.empty());
    else
      asking.join();
  }
  const RayTracedFrame again = trace_frame(tracer, plan, scene.camera, lights, options);
  EXPECT_EQ(again.color.data, whole.color.data);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(again.lights[i].centre.data, whole.lights[i].centre.data);
}

TEST(Frame, EveryPixelIsFinite) {
  Scene scene = everything();
  scene.lights.push_back(test::point_light({1.25, 2.0, -0.75}));  // on the mirror sphere
  scene.lights.push_back(test::point_light({0, 0, 0}));           // on the floor
  for (const Vec3f& c : trace(scene, {160, 120}).color.data)
    ASSERT_TRUE(std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z));
}

TEST(Frame, FarFromTheOriginIsTheSamePicture) {
  // Case 37: the scene's numbers are short binary fractions, so that moving it by 1e7 is exact; what is left
  // is an ulp of 1e7, 2e-9, in each point on a surface.
  Scene near = everything(), far = near;
  const Vec3 shift(1e7, -1e7, 1e7);
  for (Shape& s : far.shapes) {
    if (auto* sphere = std::get_if<Sphere>(&s.geometry))
      sphere->center += shift;
    else
      std::get<Plane>(s.geometry).point += shift;
  }
  for (Light& light : far.lights) light.position += shift;
  far.camera.eye += shift, far.camera.target += shift;
  const auto a = trace(near, {120, 90}), b = trace(far, {120, 90});
  std::size_t differ = 0;
  for (std::size_t i = 0; i < a.color.data.size(); ++i) {
    const Vec3f d = glm::abs(a.color.data[i] - b.color.data[i]);
    differ += std::max({d.x, d.y, d.z}) > 1e-3f ? 1 : 0;
  }
  EXPECT_LT(differ, 12U);  // 0.1 %: pixels on the checker's and the outlines' edges
}

}  // namespace
}  // namespace gnomon
