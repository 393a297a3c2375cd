// Several samples per pixel: an edge's pixel shows the share of its area, and one sample is the centre.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/support/effects_support.h"

namespace gnomon {
namespace {

using test::trace_picture;

// A picture of one pixel of size 2 x 2 at distance 1; white to the left of x (or below y), black beyond.
double covered(double share, bool upright, int samples, std::uint64_t seed) {
  const double edge = 2.0 * share - 1.0;
  Scene scene = test::scene_of({upright ? test::quad({-9, -9, 0}, {9 + edge, 0, 0}, {0, 18, 0})
                                        : test::quad({-9, -9, 0}, {18, 0, 0}, {0, 9 + edge, 0})});
  scene.materials[0].diffuse = Vec3f(0.0f), scene.materials[0].emission = Vec3f(1.0f);
  scene.camera.eye = {0, 0, 1}, scene.camera.target = {0, 0, 0}, scene.camera.vertical_fov = 0.5 * pi;
  scene.camera.samples_per_pixel = samples;
  return trace_picture(scene, {1, 1}, seed).color.at(0, 0).x;
}

TEST(Antialiasing, AnEdgesPixelShowsTheShareOfItsArea) {
  // One sample lies in each of N columns, and for powers of two in each of N rows: the error is below 1/N.
  for (const int samples : {4, 16, 64, 1024})
    for (const double share : {0.03, 0.25, 0.4999, 0.77})
      for (std::uint64_t seed = 0; seed < 4; ++seed) {
        ASSERT_NEAR(covered(share, true, samples, seed), share, 1.0 / samples + 1e-6);
        ASSERT_NEAR(covered(share, false, samples, seed), share, 1.0 / samples + 1e-6);
      }
  for (const int samples : {2, 3, 5, 9, 100})
    EXPECT_NEAR(covered(0.3, true, samples, 1), 0.3, 1.0 / samples + 1e-6);
}

TEST(Antialiasing, IsUnbiased) {
  double sum = 0.0;
  constexpr int seeds = 4000;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) sum += covered(0.37, true, 2, seed);
  EXPECT_NEAR(sum / seeds, 0.37, 5.0 * 0.25 / std::sqrt(double(seeds)));
}

Scene lit_things() {
  Scene scene =
      test::scene_of({}, {test::plane({0, 0, 0}, {0, 1, 0}), test::sphere({-0.6, 1.25, 1.25}, 1.0, 1),
                          test::sphere({1.25, 1.0, -0.75}, 1.0, 2)});
  scene.materials = {Material{}, test::glass_of(1.5f), test::mirror_of(0.7f, 0.2f)};
  scene.lights = {test::point_light({-4, 6, 4}), test::sun({1, -2, -1})};
  scene.lights[0].extent = SphereLight{0.5}, scene.lights[0].intensity = Vec3f(40.0f);
  scene.lights[0].shadow_samples = 8;
  scene.background = {0.3f, 0.5f, 0.8f}, scene.indirect_samples = 4, scene.glossy_samples = 4;
  scene.camera.eye = {0.25, 2.25, 6}, scene.camera.target = {0, 0.875, 0};
  return scene;
}

TEST(Antialiasing, OneSampleIsThePixelsCentre) {
  Scene scene = lit_things();
  const auto once = trace_picture(scene, {60, 40});
  EXPECT_EQ(once.rays.antialiasing, 0u);
  scene.camera.samples_per_pixel = 4;
  const auto four = trace_picture(scene, {60, 40});
  EXPECT_EQ(four.rays.antialiasing, 4u * 2400u);
  // What is not the picture stays at the centres.
  for (std::size_t i = 0; i < once.receiver.data.size(); ++i) {
    ASSERT_EQ(once.receiver.data[i].primitive, four.receiver.data[i].primitive);
    ASSERT_EQ(once.lights[1].centre.data[i], four.lights[1].centre.data[i]);
  }
  EXPECT_NE(once.color.data, four.color.data);
}

TEST(Antialiasing, TheSeedDecidesNotTheThreads) {
  Scene scene = lit_things();
  scene.camera.samples_per_pixel = 3;
  const auto all = trace_picture(scene, {50, 40}, 5);
  const auto other = trace_picture(scene, {50, 40}, 6);
  EXPECT_NE(all.color.data, other.color.data);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto single = trace_picture(scene, {50, 40}, 5);
  EXPECT_EQ(all.color.data, single.color.data);
  EXPECT_EQ(all.rays.glossy, single.rays.glossy);
  EXPECT_EQ(all.rays.indirect, single.rays.indirect);
  EXPECT_EQ(all.rays.soft_shadow, single.rays.soft_shadow);
}

}  // namespace
}  // namespace gnomon
