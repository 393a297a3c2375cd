// Which triangles belong to one connected surface: by hand, against a search from triangle to triangle, and the same
// whether instances are kept or written out.
#include <gtest/gtest.h>

#include <map>

#include "compare/truth/surfaces.h"
#include "tests/support/placements.h"
#include "tests/support/small_scenes.h"

namespace gnomon {
namespace {

using compare::Surfaces;
using raytrace::Topology;

/// Returns for each triangle the lowest one that can be reached from it over shared corners.
std::vector<std::uint32_t> reached_by_corners(const World& world, const Topology& topology) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> at_corner;
  for (std::uint32_t t = 0; t < world.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) at_corner[topology.welded(t, k)].push_back(t);
  std::vector<std::uint32_t> lowest(world.triangle_count(), no_id);
  for (std::uint32_t first = 0; first < lowest.size(); ++first) {
    std::vector<std::uint32_t> open;
    const auto reach = [&](std::uint32_t t) {
      if (lowest[t] == no_id) lowest[t] = first, open.push_back(t);
    };
    reach(first);
    while (!open.empty()) {
      const std::uint32_t t = open.back();
      open.pop_back();
      for (int k = 0; k < 3; ++k)
        for (const std::uint32_t other : at_corner[topology.welded(t, k)]) reach(other);
    }
  }
  return lowest;
}

/// Returns how many of the pairs hang together.
std::uint64_t expect_as_searched(const Scene& scene, InstanceChoice choice) {
  const World world = make_world(scene, choice);
  const Topology topology(world);
  const Surfaces surfaces(world, topology);
  const std::vector<std::uint32_t> lowest = reached_by_corners(world, topology);
  std::uint64_t together = 0;
  for (std::uint32_t a = 0; a < lowest.size(); ++a)
    for (std::uint32_t b = 0; b < lowest.size(); ++b) {
      const bool same = lowest[a] == lowest[b];
      EXPECT_EQ(surfaces.same(a, b), same) << a << " and " << b;
      if (surfaces.same(a, b) != same) return 0;
      together += same && a != b ? 1 : 0;
    }
  return together;
}

void expect_both_ways(const Scene& scene, std::uint64_t together) {
  EXPECT_EQ(expect_as_searched(scene, InstanceChoice::keep), together);
  EXPECT_EQ(expect_as_searched(scene, InstanceChoice::flatten), together);
}

TEST(ConnectedSurfaces, OfInstancesThatTouchAndThatStandApart) {
  const Mesh cube = test::box(Vec3(0.0), Vec3(1.0));
  const std::uint64_t faces = cube.triangles.size();
  std::vector<std::pair<std::uint32_t, Mat4>> placed;
  for (int i = 0; i < 4; ++i) placed.emplace_back(0, test::moved(Vec3(i, 0, 0), Mat4(1.0)));  // side by side
  for (int i = 0; i < 3; ++i) placed.emplace_back(0, test::moved(Vec3(3 * i, 9, 0), Mat4(1.0)));
  placed.emplace_back(0, test::moved(Vec3(30, 0, 0), test::scaling({-1.0, 1.0, 1.0})));
  const auto ordered_pairs = [](std::uint64_t n) { return n * (n - 1); };
  expect_both_ways(test::instances_of({cube}, placed), ordered_pairs(4 * faces) + 4 * ordered_pairs(faces));
}

TEST(ConnectedSurfaces, OfMeshesThatFallApart) {
  Mesh pieces = test::triangle_soup(40, 0.8, 0.5, 5);
  const Mesh ball = test::ball();
  const auto first = static_cast<std::uint32_t>(pieces.positions.size());
  pieces.positions.insert(pieces.positions.end(), ball.positions.begin(), ball.positions.end());
  for (const auto& [a, b, c] : ball.triangles) pieces.triangles.push_back({first + a, first + b, first + c});
  std::vector<std::pair<std::uint32_t, Mat4>> placed;
  for (int i = 0; i < 5; ++i) placed.emplace_back(0, test::moved(Vec3(9 * i, 0, 0), Mat4(1.0)));
  const std::uint64_t n = ball.triangles.size();
  expect_both_ways(test::instances_of({pieces}, placed), 5 * n * (n - 1));
}

// Whichever corners they are.
TEST(ConnectedSurfaces, HangTogetherByOneCorner) {
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b) {
      Mesh tie = test::triangle_soup(2, 0.8, 0.5, 5);
      tie.positions[tie.triangles[0][a]] = tie.positions[tie.triangles[1][b]];
      expect_both_ways(test::instances_of({tie}, {{0, Mat4(1.0)}}), 2);
    }
}

// The lowest vertex at a corner's place may be one of a mesh that has no triangles.
TEST(ConnectedSurfaces, OfVerticesThatNoTriangleUses) {
  Mesh vertices;
  const Mesh ball = test::ball();
  vertices.positions = ball.positions;
  const std::uint64_t n = ball.triangles.size();
  for (int i = 0; i < 20; ++i)  // memory that is used again holds other numbers
    expect_both_ways(test::instances_of({vertices, ball}, {{0, Mat4(1.0)}, {1, Mat4(1.0)}}), n * (n - 1));
}

/// At an angle from the horizontal, by which the normal leans, too; both in degrees.
raytrace::SurfacePoint seen(const Vec3& position, double lean, std::uint32_t triangle) {
  const double angle = lean * pi / 180.0;
  raytrace::SurfacePoint point;
  point.position = position, point.normal = {std::sin(angle), std::cos(angle), 0.0};
  point.primitive = triangle;
  return point;
}

TEST(SmoothSurfaces, AreNotATableAndTheFloorBehindIt) {
  const World world = make_world(test::sunlit_scene({test::box(Vec3(0.0), Vec3(1.0))}, {0, -1, 0}));
  ASSERT_GE(world.triangle_count(), 2u);
  const raytrace::SurfacePoint table = seen({0, 1, 0}, 0.0, 0);
  EXPECT_TRUE(compare::on_smooth_surface(table, seen({1, 1, 0}, 0.0, 1), world));
  for (const double behind :
       {0.1, 1.0, 10.0, 40.0})  // the eye looks down at up to 84 and down to 1.4 degrees
    EXPECT_FALSE(compare::on_smooth_surface(table, seen({behind, 0, 0}, 0.0, 1), world)) << behind;
  // Two planes that meet in an edge at x = 0 at an angle, seen at any distances from it; and an arc's two ends.
  for (const double angle : {5.0, 15.0, 25.0})
    for (const double other : {0.01, 1.0, 100.0}) {
      const double a = angle * pi / 180.0;
      const Vec3 down = other * Vec3(std::cos(a), -std::sin(a), 0.0);
      EXPECT_TRUE(compare::on_smooth_surface(seen({-1, 0, 0}, 0.0, 0), seen(down, angle, 1), world));
      const Vec3 round(std::sin(a), std::cos(a), 0.0);
      EXPECT_TRUE(compare::on_smooth_surface(seen({0, 1, 0}, 0.0, 0), seen(round, angle, 1), world));
    }
  EXPECT_FALSE(compare::on_smooth_surface(table, seen({1, 1, 0}, 30.0, 1), world));  // a crease
}

}  // namespace
}  // namespace gnomon
