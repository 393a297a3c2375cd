// Lights with size against closed forms: umbra and penumbra radii, the penumbra's profile, the error's fall
// with the number of samples, the limit of size zero, and that hard lights pay nothing.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstdio>

#include "raytrace/frame.h"
#include "raytrace/shading/light_samples.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using raytrace::Accel;
using raytrace::PointVisibility;
using raytrace::RayTracedFrame;
using raytrace::RaytraceOptions;
using raytrace::SurfacePoint;
using raytrace::Tracer;
using test::TestWorld;

// docs/design.md, section 3: a disc light of radius R at height H, a disc of radius a at height h, the same axis.
constexpr double R = 0.4, H = 4.0, a = 0.6, h = 1.6;
constexpr double umbra = (a * H - R * h) / (H - h), penumbra = (a * H + R * h) / (H - h);

// A fan; its polygon lies within 2.5e-6 of the circle.
Mesh disc(double radius, double height, int corners = 2000) {
  Mesh mesh;
  mesh.positions.emplace_back(0.0, height, 0.0);
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * pi * i / corners;
    mesh.positions.emplace_back(radius * std::cos(angle), height, radius * std::sin(angle));
    mesh.triangles.push_back(
        {0, static_cast<std::uint32_t>(1 + i), static_cast<std::uint32_t>(1 + (i + 1) % corners)});
  }
  return mesh;
}

Scene coaxial(const LightExtent& extent) {
  Scene scene = test::scene_of({disc(a, h)}, {test::plane({0, 0, 0}, {0, 1, 0})});
  scene.lights = {test::point_light({0, H, 0})};
  scene.lights[0].extent = extent;
  scene.camera.eye = {0.0, 9.0, 0.0}, scene.camera.target = {0, 0, 0}, scene.camera.up = {0, 0, -1};
  scene.camera.vertical_fov = 0.7;
  return scene;
}

class Coaxial : public testing::Test {
 protected:
  explicit Coaxial(const LightExtent& extent = DiscLight{R, {0, -1, 0}})
      : world_(coaxial(extent)), tracer_(world_.world(), Accel::bvh) {}

  SurfacePoint floor_point(const Vec3& position) const {
    const Ray down{position + Vec3(0, 0.5, 0), {0, -1, 0}};
    return tracer_.surface_point(down, *tracer_.closest_hit(down));
  }
  raytrace::SampledVisibility seen(double radius, int samples, std::uint64_t key) const {
    return light_visibility(tracer_, floor_point({radius, 0.0, 0.0}), world_.scene().lights[0], samples, key);
  }
  double share(double radius, double angle, int samples, std::uint64_t key) const {
    const SurfacePoint point = floor_point({radius * std::cos(angle), 0.0, radius * std::sin(angle)});
    return light_visibility(tracer_, point, world_.scene().lights[0], samples, key).share;
  }

  // The radius where `inside(share)` ends.
  template <class Inside>
  double edge(double lo, double hi, double angle, const Inside& inside) const {
    constexpr int samples = 65536, halvings = 12;
    for (int i = 0; i < halvings; ++i) {
      const double middle = 0.5 * (lo + hi);
      (inside(share(middle, angle, samples, 7)) ? lo : hi) = middle;
    }
    return 0.5 * (lo + hi);
  }

  TestWorld world_;
  Tracer tracer_;
};

// Area that two circles share, radii r and s, centres d apart.
double lens(double r, double s, double d) {
  if (d >= r + s) return 0.0;
  if (d <= std::abs(r - s)) return pi * std::min(r, s) * std::min(r, s);
  const double x = std::acos((d * d + r * r - s * s) / (2.0 * d * r));
  const double y = std::acos((d * d + s * s - r * r) / (2.0 * d * s));
  return r * r * (x - 0.5 * std::sin(2.0 * x)) + s * s * (y - 0.5 * std::sin(2.0 * y));
}

