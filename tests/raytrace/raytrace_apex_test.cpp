// Shadow rays that pass a cone's apex closely, where the cone's function and its slope are both 0.
#include <gtest/gtest.h>

#include "raytrace/shapes/along_ray.h"
#include "tests/support/raytrace_support.h"
#include "tests/support/solid_samples.h"
#include "verify/quad.h"

namespace gnomon {
namespace {

using raytrace::PointVisibility;
using raytrace::SurfacePoint;
using raytrace::Tracer;
using test::Random;

constexpr double cone_radius = 0.5, cone_height = 2.0;

// A cone that points upwards somehow, over a floor that it does not touch.
ShapeFrame some_frame(Random& random) {
  const Vec3 d = random.direction();
  return frame_along({0.0, 3.0, 0.0}, glm::normalize(Vec3(d.x, 1.0 + std::abs(d.y), d.z)));
}

// From there the apex is seen more across the axis than the cone's sides run.
Vec3 floor_point_across(const Vec3& apex, const Vec3& axis, Random& random) {
  for (;;) {
    const Vec3 p{random.uniform(-5.0, 5.0), 0.0, random.uniform(-5.0, 5.0)};
    if (std::abs(glm::dot(glm::normalize(apex - p), axis)) < 0.8) return p;
  }
}

// The verdict on the way from a floor point through a place below the apex, and `aside` of the axis, to a light as far
// beyond. Twice as far aside as below is outside the cone, and the whole way is.
PointVisibility past_the_apex(double below, double aside, Random& random) {
  const ShapeFrame frame = some_frame(random);
  const Shape cone{"cone", make_cone(frame, cone_radius, 0.0, cone_height, true)};
  const test::TestWorld w(test::scene_of({}, {cone, test::plane({0, 0, 0}, {0, 1, 0})}));
  const Tracer tracer(w.world(), raytrace::Accel::bvh);
  const Vec3 axis = frame.axes[2], apex = frame.origin + cone_height * axis;
  const Vec3 place = floor_point_across(apex, axis, random);
  const Ray down{place + Vec3(0.0, 0.1, 0.0), {0.0, -1.0, 0.0}};
  const SurfacePoint p = tracer.surface_point(down, tracer.closest_hit(down).value());
  const Vec3 side = glm::normalize(glm::cross(axis, apex - p.position));
  const Vec3 through = apex - below * axis + aside * side;
  return tracer.centre_visibility(p, test::point_light(p.position + 2.0 * (through - p.position)));
}

TEST(Apex, RaysThatPassItByAMillionthAreSure) {
  Random random(23);
  for (const double gap : {1e-2, 1e-4, 1e-6})
    for (int i = 0; i < 300; ++i) {
      EXPECT_EQ(past_the_apex(gap, 2.0 * gap, random), PointVisibility::lit) << gap;
      EXPECT_EQ(past_the_apex(gap, 0.0, random), PointVisibility::shadowed) << gap;
    }
}

double exactly(const raytrace::AlongRay& f, double s) {
  const auto on = [&](int a) { return verify::Quad(f.origin[a]) + verify::Quad(s) * f.direction[a]; };
  return static_cast<double>(test::quad_value(*f.solid, on(0), on(1), on(2)));
}

// On a line that passes the apex at a millionth, bounds over a stretch shrink with the slope there, and hold all values.
TEST(Apex, BoundsSeeTermsCancel) {
  const Shape cone{"cone", make_cone(frame_along(Vec3(0.0), {0, 0, 1}), 0.5, 0.0, 2.0, true)};
  const raytrace::AlongRay f{&cone.geometry, {-1.0, 1e-6, 1.25}, glm::normalize(Vec3(1.0, 0.0, 0.75))};
  for (const double away : {1e-1, 1e-3, 1e-5}) {
    const double at = 1.25 - away, end = at + 0.1 * away;
    const raytrace::Bounds stretch(at, end), middle(0.5 * (at + end));
    const raytrace::Slope h = f.bounds(stretch);
    const raytrace::Bounds value = narrowed(h, f.bounds(middle).value, stretch - middle);
    EXPECT_GT(h.value.width(), 0.01 * away);
    EXPECT_LT(value.width(), away * away) << away;
    for (int i = 0; i <= 100; ++i) {
      const double v = exactly(f, at + 0.01 * i * (end - at));
      EXPECT_TRUE(value.lo <= v && v <= value.hi) << away << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace gnomon
