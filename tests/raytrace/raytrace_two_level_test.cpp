// Instances that share a tree, against brute force in the world's space, to the last bit: every kind of
// transform, rays aimed where rounding between the two spaces could lose a hit, transforms that cannot be
// inverted; and the bound on that rounding by itself.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <atomic>

#include "raytrace/accel/any_structure.h"
#include "raytrace/frame.h"
#include "raytrace/kernels.h"
#include "scene/load.h"
#include "tests/support/placements.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using namespace raytrace;  // NOLINT(google-build-using-namespace): every second word here is from that room
using test::aimed_rays;
using test::ball;
using test::instances_of;
using test::Kind;
using test::kinds;
using test::moved;
using test::Random;
using test::same;
using test::scaling;
using test::sheared;
using test::TestWorld;
using test::turned;

struct Compared {
  std::uint64_t wrong, hits;
};

Compared compare(const World& world, const Tracer& tracer, const std::vector<Ray>& rays) {
  const Tracer brute(world, Accel::brute);
  std::atomic<std::uint64_t> wrong = 0, hits = 0;
  tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t i) {
    const auto truth = brute.closest_hit(rays[i]);
    hits += truth ? 1 : 0;
    const bool right =
        same(tracer.closest_hit(rays[i]), truth) && tracer.occluded(rays[i]) == truth.has_value();
    wrong += right ? 0 : 1;
  });
  return {wrong, hits};
}

TwoLevel structure_of(const World& world) {
  return std::get<TwoLevel>(build_structure(world, Accel::two_level));
}

void expect_agreement_with_brute_force(const Kind& kind, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::pair<std::uint32_t, Mat4>> placed;
  for (int i = 0; i < 40; ++i)
    placed.emplace_back(i % 2, moved_into_box(kind.linear(random), kind.extent, random));
  const TestWorld w(instances_of({ball(), test::triangle_soup(30, 0.8, 0.5, 5)}, placed));
  const Tracer tracer(w.world(), Accel::two_level);
  EXPECT_EQ(structure_of(tracer.world()).placements.size(), 40u);
  EXPECT_EQ(structure_of(tracer.world()).trees.size(), 2u);
  const Compared c =
      compare(w.world(), tracer, aimed_rays(w.world(), 6000, kind.extent, Vec3(0.0), seed + 1));
  EXPECT_EQ(c.wrong, 0u);
  EXPECT_GT(c.hits, 2500u);
}

// Seeds 34 and 50 have rays along edges that rounding once let hit the triangle at a place that is not its own.
TEST(TwoLevel, AgreesWithBruteForceForEveryKindOfTransform) {
  for (const std::uint64_t seed : {11u, 34u, 50u}) {
    for (const Kind& kind : kinds) {
      SCOPED_TRACE(testing::Message() << kind.name << ", seed " << seed);
      expect_agreement_with_brute_force(kind, seed);
    }
  }
}

// Where world coordinates are so coarse that the rounded mesh is not the mesh: ten millionths of a unit are
// a hundred thousand roundings wide at a million units from the origin.
TEST(TwoLevel, FarFromTheOrigin) {
  for (const double size : {1.0, 1e-3, 1e-5}) {
    const Vec3 middle(1e6, -0.7e6, 1.3e6);
    Random random(21);
    std::vector<std::pair<std::uint32_t, Mat4>> placed;
    for (int i = 0; i < 20; ++i)
      placed.emplace_back(0,
                          moved_into_box(sheared(random) * scaling(Vec3(size)), 4.0 * size, random, middle));
    const TestWorld w(instances_of({ball()}, placed));
    const Tracer tracer(w.world(), Accel::two_level);
    for (const double from : {4.0 * size, 100.0}) {
      const Compared c = compare(w.world(), tracer, aimed_rays(w.world(), 6000, from, middle, 22));
      EXPECT_EQ(c.wrong, 0u) << size << " seen from " << from;
      EXPECT_GT(c.hits, 1500u) << size << " seen from " << from;
    }
  }
}