// Against the scatter of many seeds; 400 of them tell a standard deviation to 4 %. The points are spread more
// evenly than their strata alone make them, so the estimate is on the safe side, up to twice the scatter
// here; it still has to be well below that of samples without strata.
TEST_F(Coaxial, StandardErrorCoversTheScatterOfTheSamples) {
  for (const int samples : {2, 3, 4, 8, 15, 16, 64, 100, 256})
    for (const double radius : {umbra + 0.3 * (penumbra - umbra), 0.5 * (umbra + penumbra)}) {
      constexpr int seeds = 400;
      double sum = 0.0, squares = 0.0, claimed = 0.0;
      for (int key = 0; key < seeds; ++key) {
        const raytrace::SampledVisibility v = seen(radius, samples, static_cast<std::uint64_t>(key));
        sum += v.share, squares += v.share * v.share, claimed += v.standard_error * v.standard_error;
      }
      const double scatter = std::sqrt(squares / seeds - sum * sum / seeds / seeds);
      const double estimate = std::sqrt(claimed / seeds);
      std::printf("  %3d samples: scatter %.4f, estimate %.4f, ratio %.2f\n", samples, scatter, estimate,
                  estimate / scatter);
      EXPECT_GT(estimate, 0.9 * scatter) << samples;
      if (samples < 16) continue;  // whose strata are too few to tell by
      const double mean = sum / seeds, unstratified = std::sqrt(mean * (1.0 - mean) / samples);
      EXPECT_LT(estimate, 0.6 * unstratified) << samples;
    }
  EXPECT_EQ(seen(0.5 * umbra, 64, 1).standard_error, 0.0);
}

// The blocker seen from the floor covers a disc of the light's plane.
double true_share(double radius) {
  return 1.0 - lens(R, a * H / h, radius * (H - h) / h) / (pi * R * R);
}

TEST_F(Coaxial, UmbraAndPenumbraEndWhereTheClosedFormSays) {
  // At the radii themselves no area is visible, or hidden, so the samples notice them a little late: with
  // 65536 of them by some 0.1 % of the penumbra's width.
  constexpr double tolerance = 0.005 * (penumbra - umbra);
  for (const double angle : {0.1, 1.3, 2.9, 4.4}) {
    const double dark = edge(0.0, penumbra, angle, [](double share) { return share == 0.0; });
    const double grey = edge(0.0, 2.0 * penumbra, angle, [](double share) { return share < 1.0; });
    EXPECT_NEAR(dark, umbra, tolerance) << angle;
    EXPECT_NEAR(grey, penumbra, tolerance) << angle;
    std::printf("umbra off by %+.4f %%, penumbra by %+.4f %% of the penumbra's width\n",
                100.0 * (dark - umbra) / (penumbra - umbra), 100.0 * (grey - penumbra) / (penumbra - umbra));
  }
}

TEST_F(Coaxial, ErrorFallsWithTheNumberOfSamplesAsStratifiedSamplesShould) {
  // Across an edge, N stratified samples leave an error of N^-3/4 (only the strata on the edge err), random
  // ones N^-1/2.
  constexpr int points = 400;
  double first = 0.0, last = 0.0;
  int least = 4, most = 4096;
  std::printf("%8s %12s %10s\n", "samples", "rms error", "x N^0.75");
  for (int n = least; n <= most; n *= 4) {
    double sum = 0.0;
    for (int i = 0; i < points; ++i) {
      const double radius = umbra + (penumbra - umbra) * (i + 0.5) / points;
      const double error = share(radius, 2.399963 * i, n, 1000 + i) - true_share(radius);
      sum += error * error;
    }
    const double rms = std::sqrt(sum / points);
    std::printf("%8d %12.6f %10.4f\n", n, rms, rms * std::pow(n, 0.75));
    (n == least ? first : last) = rms;
  }
  const double order = -std::log(last / first) / std::log(double(most) / least);
  std::printf("order %.3f\n", order);
  EXPECT_GT(order, 0.65);
  EXPECT_LT(order, 0.9);
}

TEST_F(Coaxial, SamplesAreUnbiased) {
  for (const int n : {1, 3, 7, 16}) {
    constexpr int keys = 4000;
    double sum = 0.0;
    const double radius = 0.9;
    for (int key = 0; key < keys; ++key) sum += share(radius, 0.3, n, static_cast<std::uint64_t>(key));
    // Five standard deviations of single random samples.
    EXPECT_NEAR(sum / keys, true_share(radius), 5.0 * 0.5 / std::sqrt(double(keys) * n)) << n;
  }
}

