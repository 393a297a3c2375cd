// Spheres and planes, and the ray-offset policy: rays that leave a surface do not meet it again.
#include <gtest/gtest.h>

#include "raytrace/shapes/intersect.h"
#include "tests/support/raytrace_support.h"
#include "verify/quad.h"

namespace gnomon {
namespace {

using raytrace::Accel;
using raytrace::Hit;
using raytrace::SurfacePoint;
using raytrace::Tracer;
using test::Random;
using test::TestWorld;

TEST(Shapes, Case5SphereIsRightAtEveryDistance) {
  Random random(21);
  for (double distance = 10.0; distance < 2e7; distance *= 10.0) {
    const TestWorld w(test::scene_of({}, {test::sphere({0, 0, 0}, 1.0)}));
    const Tracer tracer(w.world(), Accel::bvh);
    int wrong = 0, vouched = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vec3 origin = distance * random.direction();
      const Ray ray{origin, test::some_direction(random, {0.9, 1.1}) - origin};
      const test::OracleHit truth = test::oracle_closest(w.world(), ray);
      const std::optional<Hit> hit = tracer.closest_hit(ray);
      // What a rounding of the ray's own numbers could turn is no error: an impact parameter within 1e-14
      // distances of 1.
      const Vec3 d = glm::normalize(ray.direction);
      if (std::abs(glm::length(glm::cross(origin, d)) - 1.0) < 1e-14 * distance) continue;
      ++vouched;
      wrong += hit.has_value() != (truth.primitive != no_id) ? 1 : 0;
      // Grazing hits magnify rounding by the root of the distance to the silhouette.
      if (hit)
        wrong += std::abs(hit->t * glm::length(ray.direction) - truth.t * glm::length(ray.direction)) >
                         1e-7 * distance
                     ? 1
                     : 0;
    }
    EXPECT_EQ(wrong, 0) << distance;
    EXPECT_GT(vouched, 2900) << distance;
  }
}

TEST(Shapes, Case6TangentIsAmbiguousOnlyWithinTheBound) {
  const TestWorld w(test::scene_of({}, {test::sphere({0, 0, 0}, 1.0)}));
  const Tracer tracer(w.world(), Accel::bvh);
  for (int ulps = -64; ulps <= 64; ++ulps) {
    const double b = 1.0 + ulps * DBL_EPSILON;
    const bool hit = tracer.occluded({{-5.0, b, 0.0}, {1, 0, 0}});
    EXPECT_EQ(hit, ulps <= 0) << ulps;  // the squares of 1 - n ulp round to at most 1
  }
}

TEST(Shapes, Case7OriginInsideOrOnTheSphere) {
  const TestWorld w(test::scene_of({}, {test::sphere({0.1, -0.2, 0.3}, 1.25)}));
  const Tracer tracer(w.world(), Accel::bvh);
  Random random(22);
  for (int i = 0; i < 5000; ++i) {
    const double depth =
        i % 2 == 0 ? random.uniform(0.0, 1.2) : 1.25 * (1.0 - std::pow(10.0, random.uniform(-12.0, -1.0)));
    const Vec3 origin = Vec3(0.1, -0.2, 0.3) + depth * random.direction();
    const Ray ray{origin, random.direction()};
    const test::OracleHit truth = test::oracle_closest(w.world(), ray);
    const std::optional<Hit> hit = tracer.closest_hit(ray);
    ASSERT_TRUE(hit);  // from inside every ray leaves
    ASSERT_NEAR(hit->t, truth.t, 4e-15 * (1.0 + 1.0 / std::max(truth.t, 1e-3))) << depth;
  }
}

TEST(Shapes, Case9PlaneIsFiniteOrMissed) {
  const TestWorld w(test::scene_of({}, {test::plane({0, 0, 0}, {0, 1, 0})}));
  const Tracer tracer(w.world(), Accel::bvh);
  for (const double slope : {1e-300, -1e-300, 0.0, -0.0, 1e-320, -1e-320})
    for (const double height : {1.0, -1.0, 0.0, 1e300}) {
      const std::optional<Hit> hit = tracer.closest_hit({{0.0, height, 0.0}, {1.0, slope, 0.0}});
      EXPECT_TRUE(!hit || std::isfinite(hit->t));
      EXPECT_FALSE(hit && height * slope > 0.0);
    }
  EXPECT_TRUE(tracer.occluded({{0.0, 1.0, 0.0}, {1.0, -1e-300, 0.0}}));
}

TEST(Shapes, Case20NestedSpheresAreBothHit) {
  const TestWorld w(test::scene_of({}, {test::sphere({0, 0, 0}, 1.0), test::sphere({0, 0, 0}, 1.0 + 4e-5)}));
  const Tracer tracer(w.world(), Accel::bvh);
  Random random(23);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 origin = 3.0 * random.direction();
    const Ray ray{origin, glm::normalize(0.9 * random.direction() - origin)};
    const std::optional<Hit> outer = tracer.closest_hit(ray);
    ASSERT_TRUE(outer);
    ASSERT_EQ(outer->primitive, 1U);
    const std::optional<Hit> inner =
        tracer.closest_hit(tracer.spawn_ray(tracer.surface_point(ray, *outer), ray.direction));
    ASSERT_TRUE(inner);
    ASSERT_EQ(inner->primitive, 0U);
  }
}

