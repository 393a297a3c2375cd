// Light reflected once against closed forms: a closed sphere lit from its centre, and the form factor of a
// disc.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/support/effects_support.h"

namespace gnomon {
namespace {

using test::trace_picture;

TEST(Indirect, ClosedSphereShowsOneBounce) {
  // E = I / r^2 everywhere, so rho E directly and rho^2 E after one more reflection, whatever the samples.
  Scene scene = test::scene_of({}, {test::sphere({0, 0, 0}, 2.0)});
  const float albedo = 0.9f;
  scene.materials[0].diffuse = Vec3f(albedo);
  scene.lights = {test::point_light({0, 0, 0})};
  scene.lights[0].intensity = Vec3f(3.0f);
  scene.camera.eye = {0.5, 0.2, 0.1}, scene.camera.target = {1, 2, -3}, scene.camera.vertical_fov = 1.5;
  const double direct = albedo * 3.0 / 4.0;
  for (const Vec3f& c : trace_picture(scene, {8, 6}).color.data) ASSERT_NEAR(c.x, direct, 1e-6);
  for (const int samples : {1, 7, 64}) {
    scene.indirect_samples = samples;
    const auto frame = trace_picture(scene, {8, 6});
    for (const Vec3f& c : frame.color.data) ASSERT_NEAR(c.x, direct * (1.0 + albedo), 2e-6);
    EXPECT_EQ(frame.rays.indirect, 48u * static_cast<unsigned>(samples));
  }
}

// A floor of albedo 0.8 under a glowing disc of radius a at height h: radiance 0.8 a^2 / (a^2 + h^2).
Scene glowing_disc(double a, double h, int samples) {
  Mesh disc;
  constexpr int corners = 4000;
  disc.positions.emplace_back(0.0, h, 0.0);
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * pi * i / corners;
    disc.positions.emplace_back(a * std::cos(angle), h, a * std::sin(angle));
    disc.triangles.push_back(
        {0, static_cast<std::uint32_t>(1 + i), static_cast<std::uint32_t>(1 + (i + 1) % corners)});
  }
  Scene scene = test::scene_of({disc}, {test::plane({0, 0, 0}, {0, 1, 0}, 1)});
  scene.materials.resize(2);
  scene.materials[0].diffuse = Vec3f(0.0f), scene.materials[0].emission = Vec3f(1.0f);
  scene.materials[1].diffuse = Vec3f(0.8f);
  scene.indirect_samples = samples;
  scene.camera.eye = {0, 0.25 * h, 0}, scene.camera.target = {0, 0, 0}, scene.camera.up = {0, 0, 1};
  scene.camera.vertical_fov = 1e-6;
  return scene;
}

TEST(Indirect, DiscShinesByItsFormFactor) {
  std::printf("%8s %12s\n", "samples", "rms error");
  double first = 0.0, last = 0.0;
  for (const int samples : {16, 256, 4096}) {
    double sum = 0.0;
    int tried = 0;
    for (const double a : {0.3, 1.0, 4.0})
      for (std::uint64_t seed = 0; seed < 8; ++seed, ++tried) {
        const double h = 1.5, expected = 0.8 * a * a / (a * a + h * h);
        const double error =
            trace_picture(glowing_disc(a, h, samples), {1, 1}, seed).color.at(0, 0).x - expected;
        sum += error * error;
      }
    last = std::sqrt(sum / tried);
    if (first == 0.0) first = last;
    std::printf("%8d %12.6f\n", samples, last);
  }
  // As for soft shadows, N^-3/4: 256 times the samples, 1/64 of the error; random samples would give 1/16.
  EXPECT_LT(last, first / 30.0);
  EXPECT_LT(last, 2e-3);
}

TEST(Indirect, TheSkyLightsWhatItIsSeenFrom) {
  // Beside an endless black wall half of the cosine-weighted sky is left.
  Scene scene = test::scene_of({}, {test::plane({0, 0, 0}, {0, 1, 0}), test::plane({0, 0, 0}, {1, 0, 0}, 1)});
  scene.materials.resize(2);
  scene.materials[0].diffuse = Vec3f(0.5f), scene.materials[1].diffuse = Vec3f(0.0f);
  scene.background = Vec3f(1.0f), scene.indirect_samples = 4096;
  scene.camera.eye = {1, 1, 0}, scene.camera.target = {1e-3, 0, 0}, scene.camera.vertical_fov = 1e-6;
  EXPECT_NEAR(trace_picture(scene).color.at(0, 0).x, 0.25, 2e-3);
}

TEST(Indirect, EndsAtTheRecursionLimitAndAfterOneBounce) {
  Scene scene = test::scene_of({}, {test::sphere({0, 0, 0}, 2.0)});
  scene.lights = {test::point_light({0, 0, 0})};
  scene.camera.eye = {0.5, 0.2, 0.1};
  scene.indirect_samples = 4, scene.max_depth = 0;
  EXPECT_EQ(trace_picture(scene).rays.indirect, 0u);
  scene.max_depth = 64;
  EXPECT_EQ(trace_picture(scene).rays.indirect, 4u);
}

}  // namespace
}  // namespace gnomon