RayTracedFrame trace(const Scene& scene, int samples = 0, std::uint64_t seed = 0) {
  const TestWorld w(scene);
  std::vector<std::uint32_t> lights(scene.lights.size());
  for (std::uint32_t i = 0; i < lights.size(); ++i) lights[i] = i;
  RaytraceOptions options;
  options.size = {80, 60};
  options.shadow_samples = samples, options.seed = seed;
  return trace_frame(Tracer(w.world(), Accel::bvh), plan_effects(w.scene()), scene.camera, lights, options);
}

std::vector<LightExtent> extents(double size) {
  return {SphereLight{size}, DiscLight{size, glm::normalize(Vec3(0.3, -1, 0.2))},
          RectangleLight{{size, 0, 0}, {0, 0, 0.5 * size}}};
}

TEST(SoftShadows, Case40ALightThatShrinksBecomesTheHardOne) {
  const RayTracedFrame hard = trace(coaxial({}));
  for (std::size_t kind = 0; kind < extents(1.0).size(); ++kind) {
    double before = infinity;
    for (const double size : {1.0, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-6, 1e-9, 1e-12}) {
      const RayTracedFrame soft = trace(coaxial(extents(size)[kind]), 16);
      double difference = 0.0;
      for (std::size_t i = 0; i < hard.receiver.data.size(); ++i) {
        const float share = soft.lights[0].visibility.data[i];
        ASSERT_TRUE(share >= 0.0f && share <= 1.0f);
        ASSERT_EQ(soft.lights[0].centre.data[i], hard.lights[0].centre.data[i]);
        if (hard.lights[0].centre.data[i] == PointVisibility::uncertain) continue;
        difference +=
            std::abs(double(share) - (hard.lights[0].centre.data[i] == PointVisibility::lit ? 1.0 : 0.0));
      }
      EXPECT_LE(difference, before) << kind << " " << size;
      before = difference;
    }
    EXPECT_EQ(before, 0.0) << kind;
  }
}

TEST(SoftShadows, TheSunsPenumbraIsAsWideAsItsDiscSays) {
  // The edge of a half-plane at height h, the sun overhead: from full shadow to full light over 2 h tan(d/2).
  Scene scene =
      test::scene_of({test::quad({0, h, -50}, {0, 0, 100}, {50, 0, 0})}, {test::plane({0, 0, 0}, {0, 1, 0})});
  scene.lights = {test::sun({0, -1, 0})};
  const double diameter = 0.1;
  scene.lights[0].extent = SunDisc{diameter};
  const TestWorld w(scene);
  const Tracer tracer(w.world(), Accel::bvh);
  const double half = h * std::tan(0.5 * diameter);
  double worst = 0.0;
  for (int i = -60; i <= 60; ++i) {
    const double x = half * i / 50.0;
    const Ray down{{x, 0.1, 0.3}, {0, -1, 0}};
    const SurfacePoint point = tracer.surface_point(down, *tracer.closest_hit(down));
    // Share of a disc on one side of a chord at distance c from its centre.
    const double c = std::clamp(-x / half, -1.0, 1.0);
    const double expected = (std::acos(c) - c * std::sqrt(1.0 - c * c)) / pi;
    const double share = light_visibility(tracer, point, scene.lights[0], 4096, 5).share;
    worst = std::max(worst, std::abs(share - (1.0 - expected)));
    if (std::abs(i) > 50) {
      EXPECT_EQ(share, i < 0 ? 1.0 : 0.0);
    }
  }
  // 4096^-3/4 = 0.002 is the standard deviation's order; the cap's disc differs from a flat one by
  // diameter^2.
  EXPECT_LT(worst, 0.008);
}

TEST(SoftShadows, WhatLiesBelowTheHorizonIsNotSeen) {
  // A sphere light whose centre lies on a plane's horizon is seen by half, from inside it too; nothing else
  // is there.
  Scene scene = test::scene_of({}, {test::plane({0, 0, 0}, {0, 1, 0})});
  scene.lights = {test::point_light({5, 1e-9, 0})};
  for (const double radius : {1.0, 4.0, 8.0}) {
    scene.lights[0].extent = SphereLight{radius};
    const TestWorld w(scene);
    const Tracer tracer(w.world(), Accel::bvh);
    const Ray down{{0, 0.1, 0}, {0, -1, 0}};
    const SurfacePoint point = tracer.surface_point(down, *tracer.closest_hit(down));
    EXPECT_NEAR(light_visibility(tracer, point, scene.lights[0], 4096, 3).share, 0.5, 0.01) << radius;
  }
}

