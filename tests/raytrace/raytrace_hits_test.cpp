// Hits: every structure against brute force, brute force against an independent predicate in 128 bits, and
// the hard cases of ray against triangle and box. Numbers in names refer to the list of hard cases.
#include <gtest/gtest.h>

#include <limits>

#include "raytrace/bvh/traverse.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using raytrace::Accel;
using raytrace::Hit;
using raytrace::Tracer;
using test::Random;
using test::same;
using test::TestWorld;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Scene mixed_scene() {
  std::vector<Mesh> meshes{test::triangle_soup(300, 4.0, 1.0, 1)};
  std::vector<Shape> shapes;
  Random random(2);
  for (int i = 0; i < 20; ++i) shapes.push_back(test::some_sphere(random, 4.0, {0.05, 0.8}));
  return test::scene_of(std::move(meshes), std::move(shapes));
}

TEST(Hits, AgreeWithAnIndependentPredicateAndBruteForce) {
  const TestWorld w(mixed_scene());
  const Tracer bvh(w.world(), Accel::bvh), brute(w.world(), Accel::brute);
  Random random(3);
  int vouched = 0, hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Ray ray{random.in_box(4.0), test::some_direction(random, {0.1, 10.0})};
    const std::optional<Hit> hit = bvh.closest_hit(ray);
    ASSERT_TRUE(same(hit, brute.closest_hit(ray))) << i;
    ASSERT_EQ(hit.has_value(), bvh.occluded(ray)) << i;
    ASSERT_EQ(hit.has_value(), brute.occluded(ray)) << i;
    const test::OracleHit truth = test::oracle_closest(w.world(), ray);
    if (truth.doubtful) continue;
    ++vouched;
    ASSERT_EQ(hit ? hit->primitive : no_id, truth.primitive) << i;
    if (!hit) continue;
    ++hits;
    // Triangles of the soup may be thin: 1e-9 is 1e-16 over the least sine of an angle that the margin lets
    // through.
    ASSERT_NEAR(hit->t, truth.t, 1e-9 * (1.0 + truth.t)) << i;
  }
  EXPECT_GT(vouched, 2950);
  EXPECT_GT(hits, 800);
}

TEST(Hits, AdversarialRaysSeeTheSameInEveryStructure) {
  const TestWorld w(mixed_scene());
  const World& world = w.world();
  const Tracer bvh(world, Accel::bvh), brute(world, Accel::brute);
  Random random(4);
  const std::array<Vec3, 6> axes{Vec3(1, 0, 0),  Vec3(-1, 0, -0.0), Vec3(-0.0, 1, 0),
                                 Vec3(0, -1, 0), Vec3(0, -0.0, 1),  Vec3(0, 0, -1)};
  for (int i = 0; i < 60000; ++i) {
    const auto [a, b, c] = world.corners(random.below(world.triangle_count()));
    Vec3 aim = a;
    if (i % 4 == 1) aim = a + random.uniform(0.0, 1.0) * (b - a);
    if (i % 4 == 2) aim = (a + b + c) / 3.0;
    aim = random.nudged(aim, 4);
    // From far away the slabs' arithmetic in float is at its worst.
    const double scale = random.power_of_ten(0.0, 4.0);
    Ray ray{scale * random.in_box(6.0), {}};
    ray.direction = aim - ray.origin;
    if (i % 4 == 3) {  // along an axis, through a corner
      ray.direction = axes[random.below(6)];
      ray.origin = aim - 8.0 * ray.direction;
    }
    ASSERT_TRUE(same(bvh.closest_hit(ray), brute.closest_hit(ray))) << i;
    ASSERT_EQ(bvh.occluded(ray), brute.occluded(ray)) << i;
  }
}

