// Where the shaft to a light with size is said to be clear, each of its rays gets through, in another
// structure: random lights, lights that corners all but touch, and all but below the horizon; for every
// instruction set.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <string_view>

#include "raytrace/shading/light_samples.h"
#include "raytrace/shading/light_shaft.h"
#include "raytrace/tracer.h"
#include "tests/support/every_target.h"
#include "tests/support/placements.h"
#include "tests/support/places.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using namespace raytrace;  // NOLINT(google-build-using-namespace): every second word here is from that room
using test::for_each_target;
using test::Random;
using test::TestWorld;

constexpr int samples = 64;

Vec3 corner_of(const World& world, Random& random) {
  return world.corners(random.below(world.triangle_count()))[random.below(3)];
}

/// A light of any shape, `size` about its radius.
Light light_at(const Vec3& position, double size, Random& random) {
  Light light = test::point_light(position);
  switch (random.below(4)) {
    case 0:
      light = test::sun(random.direction());
      light.extent = SunDisc{std::exp2(random.uniform(-20.0, 0.0))};
      break;
    case 1:
      light.extent = SphereLight{size};
      break;
    case 2:
      light.extent = DiscLight{size, random.direction()};
      break;
    default: {
      const Vec3 across = random.direction();
      light.extent =
          RectangleLight{size * across, 0.5 * size * glm::normalize(glm::cross(across, random.direction()))};
    }
  }
  return light;
}

struct Pair {
  SurfacePoint from;
  Light light;
};

/// A light anywhere; one whose rim a corner touches but for a little, seen from the point; one that all but
/// touches the horizon.
Light hard_light(const World& world, const SurfacePoint& from, int kind, Random& random) {
  const double reach = world.finite_bounds.diagonal();
  const double size = reach * std::exp2(random.uniform(-12.0, 0.0));
  const Vec3 toward = random.direction(),
             away = toward + (1.001 - glm::dot(toward, from.normal)) * from.normal;
  if (kind == 0) return light_at(from.position + reach * away, size, random);
  const double sign = random.below(2) == 0 ? 1.0 : -1.0;
  const double little = sign * std::exp2(random.uniform(-40.0, -3.0));
  const Vec3 one = random.direction(), other = random.direction();
  const Vec3 across = glm::normalize(glm::cross(one, other));
  if (kind == 1) {
    const Vec3 corner = corner_of(world, random);
    const Vec3 behind = from.position + random.uniform(0.9, 4.0) * (corner - from.position);
    return light_at(behind + size * (1.0 + little) * across, size, random);
  }
  const Vec3 along = reach * glm::cross(from.normal, across);
  return light_at(from.position + along + size * (1.0 + little) * from.normal, size, random);
}

/// Points inside of triangles, on their edges and at their corners.
std::vector<Pair> pairs_in(const World& world, const Tracer& tracer, int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Pair> pairs;
  const double reach = world.finite_bounds.diagonal();
  for (int i = 0; i < count; ++i) {
    const auto [p, q, r] = world.corners(random.below(world.triangle_count()));
    const double u = random.uniform(0.0, 1.0), v = i % 5 == 0 ? 0.0 : random.uniform(0.0, 1.0 - u);
    const Vec3 target = i % 11 == 0 ? p : p + u * (q - p) + v * (r - p);
    const Vec3 origin = target + reach * random.direction();
    const Ray ray{origin, target - origin};
    const std::optional<Hit> hit = tracer.closest_hit(ray);
    if (!hit) continue;
    const SurfacePoint from = tracer.surface_point(ray, *hit);
    pairs.push_back({from, hard_light(world, from, i % 3, random)});
  }
  return pairs;
}

/// How many rays get through.
int arrivals(const Tracer& tracer, const Pair& pair, std::uint64_t key) {
  const LightSamples rays(tracer, pair.from, pair.light, samples, key);
  int count = 0;
  for (int i = 0; i < samples; ++i) {
    const std::optional<Ray> ray = rays[i];
    count += ray && !tracer.occluded(*ray) ? 1 : 0;
  }
  return count;
}

