// The wide tree of single rays against brute force in double, to the last bit, for every instruction set that
// this machine has: rays that a filter of floats or a box may lose, scenes that strain its bounds, visibility
// of ambiguous points. And that nobody pays for it who casts no such rays.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>

#include "raytrace/bvh/wide_traverse.h"
#include "raytrace/kernels.h"
#include "raytrace/packets/edge_setup.h"
#include "raytrace/tracer.h"
#include "scene/light.h"
#include "tests/support/every_target.h"
#include "tests/support/places.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using namespace raytrace;  // NOLINT(google-build-using-namespace): every second word here is from that room
using test::for_each_target;
using test::Random;
using test::same;
using test::TestWorld;

/// Rays on which the wide walk and brute force differ, over all instruction sets; at least `least` must hit.
void expect_same(const World& world, const std::vector<Ray>& rays, std::size_t least,
                 Precision precision = Precision::robust) {
  const Tracer tracer(world, Accel::bvh, precision), brute(world, Accel::brute, precision);
  prepare_single_rays(tracer);
  std::vector<std::optional<Hit>> truth(rays.size());
  tbb::parallel_for(std::size_t{0}, rays.size(),
                    [&](std::size_t i) { truth[i] = brute.closest_hit(rays[i]); });
  const auto hits =
      std::count_if(truth.begin(), truth.end(), [](const auto& hit) { return hit.has_value(); });
  EXPECT_GE(static_cast<std::size_t>(hits), least);
  for_each_target([&] {
    std::atomic<std::size_t> wrong = 0, dark = 0, uncounted = 0;
    tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t i) {
      wrong += same(tracer.closest_hit(rays[i]), truth[i]) ? 0 : 1;
      dark += tracer.occluded(rays[i]) == truth[i].has_value() ? 0 : 1;
      if (i % 8 != 0) return;
      WorkCounts closest, any;
      wrong += same(counted_closest_hit(tracer, rays[i], closest), truth[i]) ? 0 : 1;
      dark += counted_occluded(tracer, rays[i], any) == truth[i].has_value() ? 0 : 1;
      uncounted += truth[i] && (closest.primitives == 0 || any.primitives == 0) ? 1 : 0;
    });
    EXPECT_EQ(uncounted, 0u) << packet_target();
    EXPECT_EQ(wrong, 0u) << "closest hits differ, " << packet_target();
    EXPECT_EQ(dark, 0u) << "occlusion differs, " << packet_target();
  });
}

Vec3 some_corner(const World& world, Random& random) {
  return world.corners(random.below(world.triangle_count()))[random.below(3)];
}

Vec3 axis_of(Random& random) {  // zeros of either sign
  Vec3 axis(0.0);
  for (int a = 0; a < 3; ++a) axis[a] = random.below(2) == 0 ? 0.0 : -0.0;
  axis[static_cast<int>(random.below(3))] = random.below(2) == 0 ? 1.0 : -1.0;
  return axis;
}

/// From up to `reach` around the world's middle: at corners and edges but for a few last places, along edges
/// and in the planes of triangles, along axes, in planes of boxes, with ends near hits, of any length.
std::vector<Ray> hard_rays(const World& world, int count, double reach, std::uint64_t seed) {
  Random random(seed);
  std::vector<Ray> rays;
  const Vec3 middle = world.finite_bounds.center();
  for (int i = 0; i < count; ++i) {
    const auto [p, q, r] = world.corners(random.below(world.triangle_count()));
    const Vec3 corner = some_corner(world, random), from = middle + random.in_box(reach);
    const Vec3 on_edge = p + random.uniform(0.0, 1.0) * (q - p);
    const double u = random.uniform(0.0, 0.5), v = random.uniform(0.0, 0.5);
    const Vec3 inside = p + u * (q - p) + v * (r - p);
    const Vec3 axis = axis_of(random);
    Ray ray;
    switch (i % 10) {
      case 0:
        ray = {from, random.nudged(corner, 2) - from};
        break;
      case 1:
        ray = {from, random.nudged(on_edge, 2) - from};
        break;
      case 2:
        ray = {corner - 2.0 * reach * axis, axis};
        break;
      case 3:
        ray = {on_edge - 2.0 * reach * axis, axis};
        break;
      case 4:
        ray = {p - random.uniform(0.0, 3.0) * (q - p), q - p};
        break;
      case 5:
        ray = {random.nudged(inside, 1), random.direction()};
        break;
      case 6: {  // a component so small that its reciprocal is not a float
        Vec3 d = random.direction();
        d[static_cast<int>(random.below(3))] *= std::exp2(random.uniform(-1060.0, -20.0));
        ray = {inside - 2.0 * reach * d, d};
        break;
      }
      case 7:
        ray = {inside - reach * axis, axis, {0.0, reach * random.uniform(0.5, 1.5)}};
        break;
      case 8:
        ray = {from, inside - from, {random.uniform(0.5, 1.0), random.uniform(1.0, 1.5)}};
        break;
      default:
        ray = {from, (inside - from) * std::exp2(random.uniform(-300.0, 300.0))};
        break;
    }
    if (i % 7 == 0) {  // ends exactly at a hit, or next to it
      const double t = 1.0 + static_cast<double>(random.below(3) - 1.0) * 0x1p-52;
      ray = {from, corner - from, {i % 2 == 0 ? 0.0 : t, i % 2 == 0 ? t : infinity}};
    }
    rays.push_back(ray);
  }
  return rays;
}