/// Rays from inside a closed mesh at its corners, edges and faces: each must hit. Returns the leaks.
int leaks(const Tracer& tracer, const Vec3& center, int rays, Random& random) {
  const World& world = tracer.world();
  int missed = 0;
  for (int i = 0; i < rays; ++i) {
    const auto corners = world.corners(random.below(world.triangle_count()));
    const double s = i % 3 == 0 ? 0.0 : random.uniform(0.0, 1.0);
    Vec3 aim = corners[0] + s * (corners[1] - corners[0]);
    if (i % 30 == 2) aim = (corners[0] + corners[1] + corners[2]) / 3.0;
    const Vec3 origin = center + random.in_box(0.3);
    missed += tracer.closest_hit({origin, random.nudged(aim, 2) - origin}) ? 0 : 1;
  }
  return missed;
}

TEST(Hits, Case1ClosedMeshIsWatertight) {
  Random random(5);
  for (const Vec3& center : {Vec3(0.0), Vec3(3e3), Vec3(148376.0, 1234.0, -223423.0)}) {
    const TestWorld w(test::scene_of({test::uv_sphere(center, 1.0, 16, 16, 0.05, 6)}));
    EXPECT_EQ(leaks(Tracer(w.world(), Accel::bvh), center, 334000, random), 0) << center.x;
  }
}

TEST(Hits, Case2SliverHitLiesInsideTheTriangle) {
  Mesh mesh;
  mesh.positions = {{0.0, 0.0, 0.0}, {1e6, 0.0, 0.0}, {5e5, 1.0, 0.0}};
  mesh.triangles = {{0, 1, 2}};
  const TestWorld w(test::scene_of({mesh}));
  const Tracer tracer(w.world(), Accel::bvh);
  Random random(7);
  const double tilt = 0.5 * pi / 180.0;
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 target{random.uniform(0.0, 1e6), random.uniform(0.0, 0.2), 0.0};
    const double turn = random.uniform(0.0, 2.0 * pi);
    const Vec3 d(std::cos(tilt) * std::cos(turn), std::cos(tilt) * std::sin(turn), -std::sin(tilt));
    const Ray ray{target - 1e3 * d, d};
    const std::optional<Hit> hit = tracer.closest_hit(ray);
    if (!hit) continue;
    ++hits;
    double low = infinity, high = -infinity;
    for (const Vec3& corner : mesh.positions) {
      low = std::min(low, glm::dot(corner - ray.origin, d)),
      high = std::max(high, glm::dot(corner - ray.origin, d));
    }
    ASSERT_GE(hit->t, low);
    ASSERT_LE(hit->t, high);
    // The weights of a triangle 1e6 long, 1 wide and seen at 0.5 degrees carry 1e-16 * 1e6 / sin; times its
    // length.
    ASSERT_NEAR(hit->t, 1e3, 1e-2);
  }
  EXPECT_GT(hits, 5000);
}

TEST(Hits, Case3DegenerateTrianglesAreNeverHit) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {1, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 0, 3}, {3, 3, 3}};
  const TestWorld w(test::scene_of({mesh}));
  for (const Accel accel : {Accel::bvh, Accel::brute}) {
    const Tracer tracer(w.world(), accel);
    EXPECT_EQ(tracer.stats().dropped, 3U);
    Random random(8);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 origin = random.in_box(3.0);
      EXPECT_FALSE(tracer.closest_hit({origin, Vec3(random.uniform(0.0, 2.0)) - origin}));
    }
  }
}

TEST(Hits, Case8DirectionLengthDoesNotMatter) {
  const TestWorld w(mixed_scene());
  const Tracer tracer(w.world(), Accel::bvh);
  Random random(9);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 origin = random.in_box(6.0), d = random.direction();
    const std::optional<Hit> plain = tracer.closest_hit({origin, d});
    for (const int k : {-70, -500, 66, 900}) {
      const std::optional<Hit> scaled = tracer.closest_hit({origin, d * std::ldexp(1.0, k)});
      ASSERT_EQ(plain.has_value(), scaled.has_value());
      ASSERT_TRUE(!plain || plain->t == std::ldexp(scaled->t, k));  // powers of two: exact
    }
  }
  EXPECT_FALSE(tracer.closest_hit({Vec3(0.0), Vec3(0.0)}));
}

