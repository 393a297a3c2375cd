// Every acceleration structure against brute force, to the last bit: random scenes, rays aimed where a
// structure may lose something (vertices, edges, walls and corners of cells, along and inside split planes),
// scenes that break builders, real models. Numbers refer to the list of hard cases.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <atomic>

#include "raytrace/accel/any_structure.h"
#include "raytrace/frame.h"
#include "raytrace/kernels.h"
#include "tests/support/places.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using namespace raytrace;  // NOLINT(google-build-using-namespace): every second word here is from that room
using test::Random;
using test::same;
using test::TestWorld;

constexpr std::array<std::pair<const char*, Accel>, 9> structures{{{"bvh", Accel::bvh},
                                                                   {"bvh-median", Accel::bvh_median},
                                                                   {"kdtree", Accel::kdtree},
                                                                   {"kdtree-cyclic", Accel::kdtree_cyclic},
                                                                   {"octree", Accel::octree},
                                                                   {"grid", Accel::grid},
                                                                   {"grid-textbook", Accel::grid_textbook},
                                                                   {"bsp", Accel::bsp},
                                                                   {"two-level", Accel::two_level}}};

/// The structures of a world, and brute force.
class Rivals {
 public:
  explicit Rivals(const World& world) : brute_(world, Accel::brute) {
    for (const auto& [name, accel] : structures) tracers_.emplace_back(world, accel);
  }
  const Tracer& operator[](std::size_t i) const { return tracers_[i]; }

  /// Rays on which some structure differs from brute force; each structure is named once.
  std::uint64_t disagreements(const std::vector<Ray>& rays) {
    std::atomic<std::uint64_t> wrong = 0, hits = 0;
    std::array<std::atomic<bool>, structures.size()> named{};
    tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t r) {
      const std::optional<Hit> truth = brute_.closest_hit(rays[r]);
      hits += truth ? 1 : 0;
      const bool dark = brute_.occluded(rays[r]);
      for (std::size_t i = 0; i < tracers_.size(); ++i) {
        const bool right =
            same(tracers_[i].closest_hit(rays[r]), truth) && tracers_[i].occluded(rays[r]) == dark;
        if (right) continue;
        ++wrong;
        if (!named[i].exchange(true))
          ADD_FAILURE() << structures[i].first << " on ray " << r << ": hit "
                        << (truth ? static_cast<int>(truth->primitive) : -1);
      }
    });
    hits_ = hits;
    return wrong;
  }
  std::uint64_t hits() const { return hits_; }  ///< of the last rays

 private:
  Tracer brute_;
  std::vector<Tracer> tracers_;
  std::uint64_t hits_ = 0;
};

std::vector<Ray> random_rays(int count, double extent, std::uint64_t seed) {
  Random random(seed);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    Ray ray{random.in_box(extent), test::some_direction(random, {0.1, 10.0})};
    if (i % 4 == 1) ray.t.max = random.uniform(0.0, 0.3);
    if (i % 4 == 2) ray.t.min = random.uniform(0.0, 0.3);
    rays.push_back(ray);
  }
  return rays;
}

Vec3 vertex(const World& world, Random& random) {
  return world.position(random.below(world.vertex_count()));
}

/// At vertices, along edges, with zero components, from points that lie on them.
std::vector<Ray> adversarial_rays(const World& world, int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const Vec3 a = vertex(world, random);
    const auto [p, q, r] = world.corners(random.below(world.triangle_count()));
    const Vec3 on_edge = p + random.uniform(0.0, 1.0) * (q - p);
    Vec3 axis(0.0);
    axis[static_cast<int>(random.below(3))] = random.below(2) == 0 ? 1.0 : -1.0;
    const Vec3 minus_zero(axis.x == 0.0 ? -0.0 : axis.x, axis.y == 0.0 ? -0.0 : axis.y,
                          axis.z == 0.0 ? -0.0 : axis.z);
    const Vec3 from = random.in_box(6.0);
    const std::array<Ray, 6> kinds{{{from, random.nudged(a, 2) - from},
                                    {from, on_edge - from},
                                    {a - 8.0 * axis, axis},
                                    {on_edge - 8.0 * minus_zero, minus_zero},
                                    {a, q - p},
                                    {p - (q - p), q - p}}};
    rays.push_back(kinds[static_cast<std::size_t>(i) % kinds.size()]);
  }
  return rays;
}