// A mesh that lies far from its own origin and is brought back by its transform.
TEST(TwoLevel, MeshFarFromItsOwnOrigin) {
  const Vec3 away(3e6, 1e6, -2e6);
  Mesh mesh = ball();
  for (Vec3& p : mesh.positions) p = 1e-3 * p + away;
  Random random(31);
  std::vector<std::pair<std::uint32_t, Mat4>> placed;
  for (int i = 0; i < 20; ++i)
    placed.emplace_back(
        0, moved_into_box(turned(random) * scaling(Vec3(1e3)) * moved(-away, Mat4(1.0)), 3.0, random));
  const TestWorld w(instances_of({mesh}, placed));
  const Tracer tracer(w.world(), Accel::two_level);
  EXPECT_EQ(structure_of(tracer.world()).placements.size(), 20u);
  const Compared c = compare(w.world(), tracer, aimed_rays(w.world(), 8000, 3.0, Vec3(0.0), 32));
  EXPECT_EQ(c.wrong, 0u);
  EXPECT_GT(c.hits, 3000u);
}

TEST(TwoLevel, TransformsThatCannotBeInverted) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Random random(41);
  const Mat4 turn = turned(random);
  std::vector<std::pair<std::uint32_t, Mat4>> placed{
      {0, moved(Vec3(-2, 0, 0), scaling({1.0, 0.0, 1.0}))},                           // flat: visible
      {0, moved(Vec3(2, 0, 0), turn * scaling({1.0, 0.0, 1.0}) * turned(random))},    // flat, aslant
      {0, moved(Vec3(0, 2, 0), turn * scaling({1.0, 1e-15, 1.0}) * turned(random))},  // nearly so
      {0, scaling(Vec3(0.0))},                                                        // a point: nothing
      {0, moved(Vec3(nan, 0.0, 0.0), turn)},                                          // nowhere
      {0, moved(Vec3(0, 0, 2), Mat4(Mat3(Vec3(infinity, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1))))},
      {0, moved(Vec3(0, 0, -2), scaling({1e-300, 1e-300, 1e-300}))},  // too small for the arithmetic
      {0, moved(Vec3(0, -2, 0), turn)},                               // sound ones
      {0, moved(Vec3(0, -2, 2), turn)},
      {1, turn},  // without triangles
      {1, scaling(Vec3(0.0))}};
  Mesh empty;
  empty.positions = {Vec3(0.0)};
  const TestWorld w(instances_of({ball(), empty}, placed));
  const Tracer tracer(w.world(), Accel::two_level), brute(w.world(), Accel::brute);
  EXPECT_EQ(structure_of(tracer.world()).placements.size(), 2u);
  EXPECT_EQ(tracer.stats().dropped, brute.stats().dropped);
  EXPECT_GT(tracer.stats().dropped, 0u);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 from = random.in_box(5.0);
    rays.push_back({from, random.in_box(2.5) - from});
  }
  for (const Ray& ray : aimed_rays(w.world(), 6000, 3.0, Vec3(0.0), 42)) rays.push_back(ray);
  const Compared c = compare(w.world(), tracer, rays);
  EXPECT_EQ(c.wrong, 0u);
  EXPECT_GT(c.hits, 4000u);
}

// Rounding may leave a triangle without area in one place and not in another.
TEST(TwoLevel, TrianglesThatOnlySomeInstancesLose) {
  Mesh mesh = ball();
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : {Vec3(1.0, 1.0, 1.0), Vec3(1.0 + 1e-9, 1.0, 1.0), Vec3(1.0, 1.0 + 1e-9, 1.0)})
    mesh.positions.push_back(p);
  mesh.triangles.insert(mesh.triangles.begin() + 20, {first, first + 1, first + 2});
  const TestWorld w(instances_of({mesh}, {{0, Mat4(1.0)},
                                          {0, moved(Vec3(3, 0, 0), Mat4(1.0))},
                                          {0, moved(Vec3(1e9, 0, 0), Mat4(1.0))},
                                          {0, moved(Vec3(1e9, 4, 0), Mat4(1.0))}}));
  const Tracer tracer(w.world(), Accel::two_level);
  EXPECT_EQ(tracer.stats().dropped, 2u);
  EXPECT_EQ(structure_of(tracer.world()).trees.size(), 2u);
  for (const Vec3& middle : {Vec3(0.0), Vec3(1e9, 0.0, 0.0)}) {
    const Compared c = compare(w.world(), tracer, aimed_rays(w.world(), 3000, 4.0, middle, 51));
    EXPECT_EQ(c.wrong, 0u);
    EXPECT_GT(c.hits, 800u);
  }
}