TEST(Wide, SoupOfAllSizes) {
  std::vector<Mesh> meshes;
  for (int i = 0; i < 5; ++i)
    meshes.push_back(
        test::triangle_soup(200, 2.0, std::exp2(-6.0 * i + 2.0), static_cast<std::uint64_t>(i) + 1));
  const TestWorld w(test::scene_of(std::move(meshes)));
  expect_same(w.world(), hard_rays(w.world(), 20000, 3.0, 2), 9000);
}

TEST(Wide, FewTriangles) {
  for (const int count : {1, 2, 5, 15, 16, 17, 33}) {
    const TestWorld w(test::scene_of({test::triangle_soup(count, 1.0, 1.0, 23)}));
    expect_same(w.world(), hard_rays(w.world(), 2000, 2.0, 24), 500);
  }
}

TEST(Wide, ClosedMeshesFarFromTheOriginAndSeenFromFar) {
  for (const Vec3& offset : {Vec3(0.0), Vec3(1e6, -1e6, 1e6), Vec3(148376.0, 1234.0, -223423.0)})
    for (const double reach : {2.0, 60.0, 1e5}) {
      const TestWorld w(test::scene_of({test::uv_sphere(offset, 1.0, 24, 32, 0.1, 3)}));
      expect_same(w.world(), hard_rays(w.world(), 5000, reach, 4), 2500);
    }
}

TEST(Wide, TinyAndHugeWorlds) {
  for (const double scale : {1e-12, 1e-8, 1e-3, 1e6, 1e8, 1e12}) {  // the first and last have no wide tree
    const TestWorld w(test::scene_of({test::moved(test::triangle_soup(300, 2.0, 0.5, 5), scale, Vec3(0.0))}));
    expect_same(w.world(), hard_rays(w.world(), 5000, 3.0 * scale, 6), 2000);
  }
}

TEST(Wide, NeedlesAndATriangleAsLargeAsTheRest) {
  Random random(7);
  Mesh needles = test::triangle_soup(300, 2.0, 1.0, 8);
  for (std::size_t i = 2; i < needles.positions.size(); i += 3)
    needles.positions[i] = needles.positions[i - 1] + random.in_box(std::exp2(random.uniform(-50.0, -5.0)));
  const TestWorld w(
      test::scene_of({needles, test::quad(Vec3(-1e3, -2.5, -1e3), Vec3(2e3, 0, 0), Vec3(0, 0, 2e3))}));
  expect_same(w.world(), hard_rays(w.world(), 20000, 3.0, 9), 8000);
}

