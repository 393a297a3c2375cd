// The rectangle around a shape holds every ray that meets it, and little else.
#include <random>

#include "raster/world/shape_bounds.h"
#include "tests/support/raster_reference.h"

#include <gtest/gtest.h>

namespace gnomon::test {
namespace {

using raster::Projection;

Projection camera_projection() {
  return {
      Vec3(0.3, -0.2, 0.1), {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1)}, Vec2(1.0, 0.7), true, Vec2(0.01)};
}

/// Whether the ray through a clip position meets the shape ahead of the origin.
bool meets(const Projection& p, const Shape& shape, const Vec2& clip) {
  const Vec2 at = clip * p.half_extent;
  const Vec3 sideways = at.x * p.frame.right + at.y * p.frame.up;
  const Ray ray = p.perspective ? Ray{p.origin, p.frame.forward + sideways, {0.0, infinity}}
                                : Ray{p.origin + sideways, p.frame.forward, {-infinity, infinity}};
  const double t = hit_shape(ray, shape);
  return t >= ray.t.min && t < infinity;
}

void expect_tight(const Projection& p, const Shape& shape, bool tight) {
  const auto bounds = raster::shape_bounds(p, shape);
  Vec2 low(infinity), high(-infinity);
  constexpr int steps = 200;
  for (int j = 0; j <= steps; ++j) {
    for (int i = 0; i <= steps; ++i) {
      const Vec2 clip(-1.0 + 2.0 * i / steps, -1.0 + 2.0 * j / steps);
      if (!meets(p, shape, clip)) continue;
      low = glm::min(low, clip), high = glm::max(high, clip);
      ASSERT_TRUE(bounds.has_value());
      ASSERT_TRUE(clip.x >= bounds->min.x && clip.x <= bounds->max.x && clip.y >= bounds->min.y &&
                  clip.y <= bounds->max.y);
    }
  }
  const bool whole =
      bounds && glm::all(glm::lessThan(glm::max(glm::abs(bounds->min), glm::abs(bounds->max)), Vec2(0.99)));
  if (!tight || !whole || !(low.x <= high.x)) return;
  const Vec2 slack(0.01 + 4.0 / steps);
  EXPECT_TRUE(glm::all(glm::lessThan(glm::abs(low - bounds->min), slack)));
  EXPECT_TRUE(glm::all(glm::lessThan(glm::abs(high - bounds->max), slack)));
}

TEST(ShapeBounds, HoldSpheresBeforeBesideBehindAndAround) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-6.0, 6.0), radius(0.05, 3.0);
  for (int i = 0; i < 60; ++i) {
    const Shape ball{"ball", Sphere{Vec3{place(random), place(random), place(random)}, radius(random)}, 0};
    Projection p = camera_projection();
    expect_tight(p, ball, false);
    p.perspective = false;
    expect_tight(p, ball, true);
  }
  expect_tight(camera_projection(), {"ahead", Sphere{Vec3(0.5, 0.4, -5.0), 1.0}, 0}, true);
}

TEST(ShapeBounds, EndAPlaneAtItsHorizon) {
  const Shape floor{"floor", Plane{Vec3(0.0, -1.0, 0.0), Vec3(0.0, 1.0, 0.0)}, 0};
  const auto bounds = raster::shape_bounds(camera_projection(), floor);
  ASSERT_TRUE(bounds.has_value());
  EXPECT_NEAR(bounds->max.y, 0.01, 1e-12);
  EXPECT_EQ(bounds->min.y, -1.0);
  expect_tight(camera_projection(), floor, true);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int i = 0; i < 30; ++i) {
    const Vec3 normal = glm::normalize(Vec3{any(random), any(random), any(random)});
    expect_tight(camera_projection(),
                 {"plane", Plane{Vec3{any(random), any(random), any(random)}, normal}, 0}, false);
  }
}

TEST(ShapeBounds, LeaveOutWhatIsBehind) {
  EXPECT_FALSE(
      raster::shape_bounds(camera_projection(), {"behind", Sphere{Vec3(0, 0, 5), 1.0}, 0}).has_value());
  EXPECT_FALSE(
      raster::shape_bounds(camera_projection(), {"beside", Sphere{Vec3(20, 0, -5), 1.0}, 0}).has_value());
  const Shape wall{"wall", Plane{Vec3(0, 0, 5), Vec3(0, 0, 1)}, 0};
  EXPECT_FALSE(raster::shape_bounds(camera_projection(), wall).has_value());
}

}  // namespace
}  // namespace gnomon::test