Scene mixed_scene() {
  std::vector<Mesh> meshes{test::triangle_soup(400, 4.0, 1.0, 1),
                           test::uv_sphere(Vec3(1, 0, 0), 1.0, 8, 12, 0.05, 4)};
  std::vector<Shape> shapes{test::plane(Vec3(0, -4, 0), Vec3(0, 1, 0))};
  Random random(2);
  for (int i = 0; i < 30; ++i) shapes.push_back(test::some_sphere(random, 4.0, {0.05, 0.8}));
  return test::scene_of(std::move(meshes), std::move(shapes));
}

/// Boxes on a lattice: every face lies in many another box' plane, and in the walls of regular cells.
Scene lattice_scene(int n) {
  std::vector<Mesh> meshes;
  for (int x = 0; x < n; ++x)
    for (int y = 0; y < n; ++y)
      for (int z = 0; z < n; ++z)
        if ((x + y + z) % 2 == 0) meshes.push_back(test::box(Vec3(x, y, z), Vec3(x + 1, y + 1, z + 1)));
  return test::scene_of(std::move(meshes));
}

TEST(Accel, AgreesWithBruteForceOnRandomRays) {
  const TestWorld w(mixed_scene());
  Rivals rivals(w.world());
  EXPECT_EQ(rivals.disagreements(random_rays(20000, 5.0, 3)), 0u);
  EXPECT_GT(rivals.hits(), 5000u);
}

TEST(Accel, AgreesWithBruteForceOnAdversarialRays) {
  const TestWorld w(mixed_scene());
  Rivals rivals(w.world());
  EXPECT_EQ(rivals.disagreements(adversarial_rays(w.world(), 20000, 5)), 0u);
  EXPECT_GT(rivals.hits(), 5000u);
}

TEST(Accel, Case17And18RaysInWallsAndThroughCornersOfCells) {
  const TestWorld w(lattice_scene(6));
  Rivals rivals(w.world());
  Random random(7);
  std::vector<Ray> rays;
  const auto lattice = [&] { return Vec3{random.below(7), random.below(7), random.below(7)}; };
  for (int i = 0; i < 20000; ++i) {
    const Vec3 a = lattice(), b = lattice();
    const Vec3 outside = a + 12.0 * random.direction();
    switch (i % 4) {
      case 0:
        rays.push_back({a, b - a});
        break;  // corner to corner
      case 1:
        rays.push_back({a - 3.0 * (b - a), b - a, {0.0, 10.0}});
        break;  // from outside, through many
      case 2:
        rays.push_back({outside, random.nudged(a, 1) - outside});
        break;    // at a corner
      default: {  // inside a wall, off its lines
        const int axis = static_cast<int>(random.below(3));
        Vec3 from = random.in_box(8.0), direction = random.direction();
        from[axis] = a[axis], direction[axis] = random.below(2) == 0 ? 0.0 : -0.0;
        rays.push_back({from, direction});
      }
    }
  }
  EXPECT_EQ(rivals.disagreements(rays), 0u);
  EXPECT_GT(rivals.hits(), 10000u);
}

TEST(Accel, BytesHoldWhatFastReads) {
  const TestWorld w(test::scene_of({test::triangle_soup(100, 1.0, 0.2, 61)}));
  const auto bytes = [&](Precision precision) {
    return Tracer(w.world(), Accel::bvh, precision).stats().bytes;
  };
  EXPECT_EQ(bytes(Precision::fast), bytes(Precision::robust) + 100 * sizeof(FastPrimitive));
}

TEST(Accel, CellCornersOfTheGridItselfAndSplitsOfTheKdTree) {
  const TestWorld w(test::scene_of({test::triangle_soup(500, 3.0, 0.8, 11)}));
  Rivals rivals(w.world());
  const Structure of_grid = build_structure(w.world(), Accel::grid);
  const Structure of_kd_tree = build_structure(w.world(), Accel::kdtree);
  const auto& grid = std::get<UniformGrid>(of_grid);
  const auto& tree = std::get<KdTree>(of_kd_tree);
  const Vec3 center = finite_primitives(w.world()).center;
  Random random(12);
  const auto grid_corner = [&] {
    Vec3 p;
    for (std::size_t a = 0; a < 3; ++a)
      p[static_cast<int>(a)] = grid.walls[a][random.below(static_cast<std::uint32_t>(grid.walls[a].size()))];
    return p + center;
  };
  std::vector<Ray> rays;
  for (int i = 0; i < 10000; ++i) {
    const Vec3 a = grid_corner(), b = grid_corner();
    rays.push_back({a, b - a});
    const KdNode& node = tree.nodes[random.below(static_cast<std::uint32_t>(tree.nodes.size()))];
    if (node.is_leaf()) continue;
    Ray in_plane{random.in_box(4.0), random.direction()};
    const auto axis = static_cast<int>(node.axis());
    in_plane.origin[axis] = node.split + center[axis], in_plane.direction[axis] = 0.0;
    rays.push_back(in_plane);
  }
  EXPECT_EQ(rivals.disagreements(rays), 0u);
  EXPECT_GT(rivals.hits(), 3000u);
}