/// At least the share `useful` of the pairs whose rays all arrive must be found; of all pairs as many rays must get through.
void expect_clear(const World& world, int count, double useful, std::uint64_t seed) {
  const Tracer tracer(world, Accel::bvh), other(world, Accel::bvh_median);
  prepare_single_rays(tracer);
  const std::vector<Pair> pairs = pairs_in(world, other, count, seed);
  std::vector<int> arrive(pairs.size());
  tbb::parallel_for(std::size_t{0}, pairs.size(),
                    [&](std::size_t i) { arrive[i] = arrivals(other, pairs[i], i); });
  const auto whole = std::count(arrive.begin(), arrive.end(), samples);
  EXPECT_GE(whole, static_cast<std::ptrdiff_t>(pairs.size() / 20));
  for_each_target([&] {
    std::atomic<int> wrong = 0, found = 0, other_shares = 0;
    tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t i) {
      const bool clear = find_light_blockers(tracer, pairs[i].from, pairs[i].light, samples).none();
      wrong += clear && arrive[i] != samples ? 1 : 0;
      found += clear ? 1 : 0;
      const double share = light_visibility(tracer, pairs[i].from, pairs[i].light, samples, i).share;
      other_shares += share == static_cast<double>(arrive[i]) / samples ? 0 : 1;
    });
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(other_shares, 0);
    EXPECT_GE(found, useful * static_cast<double>(whole)) << "of " << whole;
  });
}

TEST(LightShaft, SoupOfAllSizes) {
  std::vector<Mesh> meshes;
  for (int i = 0; i < 4; ++i)
    meshes.push_back(test::triangle_soup(60, 2.0, std::exp2(-3.0 * i), static_cast<std::uint64_t>(i) + 1));
  const TestWorld w(test::scene_of(std::move(meshes)));
  expect_clear(w.world(), 20000, 0.35, 2);
}

TEST(LightShaft, ClosedMeshesAnywhere) {
  for (const Vec3& offset : {Vec3(0.0), Vec3(1e6, -1e6, 1e6), Vec3(148376.0, 1234.0, -223423.0)}) {
    const TestWorld w(test::scene_of({test::uv_sphere(offset, 1.0, 24, 32, 0.1, 3),
                                      test::quad(offset + Vec3(-3, -1.2, -3), {0, 0, 6}, {6, 0, 0})}));
    expect_clear(w.world(), 6000, 0.5, 4);
  }
}

TEST(LightShaft, TinyAndHugeWorlds) {
  for (const double scale : {1e-6, 1e-3, 1e6, 1e8}) {
    const TestWorld w(test::scene_of({test::moved(test::triangle_soup(100, 2.0, 0.3, 5), scale, Vec3(0.0))}));
    expect_clear(w.world(), 4000, 0.4, 6);
  }
}

TEST(LightShaft, Needles) {
  Random random(7);
  Mesh needles = test::triangle_soup(200, 2.0, 1.0, 8);
  for (std::size_t i = 2; i < needles.positions.size(); i += 3)
    needles.positions[i] = needles.positions[i - 1] + random.in_box(std::exp2(random.uniform(-50.0, -5.0)));
  const TestWorld w(test::scene_of({needles, test::triangle_soup(60, 2.0, 0.5, 17)}));
  expect_clear(w.world(), 6000, 0.03, 9);
}

TEST(LightShaft, FlatFloorOfManyTriangles) {
  Mesh floor;
  constexpr std::uint32_t side = 24;
  for (std::uint32_t y = 0; y <= side; ++y)
    for (std::uint32_t x = 0; x <= side; ++x)
      floor.positions.emplace_back(0.1 * x, 0.3 * y - 0.7 * x, 0.1 * y);
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t a = y * (side + 1) + x, b = a + side + 1;
      floor.triangles.push_back({a, b, a + 1});
      floor.triangles.push_back({a + 1, b, b + 1});
    }
  const TestWorld w(test::scene_of({floor, test::box({1, 1, 1}, {1.2, 1.3, 1.1})}));
  expect_clear(w.world(), 6000, 0.45, 10);
}