struct SelfHits {
  int tried = 0, hits = 0;
  double worst_gap =
      0.0;  // of the spawned origin over the surface, in units of the body's and place's rounding
};

/// Rays onto a convex body from outside, then rays that leave from where they hit.
SelfHits self_hits(const Scene& scene, const Vec3& center, double radius, std::uint64_t seed) {
  const TestWorld w(scene);
  const Tracer tracer(w.world(), Accel::bvh);
  Random random(seed);
  SelfHits result;
  const double place = std::abs(center.x) + std::abs(center.y) + std::abs(center.z) + radius;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 from = random.direction();
    const Ray ray{center + 3.0 * radius * from, -from + 0.2 * random.direction()};
    const std::optional<Hit> hit = tracer.closest_hit(ray);
    if (!hit) continue;
    const SurfacePoint point = tracer.surface_point(ray, *hit);
    Vec3 out = random.direction();
    if (i % 2 == 0) out -= 0.9999 * glm::dot(out, point.normal) * point.normal;  // grazing
    if (glm::dot(out, point.normal) < 0.0) out = -out;
    const Ray leaving = tracer.spawn_ray(point, out);
    ++result.tried;
    result.hits += tracer.occluded(leaving) ? 1 : 0;
    result.worst_gap =
        std::max(result.worst_gap, glm::length(leaving.origin - point.position) / (place * DBL_EPSILON));
  }
  return result;
}

TEST(Shapes, Case19ConvexBodiesDoNotMeetThemselves) {
  for (const double radius : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    for (const double place : {0.0, 1.0, 1e3, 1e7}) {
      const Vec3 center = place * Vec3(0.6, -0.64, 0.48);
      const SelfHits ball = self_hits(test::scene_of({}, {test::sphere(center, radius)}), center, radius, 24);
      EXPECT_GT(ball.tried, 1500) << radius << " at " << place;
      EXPECT_EQ(ball.hits, 0) << "sphere " << radius << " at " << place;
      EXPECT_LT(ball.worst_gap, 64.0);
      if (radius < 1e-3 * place * 1e-3)
        continue;  // a mesh so small so far away is no longer convex after rounding
      const SelfHits mesh =
          self_hits(test::scene_of({test::uv_sphere(center, radius, 24, 32, 0.0, 25)}), center, radius, 26);
      EXPECT_GT(mesh.tried, 1500);
      EXPECT_EQ(mesh.hits, 0) << "mesh " << radius << " at " << place;
      EXPECT_LT(mesh.worst_gap, 64.0);
      const SelfHits cube =
          self_hits(test::scene_of({test::box(center - Vec3(radius), center + Vec3(radius))}), center,
                    1.7 * radius, 27);
      EXPECT_EQ(cube.hits, 0) << "box " << radius << " at " << place;
    }
  }
}

TEST(Shapes, EdgeFunctionSignsAreExact) {
  // a b - c d of numbers one unit in the last place apart: the rounded products are equal, the exact ones are
  // not.
  const double a = 1.0 + DBL_EPSILON, b = 1.0 - DBL_EPSILON;
  EXPECT_LT(raytrace::signed_difference(a, b, 1.0, 1.0), 0.0);  // 1 - eps^2 - 1
  EXPECT_GT(raytrace::signed_difference(1.0, 1.0, a, b), 0.0);
  EXPECT_EQ(raytrace::signed_difference(3.0, 5.0, 15.0, 1.0), 0.0);
  Random random(28);
  for (int i = 0; i < 100000; ++i) {
    const double p = random.uniform(1.0, 2.0), q = random.uniform(1.0, 2.0);
    const double r = random.nudged(Vec3(p), 2).x, s = random.nudged(Vec3(q), 2).x;
    using verify::Quad;  // holds the exact products
    const Quad exact = static_cast<Quad>(p) * q - static_cast<Quad>(r) * s;
    const double got = raytrace::signed_difference(p, q, r, s);
    ASSERT_EQ(got > 0.0, exact > 0);
    ASSERT_EQ(got < 0.0, exact < 0);
  }
}

}  // namespace
}  // namespace gnomon