TEST(Accel, PlanesOfTheBspTree) {
  const TestWorld w(test::scene_of({test::triangle_soup(500, 3.0, 0.8, 13)}));
  Rivals rivals(w.world());
  Random random(14);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {  // within a triangle's own plane, through an edge's end, across an edge
    const auto [p, q, r] = w.world().corners(random.below(w.world().triangle_count()));
    const Vec3 u = q - p, v = r - p;
    const auto somewhere = [&](double reach) {
      const double along_u = random.uniform(-reach, reach);
      return along_u * u + random.uniform(-reach, reach) * v;
    };
    const Vec3 from = p + somewhere(6.0);
    rays.push_back({from, somewhere(1.0)});
  }
  EXPECT_EQ(rivals.disagreements(rays), 0u);
  EXPECT_GT(rivals.hits(), 1000u);
}

TEST(Accel, FarFromTheOriginAndFromFarAway) {
  for (const Vec3& offset : {Vec3(3e3), Vec3(148376.0, 1234.0, -223423.0), Vec3(1e7, -1e7, 1e7)}) {
    Mesh mesh = test::uv_sphere(offset, 1.0, 12, 16, 0.1, 3);
    const TestWorld w(test::scene_of({std::move(mesh)}));
    Rivals rivals(w.world());
    Random random(15);
    std::vector<Ray> rays;
    for (int i = 0; i < 4000; ++i) {
      const Vec3 from = i % 2 == 0 ? offset + random.in_box(3.0) : random.in_box(10.0);
      rays.push_back({from, random.nudged(vertex(w.world(), random), 1) - from});
    }
    EXPECT_EQ(rivals.disagreements(rays), 0u) << offset.x;
    EXPECT_GT(rivals.hits(), 2000u) << offset.x;
  }
}

TEST(Accel, Case14NothingOneAndTwo) {
  for (int count = 0; count <= 2; ++count) {
    const TestWorld w(test::scene_of(
        count == 0 ? std::vector<Mesh>{} : std::vector<Mesh>{test::triangle_soup(count, 1.0, 1.0, 21)}));
    Rivals rivals(w.world());
    EXPECT_EQ(rivals.disagreements(random_rays(3000, 2.0, 22)), 0u);
    EXPECT_EQ(rivals.hits() > 0, count > 0);
  }
}

TEST(Accel, Case13EqualCentroidsAndManyDuplicates) {
  Mesh nested, equal;
  for (int i = 1; i <= 300; ++i) {  // one centroid
    const double s = 0.01 * i;
    const auto first = static_cast<std::uint32_t>(nested.positions.size());
    for (const Vec3& p : {Vec3(-s, -s, 0.0), Vec3(s, -s, 0.0), Vec3(0.0, 2.0 * s, 0.0)})
      nested.positions.push_back(p);
    nested.triangles.push_back({first, first + 1, first + 2});
  }
  const TestWorld w(test::scene_of({nested}));
  EXPECT_EQ(Rivals(w.world()).disagreements(random_rays(5000, 3.0, 23)), 0u);

  constexpr std::uint32_t copies = 25000;
  equal.positions = {Vec3(-1, -1, 0.25), Vec3(1, -1, 0.0), Vec3(0, 1, -0.25)};
  equal.triangles.assign(copies, {0, 1, 2});
  const TestWorld many(test::scene_of({equal}));
  const Ray ray{Vec3(0.05, 0.02, 3.0), Vec3(0.01, 0.0, -1.0)};
  for (const auto& [name, accel] : structures) {
    const Tracer tracer(many.world(), accel);
    const auto hit = tracer.closest_hit(ray);
    ASSERT_TRUE(hit.has_value()) << name;
    EXPECT_EQ(hit->primitive, 0u) << name << ": the lowest id wins a tie";
    // Bounded: at most 17 references per primitive, and the cells that so many primitives allow.
    EXPECT_LT(tracer.stats().bytes, std::uint64_t{copies} * 400 + (std::uint64_t{16} << 20)) << name;
  }
}

