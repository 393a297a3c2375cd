// A hierarchy's primitives come back to the last bit, whichever corners they share, and shared corners are stored once.
#include <gtest/gtest.h>

#include <cstring>

#include "raytrace/bvh/bvh.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using raytrace::LeafPrimitive;
using raytrace::LeafPrimitives;

bool same_bits(const LeafPrimitive& a, const LeafPrimitive& b) {
  return std::memcmp(a.v.data(), b.v.data(), sizeof a.v) == 0;
}

void expect_back(const std::vector<LeafPrimitive>& given) {
  const LeafPrimitives stored(given);
  ASSERT_EQ(stored.size(), given.size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const auto corners = stored.corners(i);
    LeafPrimitive by_corners{};
    for (std::size_t k = 0; k < 9; ++k) by_corners.v[k] = corners[k / 3][k % 3];
    wrong += same_bits(stored[i], given[i]) && same_bits(by_corners, given[i]) ? 0 : 1;
  }
  EXPECT_EQ(wrong, 0u);
}

/// Two triangles to a square of a grid.
std::vector<LeafPrimitive> grid(std::size_t columns, std::size_t rows) {
  std::vector<LeafPrimitive> out;
  for (std::size_t y = 0; y < rows; ++y)
    for (std::size_t x = 0; x < columns; ++x) {
      const auto at = [](std::size_t i) { return 0.1 * static_cast<double>(i); };
      const double x0 = at(x), x1 = at(x + 1), y0 = at(y), y1 = at(y + 1);
      out.push_back({{x0, y0, 1.0, x1, y0, 1.0, x0, y1, 1.0}});
      out.push_back({{x1, y0, 1.0, x1, y1, 1.0, x0, y1, 1.0}});
    }
  return out;
}

TEST(LeafPrimitives, ComeBackToTheLastBit) {
  expect_back({});
  expect_back({{{0.0, -0.0, 0.0, -0.0, 0.0, 0.0, 0.0, 0.0, -0.0}}});  // three corners: zeros have signs
  expect_back(grid(64, 64));
  test::Random random(3);
  for (const std::size_t count : {4095u, 4096u, 4097u, 20000u}) {  // around a group, and several
    std::vector<LeafPrimitive> soup(count);
    std::vector<Vec3> few;
    for (int i = 0; i < 500; ++i) few.push_back(random.in_box(1.0));
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 corner = i % 2 == 0 ? random.in_box(1.0) : few[random.below(500)];
        for (std::size_t a = 0; a < 3; ++a) soup[i].v[3 * k + a] = corner[static_cast<int>(a)];
      }
    expect_back(soup);
  }
}

/// A square of the grid has a corner of its own and two triangles: 24 and 2 * 6 bytes, and more along the edges of a
/// group of leaves. A soup shares nothing.
TEST(LeafPrimitives, SharedCornersAreStoredOnce) {
  const std::vector<LeafPrimitive> shared = grid(256, 256);
  const double per_triangle = static_cast<double>(LeafPrimitives(shared).bytes()) / 131072.0;
  EXPECT_GT(per_triangle, 18.0);
  EXPECT_LT(per_triangle, 21.0);
  std::vector<LeafPrimitive> soup(9000);
  test::Random random(4);
  for (LeafPrimitive& p : soup)
    for (double& v : p.v) v = random.uniform(-1.0, 1.0);
  EXPECT_NEAR(static_cast<double>(LeafPrimitives(soup).bytes()) / 9000.0, 78.0, 0.01);
}

TEST(LeafPrimitives, OfAHierarchyAreTheWorlds) {
  Scene scene = test::scene_of(
      {test::uv_sphere(Vec3(0.0), 1.0, 60, 90, 0.0, 1), test::triangle_soup(3000, 2.0, 0.5, 2)});
  scene.shapes.push_back({"ball", Sphere{Vec3(0.3, 1.2, -0.2), 0.7}, 0});
  scene.shapes.push_back({"ring", Torus{}, 0});
  const test::TestWorld w(scene);
  const raytrace::Bvh bvh = raytrace::build_bvh(w.world());
  ASSERT_GT(bvh.ids.size(), 10000u);
  std::size_t wrong = 0;
  for (std::uint32_t i = 0; i < bvh.ids.size(); ++i)
    wrong += same_bits(bvh.primitive_at(i), raytrace::leaf_primitive(w.world(), bvh.ids[i])) ? 0 : 1;
  EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace gnomon