/// A hierarchy of one leaf that has more corners than a leaf of the wide tree has room for.
TEST(Wide, LeafOfTooManyCornersIsHalved) {
  const TestWorld w(test::scene_of({test::triangle_soup(15, 1.0, 1.0, 25)}));
  Bvh bvh = build_flat(w.world());
  BvhNode root{};
  for (std::size_t i = 0; i < 4; ++i) {
    root.child[i] = i == 0 ? BvhChild::leaf(0, 15) : BvhChild::empty();
    for (std::size_t row = 0; row < 6; ++row) root.bounds[row][i] = (row < 3) == (i == 0) ? -3.0f : 3.0f;
  }
  bvh.nodes.push_back(root), bvh.below.push_back({0, 15});
  const auto tree = collapse_bvh(bvh, w.world());
  ASSERT_NE(tree, nullptr);
  EXPECT_EQ(tree->leaves.size(), 4u);
  const Tracer brute(w.world(), Accel::brute);
  std::size_t hits = 0, missing = 0;
  for (const Ray& ray : hard_rays(w.world(), 5000, 2.0, 26)) {
    LeafCandidates found;
    const auto hit = brute.closest_hit(ray);
    if (!hit || closest_candidates(*tree, ray, found) == WideTraversal::refused) continue;
    const auto end = found.leaf.begin() + static_cast<std::ptrdiff_t>(found.count);
    const auto at = std::find_if(found.leaf.begin(), end,
                                 [&](std::uint32_t leaf) { return bvh.ids[leaf] == hit->primitive; });
    ++hits, missing += at == end ? 1 : 0;
  }
  EXPECT_GT(hits, 1000u);
  EXPECT_EQ(missing, 0u);
}

/// Corners in sixteen bits are off by half a step at most, no step is longer than it has to be, and no edge
/// longer than is said: the floats' bounds stand on these.
void expect_packed_within_bounds(const World& world) {
  const Bvh bvh = build_bvh(world);
  const auto tree = collapse_bvh(bvh, world);
  ASSERT_NE(tree, nullptr);
  double farthest = 0.0, longest = 0.0, coarsest = 0.0;  // in steps; in L; of what sixteen bits need
  std::size_t triangles = 0;
  for (const WideLeaf& leaf : tree->leaves) {
    const auto step = static_cast<double>(leaf.step());
    double extent = 0x1p-14 * static_cast<double>(tree->reach);
    for (unsigned i = 0; i <= leaf.triangles.last(); ++i, ++triangles)
      for (std::size_t at = 0; at < 9; ++at) {
        const auto v = bvh.primitives[leaf.triangles.first() + i].v;
        const auto number = leaf.triangles.index[at / 3][i % 2] >> (4 * (i / 2)) & 15u;
        ASSERT_GT(number, 0u);
        const double corner = v[at] - tree->center[at % 3], anchor = static_cast<double>(leaf.anchor(at % 3));
        farthest =
            std::max(farthest, std::abs(anchor + leaf.corner[at % 3][number - 1] * step - corner) / step);
        extent = std::max(extent, std::abs(corner - anchor));
        const double edge = std::abs(v[(at + 3) % 9] - v[at]);
        longest = std::max(longest, 13.0 * edge / static_cast<double>(leaf.size_13()));
      }
    coarsest = std::max(coarsest, step * 32767.0 / extent);
  }
  EXPECT_EQ(triangles, bvh.primitives.size());
  EXPECT_LE(farthest, 0.5 + 0x1p-20);
  EXPECT_LE(longest, 1.0);
  EXPECT_LE(coarsest, 1.02);
}

TEST(Wide, CornersInSixteenBitsAreWithinTheirBounds) {
  for (const double size : {0.001, 0.1, 4.0}) {
    const TestWorld w(test::scene_of({test::triangle_soup(500, 2.0, size, 30)}));
    expect_packed_within_bounds(w.world());
  }
  for (const Vec3& offset : {Vec3(0.0), Vec3(148376.0, 1234.0, -223423.0)}) {
    const TestWorld w(test::scene_of({test::uv_sphere(offset, 1.0, 24, 32, 0.1, 31),
                                      test::quad(offset, Vec3(1e3, 0, 0), Vec3(0, 0, 1e3))}));
    expect_packed_within_bounds(w.world());
  }
}

TEST(Wide, LatticeOfBoxesWhosePlanesCoincide) {
  std::vector<Mesh> meshes;
  for (int i = 0; i < 216; ++i) {
    const Vec3 at(i % 6, i / 6 % 6, i / 36);
    if ((i % 6 + i / 6 % 6 + i / 36) % 2 == 0) meshes.push_back(test::box(at, at + Vec3(1.0)));
  }
  const TestWorld w(test::scene_of(std::move(meshes)));
  auto rays = hard_rays(w.world(), 10000, 8.0, 10);
  Random random(11);
  for (int i = 0; i < 10000; ++i) {  // in walls, through many corners
    const Vec3 a{random.below(7), random.below(7), random.below(7)}, b{random.below(7), random.below(7), 3};
    rays.push_back({a - 3.0 * (b - a), b - a, {0.0, 10.0}});
  }
  expect_same(w.world(), rays, 9000);
  expect_same(w.world(), hard_rays(w.world(), 20000, 150.0, 22), 9000);
}