TEST(Hits, Case10And11BoxesKeepTheirTriangles) {
  // An axis-parallel grid of unit quads: boxes are flat, rays run along their faces and through their
  // corners.
  std::vector<Mesh> meshes;
  for (int x = 0; x < 6; ++x)
    for (int z = 0; z < 6; ++z) meshes.push_back(test::quad({x, 0, z}, {1, 0, 0}, {0, 0, 1}));
  const TestWorld w(test::scene_of(std::move(meshes)));
  const Tracer bvh(w.world(), Accel::bvh), brute(w.world(), Accel::brute);
  int missed = 0, differ = 0;
  for (int x = 0; x <= 12; ++x)
    for (int z = 0; z <= 12; ++z)
      for (const double zero : {0.0, -0.0})
        for (const double height : {1.0, -1.0}) {
          const Ray ray{{0.5 * x, height, 0.5 * z}, {zero, -height, zero}};
          const std::optional<Hit> hit = bvh.closest_hit(ray);
          missed += hit ? 0 : 1;
          differ += same(hit, brute.closest_hit(ray)) ? 0 : 1;
        }
  EXPECT_EQ(missed, 0);
  EXPECT_EQ(differ, 0);
}

TEST(Hits, Case11RayAtThePointOfAPointBoxMeetsIt) {
  // The hardest box of all: no extent, not even the rounding that real boxes get. The ray's own rounding
  // moves it by less than the slab test gives way.
  Random random(14);
  raytrace::BvhNode node{};
  int missed = 0;
  for (int i = 0; i < 200000; ++i) {
    const Vec3 point = Vec3(Vec3f(random.in_box(1.0)));
    for (std::size_t a = 0; a < 6; ++a)
      for (float& bound : node.bounds[a]) bound = static_cast<float>(point[static_cast<int>(a % 3)]);
    const double away = random.power_of_ten(-3.0, 0.5);
    const Vec3 origin = point + away * random.direction();
    const auto frame = raytrace::make_ray_frame({origin, point - origin});
    alignas(16) std::array<float, 4> t_near;
    const raytrace::BoxRay ray(*frame, Vec3(0.0));
    missed += raytrace::intersect_boxes(node, ray, ray.t_max, t_near.data()) == 15 ? 0 : 1;
  }
  EXPECT_EQ(missed, 0);
}

TEST(Hits, Case12RaysThatAreNoRaysCostNothing) {
  const TestWorld w(mixed_scene());
  const Tracer tracer(w.world(), Accel::bvh);
  const std::vector<Ray> bad{{{nan, 0, 0}, {1, 0, 0}},
                             {{0, 0, 0}, {nan, 0, 0}},
                             {{infinity, 0, 0}, {1, 0, 0}},
                             {{0, 0, 0}, {infinity, 1, 0}},
                             {{0, 0, 0}, {1, 0, 0}, {nan, infinity}},
                             {{0, 0, 0}, {1, 0, 0}, {2.0, 1.0}}};
  for (const Ray& ray : bad) {
    raytrace::WorkCounts work;
    EXPECT_FALSE(tracer.closest_hit(ray, work));
    EXPECT_FALSE(tracer.occluded(ray, work));
    EXPECT_EQ(work.boxes + work.primitives, 0U);
  }
  raytrace::WorkCounts work;
  const Ray good{{-9.0, 0.1, 0.2}, {1, 0, 0}};
  EXPECT_EQ(same(tracer.closest_hit(good, work), tracer.closest_hit(good)), true);
  EXPECT_GT(work.boxes, 0U);
}

TEST(Hits, Case13EqualCentroidsAndDuplicates) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles.assign(100000, {0, 1, 2});
  const TestWorld w(test::scene_of({mesh}));
  const Tracer tracer(w.world(), Accel::bvh);
  const std::optional<Hit> hit = tracer.closest_hit({{0.2, 0.2, 1.0}, {0, 0, -1}});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->primitive, 0U);
  EXPECT_FALSE(tracer.closest_hit({{0.8, 0.8, 1.0}, {0, 0, -1}}));
}