TEST(TwoLevel, EqualInstancesAtOnePlaceGiveTheLowestId) {
  const TestWorld w(instances_of({ball()}, {{0, Mat4(1.0)}, {0, Mat4(1.0)}, {0, Mat4(1.0)}}));
  const Tracer tracer(w.world(), Accel::two_level);
  const Compared c = compare(w.world(), tracer, aimed_rays(w.world(), 3000, 3.0, Vec3(0.0), 61));
  EXPECT_EQ(c.wrong, 0u);
  EXPECT_GT(c.hits, 1000u);
}

// With masks, shapes and lights, at every precision: the whole picture and every shadow.
TEST(TwoLevel, PicturesAndVerdictsAreThoseOfBruteForce) {
  Random random(71);
  std::vector<std::pair<std::uint32_t, Mat4>> placed;
  for (int i = 0; i < 25; ++i)
    placed.emplace_back(0, moved_into_box(kinds[i % 4].linear(random), 4.0, random));
  Mesh mesh = ball();
  for (const Vec3& p : mesh.positions) mesh.uvs.emplace_back(Vec2f(Vec2(p.x, p.y)));
  Scene scene = instances_of({mesh}, placed);
  Material holes;
  holes.alpha_mode = AlphaMode::mask, holes.alpha = 0.2f;
  scene.materials.push_back(holes);
  scene.instances[4].material = 1;
  scene.shapes = {test::plane(Vec3(0, -4, 0), Vec3(0, 1, 0)), test::sphere(Vec3(1, 1, 1), 0.7)};
  scene.lights = {test::point_light(Vec3(2.0, 6.0, 1.0)), test::sun(Vec3(0.2, -1.0, 0.1))};
  scene.camera.eye = Vec3(0, 1, 12);
  const TestWorld w(std::move(scene));
  RaytraceOptions options;
  options.size = {80, 48};
  const std::array<std::uint32_t, 2> lights{0, 1};
  const EffectPlan plan = plan_effects(w.scene());
  for (const Precision precision : {Precision::robust, Precision::exact}) {
    const auto frame = [&](Accel accel) {
      return trace_frame(Tracer(w.world(), accel, precision), plan, w.scene().camera, lights, options);
    };
    const RayTracedFrame truth = frame(Accel::brute), other = frame(Accel::two_level);
    EXPECT_EQ(other.color.data, truth.color.data) << precision_name(precision);
    for (std::size_t l = 0; l < lights.size(); ++l)
      EXPECT_EQ(other.lights[l].centre.data, truth.lights[l].centre.data) << precision_name(precision);
  }
}

TEST(TwoLevel, BuiltInScenes) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    if (builtin.large) continue;
    const auto scene = load_scene(std::string(builtin.name));
    ASSERT_TRUE(scene) << builtin.name;
    const World world = make_world(*scene);
    const Tracer tracer(world, Accel::two_level), brute(world, Accel::brute);
    const ImageSize size{16, 12};
    const View view = make_view(scene->camera, size);
    std::vector<Ray> rays;
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        rays.push_back(pixel_ray(view, x + 0.5, y + 0.5));
        const auto hit = brute.closest_hit(rays.back());
        if (!hit) continue;
        const SurfacePoint point = brute.surface_point(rays.back(), *hit);
        for (const Light& light : scene->lights) {
          EXPECT_EQ(tracer.centre_visibility(point, light), brute.centre_visibility(point, light))
              << builtin.name;
          rays.push_back(brute.shadow_ray(point, light));
        }
      }
    EXPECT_EQ(compare(world, tracer, rays).wrong, 0u) << builtin.name;
  }
}

TEST(TwoLevel, MemoryIsThatOfOneMesh) {
  std::vector<std::pair<std::uint32_t, Mat4>> placed;
  Random random(81);
  for (int i = 0; i < 400; ++i) placed.emplace_back(0, moved_into_box(turned(random), 40.0, random));
  const Mesh ball = test::uv_sphere(Vec3(0.0), 1.0, 16, 24, 0.1, 3);
  const TestWorld w(instances_of({ball}, placed)), one(test::scene_of({ball}));
  const Tracer two(w.world(), Accel::two_level), mesh(one.world(), Accel::bvh);
  const TwoLevel structure = structure_of(w.world());
  EXPECT_EQ(structure.trees.size(), 1u);
  EXPECT_TRUE(structure.leaves.primitives.empty());
  // Four bytes a triangle for its id, and fewer than three hundred an instance.
  EXPECT_LT(two.stats().bytes,
            mesh.stats().bytes + std::uint64_t{4} * w.world().triangle_count() + 300 * placed.size());
}