/// Shapes, a plane, and holes cut by a mask beside solid triangles.
Scene mixed_scene() {
  std::vector<Shape> shapes{test::plane(Vec3(0, -4, 0), Vec3(0, 1, 0)),
                            test::plane(Vec3(0, 9, 0), Vec3(0, 1, 0))};
  Random random(12);
  for (int i = 0; i < 40; ++i)
    shapes.push_back(test::some_sphere(random, 3.0, {0.05, 0.6}, i % 3 == 0 ? 1 : 0));
  Scene scene = test::scene_of(
      {test::triangle_soup(400, 3.0, 1.0, 13), test::triangle_soup(200, 3.0, 1.0, 21)}, std::move(shapes));
  scene.materials.resize(2);
  scene.materials[1].alpha_mode = AlphaMode::mask, scene.materials[1].alpha = 0.25f;
  scene.instances[1].material = 1;
  return scene;
}

TEST(Wide, ShapesAndPlanes) {
  Scene scene = mixed_scene();
  scene.materials[1].alpha_mode = AlphaMode::opaque;
  const TestWorld w(std::move(scene));
  expect_same(w.world(), hard_rays(w.world(), 10000, 5.0, 32), 7000);
}

TEST(Wide, ShapesPlanesAndMasks) {
  const TestWorld w(mixed_scene());
  expect_same(w.world(), hard_rays(w.world(), 20000, 5.0, 14), 15000);
  expect_same(w.world(), hard_rays(w.world(), 4000, 5.0, 15), 3000, Precision::exact);
}

void expect_same_visibility(Scene scene, std::size_t least_open) {
  scene.lights = {test::point_light(Vec3(2.0, 6.0, 1.0)), test::sun(Vec3(0.0, -1.0, 0.0))};
  const TestWorld w(std::move(scene));
  for (const Precision precision : {Precision::robust, Precision::exact}) {
    const Tracer tracer(w.world(), Accel::bvh, precision), brute(w.world(), Accel::brute, precision);
    prepare_single_rays(tracer);
    const auto rays = hard_rays(w.world(), 4000, 5.0, 16);
    for_each_target([&] {
      std::atomic<std::size_t> wrong = 0, open = 0;
      tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t i) {
        const auto hit = brute.closest_hit(rays[i]);
        if (!hit || !std::isfinite(hit->t)) return;
        const SurfacePoint point = brute.surface_point(rays[i], *hit);
        LastBlocker last;  // of the light before, then of this one
        for (const Light& light : w.scene().lights) {
          const PointVisibility truth = brute.centre_visibility(point, light);
          open += truth == PointVisibility::uncertain ? 1 : 0;
          for (LastBlocker* kept : {static_cast<LastBlocker*>(nullptr), &last, &last})
            wrong += tracer.centre_visibility(point, light, kept) == truth ? 0 : 1;
          wrong += same(tracer.nearest_occluder(point, light), brute.nearest_occluder(point, light)) ? 0 : 1;
        }
      });
      EXPECT_EQ(wrong, 0u) << packet_target();
      if (precision == Precision::robust) {
        EXPECT_GE(open, least_open);
      }
    });
  }
}

TEST(Wide, VerdictsAndNearestOccludersWithMasks) {
  Scene scene = mixed_scene();
  scene.materials[1].alpha = 1.0f;
  expect_same_visibility(std::move(scene), 10);
}

TEST(Wide, VerdictsAndNearestOccludersWithPlanes) {
  Scene scene = mixed_scene();
  scene.materials[1].alpha_mode = AlphaMode::opaque;
  expect_same_visibility(std::move(scene), 10);
}

TEST(Wide, VerdictsAndNearestOccluders) {
  Scene scene = mixed_scene();
  scene.materials[1].alpha_mode = AlphaMode::opaque;
  scene.shapes.erase(scene.shapes.begin(), scene.shapes.begin() + 2);
  expect_same_visibility(std::move(scene), 10);
  expect_same_visibility(test::scene_of({test::uv_sphere(Vec3(0.0), 1.5, 16, 24, 0.1, 29),
                                         test::quad(Vec3(-3, -2, -3), Vec3(0, 0, 6), Vec3(6, 0, 0))}),
                         0);
}

