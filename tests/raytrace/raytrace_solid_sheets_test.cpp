// Quadrics, tori and implicit surfaces as sheets, and as bodies: the test by odd
// crossings.
#include <gtest/gtest.h>

#include "raytrace/shapes/along_ray.h"
#include "raytrace/shapes/inside.h"
#include "raytrace/shapes/solid.h"
#include "raytrace/sheets/column_sheets.h"
#include "tests/support/raytrace_support.h"
#include "tests/support/solid_samples.h"

namespace gnomon {
namespace {

using namespace raytrace;  // NOLINT(google-build-using-namespace): every second word here is from that room
using test::frame_of_ray;
using test::Random;
using test::TestWorld;

TEST(SolidSheets, PiecesOfATorusAreToldApart) {
  const Shape torus = test::solid("torus", Torus{ShapeFrame{}, 0.7, 0.25});
  const Vec3 along(1.0, 0.0, 0.0);
  const auto crossings = [&](double y, double z) {
    return solid_crossings(frame_of_ray({{-4.0, y, z}, along}), torus.geometry);
  };
  Random random(83);
  int apart = 0, joined = 0, pairs = 0;
  for (int i = 0; i < 500; ++i) {
    const double y = random.uniform(-0.3, 0.3), z = random.uniform(-0.15, 0.15);
    const double y2 = y + random.uniform(-0.02, 0.02), z2 = z + random.uniform(-0.02, 0.02);
    const auto a = crossings(y, z), b = crossings(y2, z2);
    if (a.size() != 4 || b.size() != 4) continue;
    ++pairs;
    const auto point = [&](double t, double py, double pz) { return Vec3(-4.0 + 0.5 * t, py, pz); };
    joined += hang_together(torus.geometry, point(a[0], y, z), point(b[0], y2, z2), along, along) ? 1 : 0;
    for (std::size_t k = 1; k < 4; ++k)
      apart += hang_together(torus.geometry, point(a[0], y, z), point(b[k], y2, z2), along, along) ? 0 : 1;
  }
  EXPECT_GT(pairs, 300);
  EXPECT_EQ(apart, 3 * pairs);
  EXPECT_GE(joined, pairs * 95 / 100);
}

TEST(Inside, OddCrossingsAgreeWithTheBodies) {
  Random random(80);
  for (const Shape& shape : test::solid_samples()) {
    const TestWorld w(test::scene_of({}, {shape}));
    const InsideTest inside(w.world());
    ASSERT_EQ(inside.is_closed(0), is_closed(shape.geometry)) << shape.name;
    if (!inside.is_closed(0)) {
      EXPECT_FALSE(inside.contains(0, Vec3(0.0)));
      continue;
    }
    int wrong = 0, within = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p = random.in_box(1.0);
      const RayFrame ray = frame_of_ray({p, random.direction()});
      std::size_t ahead = 0;
      for (const double t : solid_crossings(ray, shape.geometry)) ahead += t > 0.0 ? 1 : 0;
      within += inside.contains(0, p) ? 1 : 0;
      wrong += (ahead % 2 == 1) != inside.contains(0, p) ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0) << shape.name;
    EXPECT_GT(within, 20) << shape.name;
  }
}

TEST(Inside, MeshesByOddCrossings) {
  const TestWorld w(
      test::scene_of({test::box({-1, -1, -1}, {1, 1, 1}), test::uv_sphere({0.5, 0, 0}, 1.0, 16, 16, 0.0, 3),
                      test::quad({-5, -2, -5}, {10, 0, 0}, {0, 0, 10})},
                     {test::sphere({0, 0, 0}, 0.5), test::plane({0, -3, 0}, {0, 1, 0})}));
  const InsideTest inside(w.world());
  const bool closed[] = {true, true, false, true, false};
  for (std::uint32_t object = 0; object < 5; ++object) EXPECT_EQ(inside.is_closed(object), closed[object]);
  Random random(81);
  int wrong = 0;
  for (int i = 0; i < 3000; ++i) {
    // Half of them on a grid, where rays along the axes would run through edges and corners.
    Vec3 p = random.in_box(2.0);
    if (i % 2 == 0) p = glm::round(4.0 * p) * 0.25 + Vec3(1e-9);
    const double far = glm::length(p - Vec3(0.5, 0, 0));
    if (std::abs(far - 1.0) < 0.03) continue;  // between the mesh and the sphere that it stands for
    const double most = max_component(glm::abs(p));
    wrong += inside.contains(0, p) != (most < 1.0) ? 1 : 0;
    wrong += inside.contains(1, p) != (far < 1.0) ? 1 : 0;
    wrong += inside.contains(2, p) ? 1 : 0;
  }
  EXPECT_EQ(wrong, 0);
  for (std::uint32_t object = 0; object < 5; ++object)
    EXPECT_EQ(inside.contains(object, {0.4, 0.1, 0.1}), closed[object]);
}

}  // namespace
}  // namespace gnomon