TEST(SoftShadows, LightsWithoutSizeCastNoSampleAndKeepNoImage) {
  Scene scene = coaxial({});
  const RayTracedFrame hard = trace(scene, 16);
  EXPECT_FALSE(plan_effects(scene).simulates(Effect::soft_shadow));
  EXPECT_EQ(hard.rays.soft_shadow, 0u);
  EXPECT_EQ(hard.lights[0].soft_rays, 0u);
  EXPECT_EQ(hard.lights[0].visibility.data.capacity(), 0u);
  // Size zero is the same, bit by bit.
  for (const LightExtent& extent : extents(0.0)) {
    scene.lights[0].extent = extent;
    const RayTracedFrame zero = trace(scene, 16);
    EXPECT_FALSE(plan_effects(scene).simulates(Effect::soft_shadow));
    EXPECT_EQ(zero.color.data, hard.color.data);
    EXPECT_EQ(zero.rays.soft_shadow, 0u);
    EXPECT_EQ(zero.rays.shadow, hard.rays.shadow);
  }
  // One soft light beside a hard one: only it is sampled, so often as asked.
  scene.lights[0].extent = DiscLight{R, {0, -1, 0}};
  scene.lights.push_back(test::sun({0.2, -1, 0}));
  const RayTracedFrame both = trace(scene, 16);
  EXPECT_EQ(both.rays.soft_shadow_asked, 16 * both.lights[0].rays);
  EXPECT_EQ(both.lights[1].visibility.data.capacity(), 0u);
  EXPECT_TRUE(plan_effects(scene).simulates(Effect::hard_shadow));
  scene.lights[0].shadow_samples = 5;
  EXPECT_EQ(trace(scene).rays.soft_shadow_asked, 5 * both.lights[0].rays);
}

// Mirrors and glass, so that soft shadows are asked for behind the first hit too.
Scene soft_whitted() {
  Scene scene = test::scene_of({disc(a, h, 40)},
                               {test::plane({0, 0, 0}, {0, 1, 0}), test::sphere({1.5, 0.5, 0.0}, 0.5, 1),
                                test::sphere({-1.5, 0.5, 0.0}, 0.5, 2)});
  scene.materials.resize(3);
  scene.materials[1].mirror = 0.8f;
  scene.materials[2].transmission = 0.9f, scene.materials[2].diffuse = Vec3f(0.0f);
  scene.lights = {test::point_light({0, H, 0})};
  scene.lights[0].extent = SphereLight{R};
  scene.camera.eye = {0, 4, 6}, scene.camera.target = {0, 0.4, 0};
  return scene;
}

TEST(SoftShadows, TheSeedDecidesNotTheThreads) {
  const Scene scene = soft_whitted();
  const RayTracedFrame all = trace(scene, 8, 1);
  EXPECT_GT(all.rays.soft_shadow, all.lights[0].soft_rays);  // behind mirrors and glass
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const RayTracedFrame single = trace(scene, 8, 1);
    EXPECT_EQ(single.color.data, all.color.data);
    EXPECT_EQ(single.lights[0].visibility.data, all.lights[0].visibility.data);
    EXPECT_EQ(single.rays.soft_shadow, all.rays.soft_shadow);
  }
  const RayTracedFrame other = trace(scene, 8, 2);
  EXPECT_NE(other.lights[0].visibility.data, all.lights[0].visibility.data);
}

// What rays before them had made must not change how many are cast.
TEST(SoftShadows, TheCountDoesNotDependOnTheRaysBefore) {
  const TestWorld w(soft_whitted());
  const Tracer tracer(w.world(), Accel::bvh);
  RaytraceOptions options;
  options.size = {80, 60}, options.shadow_samples = 8;
  const EffectPlan plan = plan_effects(w.scene());
  const RayTracedFrame first = trace_frame(tracer, plan, w.scene().camera, {{0}}, options);
  const RayTracedFrame second = trace_frame(tracer, plan, w.scene().camera, {{0}}, options);
  EXPECT_LT(first.lights[0].soft_rays, first.lights[0].soft_rays_asked) << "shafts were looked through";
  EXPECT_EQ(first.lights[0].soft_rays, second.lights[0].soft_rays);
  EXPECT_EQ(first.rays.soft_shadow, second.rays.soft_shadow);
}

}  // namespace
}  // namespace gnomon
