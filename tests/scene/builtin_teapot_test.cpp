// Newell's patches against what is known of them: their number, their extent, how they join, their symmetry.
#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "scene/generate/generate.h"
#include "scene/generate/teapot_patches.h"
#include "tests/scene/mesh_checks.h"

namespace gnomon {
namespace {

using teapot::Patch;
using teapot::Piece;

struct LessByCoordinates {
  bool operator()(const Vec3& a, const Vec3& b) const {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  }
};

TEST(TeapotPatches, NumberAndControlPoints) {
  const auto all = teapot::patches();
  ASSERT_EQ(all.size(), 32u);
  std::set<Vec3, LessByCoordinates> points;
  for (const auto& p : all) {
    for (const auto& row : p.patch) points.insert(row.begin(), row.end());
  }
  // Newell's table has 306 rows. Four are his 0.002-wide crack-stoppers at the knob's top, and the bottom's
  // rim repeats the body's 12 points.
  EXPECT_EQ(points.size(), 306u - 4u - 12u);
  // A few rows of the published table.
  for (const Vec3& known : {Vec3(1.4, 0.0, 2.4), Vec3(-0.749, -1.3375, 2.53125), Vec3(3.525, -0.25, 2.49375),
                            Vec3(-2.65, 0.3, 0.9375), Vec3(0.45, -0.8, 3.15), Vec3(1.425, -0.798, 0.0)}) {
    const bool found = std::any_of(points.begin(), points.end(),
                                   [&](const Vec3& p) { return glm::length(p - known) < 1e-12; });
    EXPECT_TRUE(found) << known.x << ' ' << known.y << ' ' << known.z;
  }
}

TEST(TeapotPatches, NeighboursShareTheirEdgesBitForBit) {
  // Every point of a patch's border at i/8 occurs again on another patch, except along the teapot's true
  // rims.
  constexpr int n = 8;
  std::map<Vec3, int, LessByCoordinates> seen;
  for (const auto& p : teapot::patches()) {
    std::set<Vec3, LessByCoordinates> border;
    for (int i = 0; i <= n; ++i) {
      const double t = static_cast<double>(i) / n, s = static_cast<double>(n - i) / n;
      for (const double e : {0.0, 1.0}) {
        border.insert(teapot::evaluate(p.patch, e, 1.0 - e, t, s));
        border.insert(teapot::evaluate(p.patch, t, s, e, 1.0 - e));
      }
    }
    for (const Vec3& v : border) ++seen[v];
  }
  std::size_t alone = 0;
  for (const auto& [point, count] : seen) alone += count == 1;
  // Rims: the body's inner rim and the lid's edge, 4 patches each; both ends of handle and spout, 2 patches
  // each. Inside each patch's rim lie n - 1 points that only it has.
  EXPECT_EQ(alone, (2u * 4u + 4u * 2u) * (n - 1u));
}

TEST(TeapotPatches, IsSymmetricInItsMiddlePlane) {
  std::set<Vec3, LessByCoordinates> points;
  for (const auto& p : teapot::patches()) {
    for (const auto& row : p.patch) points.insert(row.begin(), row.end());
  }
  for (const Vec3& p : points) EXPECT_TRUE(points.contains(Vec3(p.x, p.y == 0.0 ? 0.0 : -p.y, p.z)));
}

TEST(TeapotPatches, NormalsAreTheLimitOfSecants) {
  for (const auto& p : teapot::patches()) {
    for (const double u : {0.3, 0.7}) {
      for (const double v : {0.2, 0.6}) {
        const double h = 1e-5;
        const auto at = [&](double a, double b) { return teapot::evaluate(p.patch, a, 1.0 - a, b, 1.0 - b); };
        const Vec3 n = glm::normalize(glm::cross(at(u, v + h) - at(u, v - h), at(u + h, v) - at(u - h, v)));
        EXPECT_NEAR(glm::dot(n, teapot::normal(p.patch, u, v)), 1.0, 1e-7);
      }
    }
  }
}

Mesh whole(double height, double divisions) {
  Mesh all;
  const GeneratedModel model = *generate("teapot", {{"height", height}, {"divisions", divisions}});
  for (const GeneratedPart& p : model.parts) {
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), p.mesh.positions.begin(), p.mesh.positions.end());
    for (const auto& t : p.mesh.triangles)
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return all;
}

TEST(Teapot, EveryPieceIsWoundOutwards) {
  // The pieces are open only where a plane would close them; seen from a point of that plane, the missing
  // disc has no volume.
  const GeneratedModel model = *generate("teapot", {{"height", 3.15}});
  constexpr std::array<Vec3, 4> seen_from{Vec3(0, 2.4, 0), Vec3(0, 2.4, 0), Vec3(-2.0, 1.4, 0),
                                          Vec3(1.7, 1.0, 0)};
  for (std::size_t i = 0; i < 4; ++i) {
    Mesh mesh = model.parts[i].mesh;
    for (Vec3& p : mesh.positions) p -= seen_from[i];
    EXPECT_GT(test::inspect(mesh).volume, 0.05) << model.parts[i].name;
  }
}

TEST(Teapot, HasItsKnownExtent) {
  const test::MeshReport r = test::inspect(whole(3.15, 64.0));
  // Knob and foot are interpolated; the body's widest ring and the handle's back are maxima of cubics: 2 at
  // the belly's joint, 3 at the handle's joint, the spout's lip at 3.4353 by its section cubic's maximum.
  EXPECT_NEAR(r.bounds.min.y, 0.0, 1e-12);
  EXPECT_NEAR(r.bounds.max.y, 3.15, 1e-12);
  EXPECT_NEAR(r.bounds.min.x, -3.0, 1e-9);
  EXPECT_NEAR(r.bounds.max.x, 3.434, 2e-3);
  EXPECT_NEAR(r.bounds.max.z, 2.0, 1e-9);
  EXPECT_NEAR(r.bounds.min.z, -2.0, 1e-9);
}

TEST(Teapot, TriangleCountAndCollapsedRows) {
  // 32 patches of 2 n^2 triangles, less the collapsed triangles: one row of n in each of the 4 lid and 4
  // bottom patches.
  for (const double n : {2.0, 4.0, 20.0}) {
    EXPECT_EQ(whole(0.3, n).triangles.size(), static_cast<std::size_t>(64.0 * n * n - 8.0 * n)) << n;
  }
}

TEST(Teapot, BodyHasTheVolumeOfItsProfile) {
  // Body and bottom are nearly a solid of revolution up to the rim: pi times the integral of r^2 dz along the
  // profile, by Simpson's rule on the cubics; Newell's quarter arcs bulge from a true circle by up to 0.9 %
  // in radius.
  const GeneratedModel m = *generate("teapot", {{"height", 3.15}, {"divisions", 48.0}});
  const double volume = test::inspect(m.parts[0].mesh).volume;
  double expected = 0.0;
  for (const auto& p : teapot::patches()) {
    if (p.piece != Piece::body) continue;
    constexpr int n = 400;
    for (int i = 0; i < n; ++i) {
      const auto at = [&](double u) { return teapot::evaluate(p.patch, u, 1.0 - u, 0.0, 1.0); };
      const Vec3 a = at(static_cast<double>(i) / n), b = at((i + 1.0) / n);
      const double ra = glm::length(Vec2(a)), rb = glm::length(Vec2(b));
      expected += 0.25 * pi * (a.z - b.z) * (ra * ra + ra * rb + rb * rb) / 3.0;
    }
  }
  // The open mouth at height 2.4: the divergence theorem's missing disc, radius 1.4, seen from the origin.
  const double mouth = 2.4 * pi * 1.4 * 1.4 / 3.0;
  EXPECT_NEAR(volume + mouth, expected, 0.02 * expected);
  EXPECT_GT(volume, 0.0);
}

}  // namespace
}  // namespace gnomon