TEST(Hits, Case13GrowingTrianglesStayWithinTheDepthLimit) {
  Mesh mesh;  // each twice as large and as far as the one before: a split peels off few at a time
  double size = 1e-30;
  for (std::uint32_t i = 0; i < 190; ++i, size *= 2.0) {
    mesh.positions.insert(mesh.positions.end(), {{size, 0, 0}, {size, size, 0}, {size, 0, size}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const TestWorld w(test::scene_of({mesh}));
  const Tracer bvh(w.world(), Accel::bvh), brute(w.world(), Accel::brute);
  Random random(10);
  for (int i = 0; i < 2000; ++i) {
    const Ray ray{Vec3(-1.0, 0.0, 0.0), Vec3{1.0, random.uniform(0.0, 0.7), random.uniform(0.0, 0.7)}};
    ASSERT_TRUE(same(bvh.closest_hit(ray), brute.closest_hit(ray)));
  }
}

TEST(Hits, Case14FewPrimitives) {
  for (int count = 0; count <= 2; ++count) {
    const TestWorld w(test::scene_of({test::triangle_soup(count, 1.0, 1.0, 11)}));
    const Tracer bvh(w.world(), Accel::bvh), brute(w.world(), Accel::brute);
    Random random(12);
    for (int i = 0; i < 500; ++i) {
      const Ray ray{random.in_box(3.0), random.direction()};
      ASSERT_TRUE(same(bvh.closest_hit(ray), brute.closest_hit(ray)));
    }
  }
}

TEST(Hits, Case15BadVerticesLeaveTheOthersAlone) {
  Mesh mesh = test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.positions.insert(mesh.positions.end(),
                        {{nan, 0, 0}, {infinity, 1, 0}, {1e30, -1e30, 1e30}, {-1e30, 1e30, 5.0}});
  mesh.triangles.insert(mesh.triangles.end(), {{0, 1, 4}, {0, 1, 5}, {0, 6, 7}});
  const TestWorld w(test::scene_of({mesh}));
  for (const Accel accel : {Accel::bvh, Accel::brute}) {
    const Tracer tracer(w.world(), accel);
    EXPECT_EQ(tracer.stats().dropped, 2U);
    const std::optional<Hit> hit = tracer.closest_hit({{0.75, 0.5, 1.0}, {0, 0, -1}});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->primitive, 0U);
    EXPECT_DOUBLE_EQ(hit->t, 1.0);
  }
}

TEST(Hits, Case24IntervalIsOpenAtBothEnds) {
  const TestWorld w(test::scene_of({test::quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0})},
                                   {test::plane({0, 0, -4}, {0, 0, 1}), test::sphere({0, 0, -2}, 0.5)}));
  const Tracer tracer(w.world(), Accel::bvh);
  const auto occluded = [&](double min, double max) {
    return tracer.occluded({{0.25, 0.125, 1.0}, {0, 0, -1}, {min, max}});
  };
  EXPECT_FALSE(occluded(0.0, 1.0));
  EXPECT_TRUE(occluded(0.0, std::nextafter(1.0, 2.0)));
  EXPECT_FALSE(occluded(0.0, std::nextafter(1.0, 0.0)));
  EXPECT_TRUE(occluded(std::nextafter(1.0, 0.0), 1.5));
  EXPECT_FALSE(occluded(1.0, 1.5));
  EXPECT_FALSE(occluded(4.0, 5.0));  // the plane at its far end
  EXPECT_TRUE(occluded(4.0, std::nextafter(5.0, 6.0)));
}