TEST(LightShaft, ShapesAndPlanes) {
  Scene scene =
      test::scene_of({test::triangle_soup(30, 2.0, 0.5, 11)}, {test::plane({0, -1.5, 0}, {0, 1, 0})});
  scene.shapes.push_back(test::sphere({0.5, 0.2, 0.1}, 0.6));
  Torus ring;
  ring.frame.origin = {-0.5, 0.4, 0.3}, ring.major = 0.5, ring.minor = 0.1;
  scene.shapes.push_back({"ring", ring, 0});
  const TestWorld w(scene);
  expect_clear(w.world(), 6000, 0.4, 12);
}

// From outside, the point's own sphere lies below the horizon; from within, its far side is in the way.
TEST(LightShaft, ThePointsOwnSphereFromBothSides) {
  const Mesh aside = test::moved(test::triangle_soup(30, 0.5, 0.2, 21), 1.0, {6, 0, 0});
  const TestWorld w(test::scene_of({aside}, {test::sphere(Vec3(0.0), 10.0)}));
  const Tracer tracer(w.world(), Accel::bvh), other(w.world(), Accel::bvh_median);
  prepare_single_rays(tracer);
  Random random(22);
  int outside = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 up = random.direction();
    Light light = i % 2 == 0 ? test::sun(-up) : test::point_light(30.0 * up);
    if (i % 2 == 0)
      light.extent = SunDisc{0.05};
    else
      light.extent = SphereLight{0.5};
    const SurfacePoint above = test::seen(other, 12.0 * up, Vec3(0.0));
    const SurfacePoint within = test::seen(other, -9.0 * up, -12.0 * up);
    ASSERT_EQ(above.primitive, w.world().triangle_count());
    ASSERT_EQ(within.primitive, w.world().triangle_count());
    outside += find_light_blockers(tracer, above, light, samples).none() ? 1 : 0;
    ASSERT_FALSE(find_light_blockers(tracer, within, light, samples).none());
    ASSERT_EQ(light_visibility(tracer, within, light, samples, 23).share, 0.0);
  }
  EXPECT_EQ(outside, 300);
}

TEST(LightShaft, SharesAreThoseOfAllRays) {
  const TestWorld w(test::scene_of({test::triangle_soup(60, 2.0, 0.4, 13)}));
  const Tracer tracer(w.world(), Accel::bvh), other(w.world(), Accel::bvh_median);
  prepare_single_rays(tracer);
  for (const Pair& pair : pairs_in(w.world(), other, 500, 14)) {
    const SampledVisibility with = light_visibility(tracer, pair.from, pair.light, samples, 15);
    const SampledVisibility without = light_visibility(other, pair.from, pair.light, samples, 15);
    EXPECT_EQ(with.share, without.share);
    const bool clear = find_light_blockers(tracer, pair.from, pair.light, samples).none();
    EXPECT_EQ(with.rays, clear ? std::uint64_t{0} : without.rays);
    EXPECT_TRUE(!clear || without.rays == std::uint64_t{samples});
  }
}

// Instances' meshes are looked at in their own space, the truth is found in the world's. What is a millionth as thick as it is
// wide is left to rays: there rounding is as large as what floats have to spare.
TEST(LightShaft, KeptInstances) {
  for (const test::Kind& kind : test::kinds) {
    SCOPED_TRACE(kind.name);
    Random random(18);
    std::vector<std::pair<std::uint32_t, Mat4>> placed;
    for (int i = 0; i < 40; ++i)
      placed.emplace_back(i % 2, test::moved_into_box(kind.linear(random), kind.extent, random));
    const Scene scene = test::instances_of({test::ball(), test::triangle_soup(30, 0.8, 0.5, 5)}, placed);
    const bool is_paper = std::string_view(kind.name) == "thin as paper";
    expect_clear(make_world(scene, InstanceChoice::keep), 4000, is_paper ? 0.0 : 0.35, 19);
  }
}

TEST(LightShaft, Bunny) {
  const std::optional<Mesh> bunny =
      test::read_obj(gnomon::test::shared_data() + "/common_organic/stanford-bunny.obj");
  if (!bunny) GTEST_SKIP() << "no bunny beside the sources";
  const TestWorld w(test::scene_of({*bunny}));
  expect_clear(w.world(), 20000, 0.5, 16);
}

}  // namespace
}  // namespace gnomon