/// The textbook's test walks the same tree, and its answers, wrong ones included, are those of its walk
/// through the default hierarchy. Where rounding takes a hit out of its triangle's box, the boxes decide;
/// these differ.
TEST(Wide, TextbooksTest) {
  for (const Vec3& offset : {Vec3(0.0), Vec3(148376.0, 1234.0, -223423.0)}) {
    Scene scene = test::scene_of(
        {test::uv_sphere(offset, 1.0, 24, 32, 0.1, 27)},
        {test::sphere(offset + Vec3(1.5, 0.0, 0.0), 0.4), test::plane(Vec3(0, -2, 0), Vec3(0, 1, 0))});
    const TestWorld w(std::move(scene));
    const Tracer fast(w.world(), Accel::bvh, Precision::fast), robust(w.world(), Accel::bvh);
    const auto rays = hard_rays(w.world(), 20000, 2.0, 28);
    for_each_target([&] {
      std::size_t differ = 0, wrong = 0;
      for (const Ray& ray : rays) {
        WorkCounts work;
        const auto hit = fast.closest_hit(ray), plain = fast.closest_hit(ray, work);
        const bool equal = same(hit, plain) && fast.occluded(ray) == fast.occluded(ray, work);
        differ += equal ? 0 : 1;
        wrong += hit.has_value() != robust.closest_hit(ray).has_value() ? 1 : 0;
      }
      EXPECT_GT(wrong, 1000u) << packet_target();
      EXPECT_LT(differ, wrong / 10) << packet_target();
    });
  }
}

/// What the floats leave over is nearly only what is hit: the filter is worth its name.
TEST(Wide, FewCandidatesBesideTheHit) {
  const TestWorld w(test::scene_of({test::uv_sphere(Vec3(0.0), 1.0, 64, 96, 0.05, 17)}));
  const Tracer tracer(w.world(), Accel::bvh);
  const Bvh bvh = build_bvh(w.world());
  const auto tree = collapse_bvh(bvh, w.world());
  ASSERT_NE(tree, nullptr);
  Random random(18);
  std::size_t hits = 0, candidates = 0;
  for (int i = 0; i < 10000; ++i) {
    const Vec3 from = random.in_box(3.0);
    const Ray ray{from, random.in_box(0.9) - from};
    LeafCandidates found;
    ASSERT_EQ(closest_candidates(*tree, ray, found), WideTraversal::done);
    for (std::size_t k = 0; k < found.count; ++k) candidates += found.t[k] <= found.t_max ? 1 : 0;
    hits += tracer.closest_hit(ray) ? 1 : 0;
  }
  EXPECT_GT(hits, 2000u);
  EXPECT_LT(static_cast<double>(candidates), 1.05 * static_cast<double>(hits));
}

TEST(Wide, IsThereOnlyWhenManyRaysHaveAskedForIt) {
  const TestWorld w(test::scene_of({test::uv_sphere(Vec3(0.0), 1.0, 64, 96, 0.05, 19)}));
  const Tracer tracer(w.world(), Accel::bvh), other(w.world(), Accel::kdtree);
  const Ray ray{Vec3(0.0), Vec3(1.0, 2.0, 3.0)};
  for (int i = 0; i < 3000; ++i) EXPECT_TRUE(tracer.occluded(ray));
  EXPECT_EQ(single_ray_bytes(tracer), 0u);
  for (int i = 0; i < 20000; ++i) EXPECT_TRUE(tracer.occluded(ray));
  EXPECT_GT(single_ray_bytes(tracer), 0u);
  prepare_single_rays(other);
  EXPECT_EQ(single_ray_bytes(other), 0u);
}

TEST(Wide, Bunny) {
  auto bunny = test::read_obj(gnomon::test::shared_data() + "/common_organic/stanford-bunny.obj");
  if (!bunny) GTEST_SKIP() << "no bunny beside the sources";
  const TestWorld w(test::scene_of({test::normalised(std::move(*bunny))}));
  expect_same(w.world(), hard_rays(w.world(), 400, 0.8, 20), 200);
}

}  // namespace
}  // namespace gnomon
