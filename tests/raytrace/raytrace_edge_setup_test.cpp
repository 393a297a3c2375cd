// The packets' numbers of triangles against the same formulas in long double, at scales that floats can square and at
// scales that they cannot, for every instruction set that this machine has.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "raytrace/packets/edge_setup_rows.h"
#include "tests/support/every_target.h"

namespace gnomon {
namespace {

using raytrace::EdgeSetupPass;
using raytrace::EdgeSetupRows;
using raytrace::PlacedCorners;
using Real = long double;
using Real3 = std::array<Real, 3>;
constexpr std::size_t together = EdgeSetupRows::together;

Real3 minus(const Real3& a, const Real3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Real3 cross(const Real3& a, const Real3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Real length(const Real3& a) {
  return std::hypot(a[0], a[1], a[2]);
}

/// Corners within `scale` of the axis, and once to twice that away.
std::array<PlacedCorners, together> random_triangles(double scale, std::mt19937& random) {
  std::uniform_real_distribution<double> across(-scale, scale), depth(scale, 2.0 * scale);
  std::array<PlacedCorners, together> triangles{};
  for (PlacedCorners& t : triangles)
    for (auto& corner : t.corner)
      for (std::size_t a = 0; a < 3; ++a) corner[a] = a == 2 ? depth(random) : across(random);
  return triangles;
}

struct Sides {
  std::array<Real3, 3> corner, edge;  ///< edge k is opposite to corner k
  Real extent, farthest;
};
Sides sides_of(const PlacedCorners& triangle) {
  Sides s{};
  for (std::size_t k = 0; k < 9; ++k) s.corner[k / 3][k % 3] = triangle.corner[k / 3][k % 3];
  for (std::size_t k = 0; k < 3; ++k) {
    s.edge[k] = minus(s.corner[(k + 2) % 3], s.corner[(k + 1) % 3]);
    s.extent = std::max(s.extent, length(s.edge[k])), s.farthest = std::max(s.farthest, length(s.corner[k]));
  }
  return s;
}

/// No less than what the bounds say, and not much more.
void expect_just_above(float got, Real least, double scale) {
  EXPECT_GE(static_cast<Real>(got), least) << "scale " << scale;
  EXPECT_LE(static_cast<Real>(got), least * (1.0L + 0x1p-17L)) << "scale " << scale;
}
/// Edge functions are of unit length across the ray: their rounding's bound counts on it.
void expect_unit_edges(const EdgeSetupRows& rows, std::size_t i, std::size_t components, double scale) {
  for (std::size_t k = 0; k < 3; ++k) {
    Real square = 0.0L;
    for (std::size_t a = 0; a < components; ++a) {
      const auto number = static_cast<Real>(rows.out[3 * k + a][i]);
      square += number * number;
    }
    EXPECT_NEAR(static_cast<double>(std::sqrt(square)), 1.0, 0x1p-20) << "scale " << scale;
  }
}

/// Rays from the origin, or along z, over eight random triangles at every scale and for every instruction set:
/// check(pass, rows, i, the i-th triangle's sides, scale).
template <class Check>
void for_each_triangle(bool directional, const Check& check) {
  std::mt19937 random(41);
  const auto check_scale = [&](double scale) {
    const std::array<PlacedCorners, together> triangles = random_triangles(scale, random);
    std::array<raytrace::CornerPointers, together> pointers;
    for (std::size_t i = 0; i < together; ++i)
      for (std::size_t k = 0; k < 3; ++k) pointers[i][k] = triangles[i].corner[k].data();
    EdgeSetupRows rows;
    EdgeSetupPass pass;
    pass.directional = directional;
    pass.axes[0] = Vec3(1, 0, 0), pass.axes[1] = Vec3(0, 1, 0), pass.axes[2] = Vec3(0, 0, 1);
    pass.largest = 2.0 * scale, pass.radius = 2.0 * scale, pass.farthest = 4.0 * scale;
    raytrace::set_up_eight_triangles(pointers, pass, rows);
    for (std::size_t i = 0; i < together; ++i) check(pass, rows, i, sides_of(triangles[i]), scale);
  };
  test::for_each_target([&] {
    for (const int exponent : {-85, -61, -40, -10, 0, 10, 40, 61, 85}) check_scale(std::ldexp(1.0, exponent));
  });
}

TEST(EdgeSetup, FromAPoint) {
  for_each_triangle(false, [](const EdgeSetupPass& pass, const EdgeSetupRows& rows, std::size_t i,
                              const Sides& s, double scale) {
    expect_unit_edges(rows, i, 3, scale);
    Real shortest = HUGE_VALL;
    for (std::size_t k = 0; k < 3; ++k)
      shortest = std::min(shortest, length(cross(s.corner[(k + 1) % 3], s.edge[k])));
    const Real m = pass.largest;
    expect_just_above(rows.out[12][i], 0x1p-20L + 0x1p-39L * m * s.farthest / shortest, scale);
    const Real3 normal = cross(s.edge[1], s.edge[2]);
    const Real size =
        std::abs(normal[0] * s.corner[0][0] + normal[1] * s.corner[0][1] + normal[2] * s.corner[0][2]);
    const Real steep = length(normal) / size;
    expect_just_above(
        rows.out[13][i],
        steep * (0x1p-19L + 0x1p-35L * m * s.farthest * s.extent / size) + 0x1p-40L * m * steep * steep,
        scale);
  });
}

TEST(EdgeSetup, AlongADirection) {
  for_each_triangle(true, [](const EdgeSetupPass& pass, const EdgeSetupRows& rows, std::size_t i,
                             const Sides& s, double scale) {
    expect_unit_edges(rows, i, 2, scale);
    Real shortest = HUGE_VALL;
    for (const Real3& e : s.edge) shortest = std::min(shortest, std::hypot(e[0], e[1]));
    const Real kernel = 0x1p-39L * pass.largest * pass.farthest;
    expect_just_above(rows.out[12][i], 0x1p-20L * pass.radius + kernel / shortest, scale);
  });
}

}  // namespace
}  // namespace gnomon
