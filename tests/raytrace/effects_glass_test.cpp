// Glass within and across glass: closed forms for stacks of slabs, what priorities hide, and an eye in glass.
#include <gtest/gtest.h>

#include "raytrace/shading/interior.h"
#include "tests/support/effects_support.h"

namespace gnomon {
namespace {

using raytrace::cross;
using raytrace::Crossing;
using raytrace::Interior;
using test::glass_of;
using test::trace_picture;

TEST(Interior, HighestPriorityIsThereOfEqualsTheLast) {
  Scene scene;
  scene.materials = {glass_of(1.5f, 1), glass_of(1.3f, 0), glass_of(1.1f, 1)};
  Interior inside;
  EXPECT_EQ(inside.medium(scene), no_id);
  Crossing c = cross(scene, inside, 0, true);
  EXPECT_TRUE(c.is_boundary());
  EXPECT_EQ(c.before, no_id);
  EXPECT_EQ(c.behind, 0u);
  c = cross(scene, c.inside, 1, true);
  EXPECT_FALSE(c.is_boundary()) << "the lower priority is not there";
  c = cross(scene, c.inside, 0, false);
  EXPECT_TRUE(c.is_boundary());
  EXPECT_EQ(c.before, 0u);
  EXPECT_EQ(c.behind, 1u) << "but is where the higher one ends";
  c = cross(scene, c.inside, 1, false);
  EXPECT_EQ(c.behind, no_id);
  EXPECT_TRUE(c.inside.empty());
  c = cross(scene, cross(scene, {}, 0, true).inside, 2, true);
  EXPECT_EQ(c.behind, 2u) << "of equals the last";
  c = cross(scene, {}, 1, false);
  EXPECT_EQ(c.before, 1u) << "left without having been entered";
  EXPECT_EQ(c.behind, no_id);
}

TEST(Interior, ForgetsTheFirstWhenFull) {
  Scene scene;
  scene.materials = {glass_of(1.5f), glass_of(1.3f)};
  Interior inside;
  inside.enter(0);
  for (std::size_t i = 0; i < Interior::capacity; ++i) inside.enter(1);
  EXPECT_FALSE(inside.leave(0));
  for (std::size_t i = 0; i < Interior::capacity; ++i) EXPECT_TRUE(inside.leave(1));
  EXPECT_TRUE(inside.empty());
}

double fresnel_normal(double a, double b) {
  return (a - b) * (a - b) / ((a + b) * (a + b));
}

// Slabs one behind the other, overlapping: glass in z from -1 to 0, water from -3 to -1 + overlap. Straight
// through, without the light that is reflected on its way (it needs more than three steps).
double stack(double overlap, int glass_priority, int water_priority) {
  Scene scene =
      test::scene_of({test::box({-9, -9, -1}, {9, 9, 0}), test::box({-9, -9, -3}, {9, 9, -1 + overlap}),
                      test::quad({-50, -50, -5}, {100, 0, 0}, {0, 100, 0})});
  scene.materials = {glass_of(1.5f, glass_priority), glass_of(1.33f, water_priority), Material{}};
  scene.materials[0].absorption = Vec3f(0.2f), scene.materials[1].absorption = Vec3f(0.7f);
  scene.materials[2].diffuse = Vec3f(0.0f), scene.materials[2].emission = Vec3f(1.0f);
  scene.instances[1].material = 1, scene.instances[2].material = 2;
  scene.camera = test::straight_down_z(5.0), scene.max_depth = 3;
  return trace_picture(scene).color.at(0, 0).x;
}

TEST(NestedGlass, Case30OverlapBelongsToTheHigherPriority) {
  const double glass = 1.5f, water = 1.33f, glass_absorbs = 0.2f, water_absorbs = 0.7f;
  const double boundaries = (1.0 - fresnel_normal(1.0, glass)) * (1.0 - fresnel_normal(glass, water)) *
                            (1.0 - fresnel_normal(water, 1.0));
  for (const double overlap : {1e-6, 0.1, 0.75}) {
    const double glass_wins = boundaries * std::exp(-glass_absorbs - 2.0 * water_absorbs);
    EXPECT_NEAR(stack(overlap, 1, 0), glass_wins, 1e-6) << overlap;
    const double water_wins =
        boundaries * std::exp(-(1.0 - overlap) * glass_absorbs - (2.0 + overlap) * water_absorbs);
    EXPECT_NEAR(stack(overlap, 0, 1), water_wins, 1e-6) << overlap;
    EXPECT_NEAR(stack(overlap, 0, 0), water_wins, 1e-6) << "the one entered last";
  }
}

// A marble of any glass, wholly inside another of a higher priority, over a floor.
Scene marble(int priority, bool present) {
  Scene scene = test::scene_of({}, {test::plane({0, 0, 0}, {0, 1, 0}), test::sphere({0, 1.2, 0}, 1.0, 1)});
  if (present) scene.shapes.push_back(test::sphere({0.2, 1.3, 0.1}, 0.5, 2));
  scene.materials = {Material{}, glass_of(1.5f, 1), glass_of(2.4f, priority)};
  scene.materials[1].absorption = Vec3f(0.3f), scene.materials[2].absorption = Vec3f(5.0f);
  scene.lights = {test::point_light({2, 6, 4})};
  scene.lights[0].intensity = Vec3f(40.0f);
  scene.background = {0.3f, 0.5f, 0.8f};
  scene.camera.eye = {0.25, 2.25, 6}, scene.camera.target = {0, 1.0, 0};
  return scene;
}

double worst_difference(const raytrace::RayTracedFrame& a, const raytrace::RayTracedFrame& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.color.data.size(); ++i) {
    const Vec3f d = glm::abs(a.color.data[i] - b.color.data[i]);
    worst = std::max({worst, double(d.x), double(d.y), double(d.z)});
  }
  return worst;
}

TEST(NestedGlass, Case30WhatALowerPriorityHidesIsNotThere) {
  const ImageSize size{90, 70};
  const auto without = trace_picture(marble(0, false), size);
  // What is passed moves the ray by its rounding only.
  EXPECT_LT(worst_difference(trace_picture(marble(0, true), size), without), 2e-5);
  EXPECT_GT(worst_difference(trace_picture(marble(1, true), size), without), 0.1) << "nested: it is there";
  EXPECT_GT(worst_difference(trace_picture(marble(2, true), size), without), 0.1);
}

// A box on a floor, mirrored or not: the same body, its triangles wound the other way. Seen from `eye`.
raytrace::RayTracedFrame box_of_glass(bool mirrored, const Vec3& eye) {
  Scene scene =
      test::scene_of({test::box({-1, 0.25, -0.75}, {1, 1.75, 0.75})}, {test::plane({0, 0, 0}, {0, 1, 0}, 1)});
  scene.materials = {glass_of(1.5f), Material{}};
  scene.materials[0].absorption = {0.1f, 0.3f, 0.6f};
  if (mirrored) scene.instances[0].world_from_object[0][0] = -1.0;
  scene.lights = {test::point_light({2, 6, 3})};
  scene.lights[0].intensity = Vec3f(40.0f);
  scene.background = {0.3f, 0.5f, 0.8f};
  scene.camera.eye = eye, scene.camera.target = {0.125, 0.875, 0};
  return trace_picture(scene, {80, 60});
}

TEST(MirroredGlass, IsTheSameBody) {
  for (const Vec3& eye : {Vec3(1.75, 2.25, 5), Vec3(0.375, 1.125, 0.5)})  // outside, and within the glass
    EXPECT_LT(worst_difference(box_of_glass(false, eye), box_of_glass(true, eye)), 2e-5) << eye.z;
}

TEST(NestedGlass, TheEyeInGlassIsFoundThere) {
  // From the middle of a ball of glass to its surface, and out: absorption over the radius, one boundary.
  Scene scene = test::scene_of({}, {test::sphere({0, 0, 0}, 2.0)});
  scene.materials[0] = glass_of(1.5f);
  scene.materials[0].absorption = {0.0f, 0.5f, 1.0f};
  scene.background = Vec3f(1.0f), scene.max_depth = 1;
  scene.camera = test::straight_down_z(0.0);
  scene.camera.target = {0, 0, -1};
  const auto frame = trace_picture(scene);
  const Vec3f c = frame.color.at(0, 0);
  for (const int k : {0, 1, 2})
    EXPECT_NEAR(c[k], 0.96 * std::exp(-2.0 * double(scene.materials[0].absorption[k])), 1e-6) << k;
  EXPECT_GT(frame.rays.interior, 0u);
  // A marble of lower priority around the eye changes nothing; of a higher one it takes over.
  scene.materials[0].priority = 1;
  scene.materials.push_back(glass_of(1.2f));
  scene.shapes.push_back(test::sphere({0, 0, 0}, 0.5, 1));
  EXPECT_LT(glm::length(trace_picture(scene).color.at(0, 0) - c), 1e-6f);
  scene.materials[1].priority = 2, scene.max_depth = 2;
  const double shares = (1.0 - fresnel_normal(1.2f, 1.5)) * 0.96 * std::exp(-1.5 * 0.5);
  EXPECT_NEAR(trace_picture(scene).color.at(0, 0).y, shares, 1e-6);
}

TEST(NestedGlass, ShadowRaysKnowWhatIsThere) {
  // A floor under a slab of glass in which a slab of lower priority hides.
  Scene scene = test::scene_of({test::box({-5, 1, -5}, {5, 2, 5}), test::box({-4, 1.2, -4}, {4, 1.6, 4})},
                               {test::plane({0, 0, 0}, {0, 1, 0}, 2)});
  scene.materials = {glass_of(1.5f, 1), glass_of(2.0f, 0), Material{}};
  scene.materials[0].absorption = Vec3f(0.7f), scene.materials[1].absorption = Vec3f(9.0f);
  scene.materials[2].diffuse = Vec3f(1.0f);
  scene.instances[1].material = 1;
  scene.lights = {test::sun({0, -1, 0})};
  scene.camera.eye = {0, 0.9, 0}, scene.camera.target = {0, 0, 0}, scene.camera.up = {0, 0, 1};
  EXPECT_NEAR(trace_picture(scene, {3, 3}).color.at(1, 1).x, 0.96 * 0.96 * std::exp(-0.7), 1e-6);
}

}  // namespace
}  // namespace gnomon