TEST(TwoLevel, SameForAnyNumberOfThreads) {
  std::vector<std::pair<std::uint32_t, Mat4>> placed;
  Random random(91);
  for (int i = 0; i < 60; ++i) placed.emplace_back(i % 3, moved_into_box(sheared(random), 20.0, random));
  const TestWorld w(instances_of(
      {ball(), test::triangle_soup(9000, 2.0, 0.1, 92), test::triangle_soup(5, 1.0, 1.0, 93)}, placed));
  const auto build = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return build_two_level(w.world());
  };
  const TwoLevel one = build(1), four = build(4);
  EXPECT_EQ(one.leaves.ids, four.leaves.ids);
  EXPECT_EQ(one.nodes(), four.nodes());
  ASSERT_EQ(one.entries.size(), four.entries.size());
  for (std::size_t i = 0; i < one.entries.size(); ++i) {
    EXPECT_EQ(one.entries[i].tree, four.entries[i].tree);
    EXPECT_EQ(one.entries[i].first, four.entries[i].first);
  }
  EXPECT_EQ(one.trees.size(), 2u + 20u);  // five triangles are not worth a placement
}

// ---- the bound

using Wide = long double;  // eleven bits more than what is bounded
static_assert(std::numeric_limits<Wide>::digits >= 64);

/// How far the tree's point is from the placed ray, in multiples of what the ray's error allows; at the
/// worst parameter component by component.
double used_error(const PlacedRay& placed, const Vec3& in_tree, Wide t) {
  const Wide along = (t - static_cast<Wide>(placed.begin)) * static_cast<Wide>(placed.scale);
  Wide used = 0.0L;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto i = static_cast<int>(a);
    const Wide at =
        static_cast<Wide>(placed.frame.origin[a]) + along * static_cast<Wide>(placed.frame.direction[a]);
    used = std::max(used,
                    std::abs(at - static_cast<Wide>(in_tree[i])) / static_cast<Wide>(placed.origin_error[i]));
  }
  return static_cast<double>(used);
}

TEST(TwoLevel, ThePlacedRayPassesItsCornersWithinItsBound) {
  Random random(101);
  double most = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const double scale = std::exp(random.uniform(-20.0, 20.0)), away = std::exp(random.uniform(-20.0, 20.0));
    const Vec3 shift = random.in_box(away), corner = random.in_box(1.0) + shift;
    Aabb box;
    for (const Vec3& p : {corner, random.in_box(1.0) + shift, random.in_box(1.0) + shift}) box.grow(p);
    const MeshSpace space(box);
    const Mat4 linear = kinds[static_cast<std::size_t>(i) % 4].linear(random) * scaling(Vec3(scale));
    const Mat4 matrix = moved_into_box(linear, std::exp(random.uniform(-20.0, 20.0)), random);
    const auto placement = place(space, matrix);
    if (!placement) continue;
    // The world's corner, rounded as the world has it, and a ray to it that starts where the sum is exact.
    const Vec3 in_world(matrix * Vec4(corner, 1.0));
    const Vec3 direction = random.direction();
    const double t = std::ldexp(1.0, static_cast<int>(random.below(60)) - 30) * scale;
    Vec3 from = in_world - t * direction;
    Vec3 miss(0.0);  // by how much the ray passes the corner: what the world's test has to be right to
    for (int a = 0; a < 3; ++a)
      miss[a] = static_cast<double>(static_cast<Wide>(from[a]) +
                                    static_cast<Wide>(t) * static_cast<Wide>(direction[a]) -
                                    static_cast<Wide>(in_world[a]));
    const auto frame = make_ray_frame({from, direction});
    ASSERT_TRUE(frame);
    const BoxRay ray(*frame, Vec3(0.0), glm::abs(miss));
    const double kernel_t = t * frame->kernel_t_from_t;
    const PlacedRay placed(*placement, ray, kernel_t * random.uniform(0.0, 1.5));
    most = std::max(most, used_error(placed, space.tree_from_object(corner), static_cast<Wide>(kernel_t)));
  }
  EXPECT_LE(most, 1.0);
  EXPECT_GT(most, 0.01);  // a bound, not a guess: it is not far from what happens
}

}  // namespace
}  // namespace gnomon