TEST(Accel, Case15BrokenVerticesAreDroppedAndCounted) {
  Mesh mesh = test::triangle_soup(60, 2.0, 1.0, 31);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  mesh.positions[0].x = nan, mesh.positions[3].y = infinity;
  mesh.positions[6] = Vec3(1e30, 0.0, 0.0);  // finite: stays, and stretches every cell
  const TestWorld w(test::scene_of({mesh}));
  Rivals rivals(w.world());
  for (std::size_t i = 0; i < structures.size(); ++i)
    EXPECT_EQ(rivals[i].stats().dropped, 2u) << structures[i].first;
  EXPECT_EQ(rivals.disagreements(random_rays(5000, 2.0, 32)), 0u);
  EXPECT_GT(rivals.hits(), 500u);
}

TEST(Accel, Case16TeapotInAStadium) {
  Mesh ball = test::uv_sphere(Vec3(0.0), 1e-3, 48, 64, 0.02, 41);
  const TestWorld w(test::scene_of({std::move(ball), test::box(Vec3(-1e5), Vec3(1e5))}));
  Rivals rivals(w.world());
  Random random(42);
  std::vector<Ray> rays;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 from = i % 2 == 0 ? random.in_box(5e-3) : random.in_box(9e4);
    rays.push_back({from, i % 3 == 0 ? random.direction() : vertex(w.world(), random) - from});
  }
  EXPECT_EQ(rivals.disagreements(rays), 0u);
  for (std::size_t i = 0; i < structures.size(); ++i)
    EXPECT_LT(rivals[i].stats().bytes, std::uint64_t{96} << 20) << structures[i].first;
}

TEST(Accel, VerdictsAndPicturesDoNotDependOnTheStructure) {
  Scene scene = mixed_scene();
  scene.lights.push_back(test::point_light(Vec3(2.0, 6.0, 1.0)));
  scene.lights.push_back(test::sun(Vec3(0.2, -1.0, 0.1)));
  const TestWorld w(std::move(scene));
  RaytraceOptions options;
  options.size = {96, 64};
  const std::array<std::uint32_t, 2> lights{0, 1};
  const EffectPlan plan = plan_effects(w.scene());
  const auto frame = [&](Accel accel) {
    return trace_frame(Tracer(w.world(), accel), plan, w.scene().camera, lights, options);
  };
  const RayTracedFrame truth = frame(Accel::brute);
  for (const auto& [name, accel] : structures) {
    const RayTracedFrame other = frame(accel);
    for (std::size_t l = 0; l < lights.size(); ++l)
      EXPECT_EQ(other.lights[l].centre.data, truth.lights[l].centre.data) << name;
    EXPECT_EQ(other.color.data, truth.color.data) << name;
  }
}

TEST(Accel, SameForAnyNumberOfThreads) {
  const TestWorld w(test::scene_of({test::triangle_soup(12000, 4.0, 0.3, 51)}));
  const auto build = [&](std::size_t threads, Accel accel) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return build_structure(w.world(), accel);
  };
  const auto items = [](const Structure& s) {
    return std::visit(
        [](const auto& v) -> std::vector<std::uint32_t> {
          if constexpr (requires { v.items; }) return v.items;
          if constexpr (requires { v.leaves.ids; }) return {v.leaves.ids.begin(), v.leaves.ids.end()};
          return {};
        },
        s);
  };
  for (const auto& [name, accel] : structures) {
    if (!has_structure(accel)) continue;
    const Structure one = build(1, accel), four = build(4, accel);
    EXPECT_FALSE(items(one).empty()) << name;
    EXPECT_EQ(items(one), items(four)) << name;
    EXPECT_EQ(size_of(one).nodes, size_of(four).nodes) << name;
  }
}

TEST(Accel, Bunny) {
  auto bunny = test::read_obj(gnomon::test::shared_data() + "/common_organic/stanford-bunny.obj");
  if (!bunny) GTEST_SKIP() << "no bunny beside the sources";
  const TestWorld w(test::scene_of({test::normalised(std::move(*bunny))}));
  Rivals rivals(w.world());
  Random random(61);
  std::vector<Ray> rays;
  for (int i = 0; i < 200; ++i) {
    const Vec3 from = random.in_box(0.8);
    rays.push_back({from, random.nudged(vertex(w.world(), random), 1) - from});
  }
  EXPECT_EQ(rivals.disagreements(rays), 0u);
  EXPECT_GT(rivals.hits(), 150u);
}

}  // namespace
}  // namespace gnomon