// An eye that is level with a floor; the rounded t of half of its rays is above 0.
TEST(Hits, Case24OriginInATrianglesPlaneIsNoHit) {
  const TestWorld w(test::scene_of({test::quad({-4, 0, -4}, {8, 0, 0}, {0, 0, 8})}));
  for (const Accel accel : {Accel::bvh, Accel::brute}) {
    const Tracer tracer(w.world(), accel);
    Random random(24);
    for (int i = 0; i < 2000; ++i) {
      const Ray ray{{random.uniform(-4.0, 4.0), 0.0, random.uniform(-4.0, 4.0)}, random.direction()};
      ASSERT_FALSE(tracer.closest_hit(ray)) << i;
      ASSERT_FALSE(tracer.occluded(ray)) << i;
    }
  }
}

TEST(Hits, Case26TiesGoToTheLowestId) {
  std::vector<Mesh> meshes;
  for (int i = 0; i < 5; ++i) meshes.push_back(test::quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}));
  const TestWorld w(test::scene_of(std::move(meshes), {test::plane({0, 0, 0}, {0, 0, 1})}));
  for (const Accel accel : {Accel::bvh, Accel::brute}) {
    const std::optional<Hit> hit = Tracer(w.world(), accel).closest_hit({{0.5, 0.25, 1.0}, {0, 0, -1}});
    ASSERT_TRUE(hit);
    EXPECT_LT(hit->primitive, 2U);
  }
}

// Two surfaces nearer to each other than doubles tell, and before both a hole that is looked at between them.
TEST(Hits, ExactOrderIsNotForgottenAtAHole) {
  const auto triangle = [](const Vec3& first, double rest) {
    Mesh mesh;
    mesh.positions = {first, {1, -1, rest}, {0, 1, rest}};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
  };
  constexpr double little = 0x1p-52;  // on the axis a quarter of it is left, and an eighth
  Scene scene = test::scene_of({triangle({-1, -1, 1.0 + little}, 1.0), triangle({-1, -1, 0.5}, 0.5),
                                triangle({-3, -1, 1.0 + little}, 1.0)});
  scene.materials.resize(2);
  scene.materials[1].alpha_mode = AlphaMode::mask, scene.materials[1].alpha = 0.0f;
  scene.instances[1].material = 1;
  const TestWorld w(scene);
  for (const raytrace::Accel accel : {raytrace::Accel::brute, raytrace::Accel::bvh}) {
    const raytrace::Tracer tracer(w.world(), accel, raytrace::Precision::exact);
    const auto hit = tracer.closest_hit({{0, 0, 0}, {0, 0, 1}});
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->primitive, 2U);
    EXPECT_EQ(hit->t, 1.0);
  }
}

TEST(Hits, RaysMayReachBackToMinusInfinity) {
  const TestWorld w(test::scene_of(
      {test::quad({-1, -1, 5}, {2, 0, 0}, {0, 2, 0}), test::quad({-1, -1, -5}, {2, 0, 0}, {0, 2, 0})}));
  const std::optional<Hit> hit =
      Tracer(w.world(), Accel::bvh).closest_hit({{0.5, 0.25, 0.0}, {0, 0, -1}, {-infinity, infinity}});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->t, -5.0);
}

TEST(Hits, ScalingByPowersOfTwoScalesTheHit) {
  Scene scene = mixed_scene(), doubled = scene;
  constexpr double k = 0x1p20;
  for (Vec3& p : doubled.meshes[0].positions) p *= k;
  for (Shape& s : doubled.shapes) {
    auto& sphere = std::get<Sphere>(s.geometry);
    sphere = {sphere.center * k, sphere.radius * k};
  }
  const TestWorld w(scene), w2(doubled);
  const Tracer tracer(w.world(), Accel::bvh), tracer2(w2.world(), Accel::bvh);
  Random random(13);
  for (int i = 0; i < 5000; ++i) {
    const Ray ray{random.in_box(6.0), random.direction()};
    const std::optional<Hit> a = tracer.closest_hit(ray),
                             b = tracer2.closest_hit({ray.origin * k, ray.direction});
    ASSERT_EQ(a.has_value(), b.has_value());
    if (a) {
      ASSERT_EQ(a->t * k, b->t);
      ASSERT_EQ(a->primitive, b->primitive);
    }
  }
}

}  // namespace
}  // namespace gnomon
