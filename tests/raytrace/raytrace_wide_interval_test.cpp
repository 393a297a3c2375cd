// The wide tree's rays by the part of them that counts: intervals that begin or end next to a hit, and intervals that
// are empty, the wrong way round or not numbers, which floats can tell from a hit's place no better than doubles can.
#include <gtest/gtest.h>

#include <limits>

#include "raytrace/packets/edge_setup.h"
#include "raytrace/tracer.h"
#include "tests/support/every_target.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using namespace raytrace;  // NOLINT(google-build-using-namespace): every second word here is from that room
using test::for_each_target;
using test::Random;
using test::TestWorld;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Around and beside t, from the last place to a thousandth.
std::vector<Interval> intervals_around(double t) {
  std::vector<Interval> all{{0.0, t},   {t, infinity},       {t, t}, {0.0, nan}, {nan, infinity},
                            {nan, nan}, {infinity, infinity}};
  for (const double part : {0x1p-52, 0x1p-40, 0x1p-30, 0x1p-24, 0x1p-23, 0x1p-20, 0x1p-10}) {
    const double below = t * (1.0 - part), above = t * (1.0 + part);
    for (const Interval& i : {Interval{below, above}, Interval{above, below}, Interval{0.0, below},
                              Interval{0.0, above}, Interval{below, infinity}, Interval{above, infinity}})
      all.push_back(i);
  }
  return all;
}

void expect_same_in_intervals(Scene scene, double direction_size) {
  const TestWorld w(std::move(scene));
  const Tracer brute(w.world(), Accel::brute), tracer(w.world(), Accel::bvh);
  prepare_single_rays(tracer);
  for_each_target([&] {
    Random random(41);
    std::size_t tried = 0, wrong = 0;
    for (int n = 0; n < 100; ++n) {
      const Vec3 from = random.in_box(4.0), direction = glm::normalize(random.in_box(0.7) - from);
      Ray ray{from, direction_size * direction};
      const auto hit = brute.closest_hit(ray);
      if (!hit) continue;
      for (const Interval& t : intervals_around(hit->t)) {
        ray.t = t, ++tried;
        const auto truth = brute.closest_hit(ray), found = tracer.closest_hit(ray);
        const bool same = truth.has_value() == found.has_value() &&
                          (!truth || (truth->t == found->t && truth->primitive == found->primitive));
        wrong += same && tracer.occluded(ray) == truth.has_value() ? 0 : 1;
      }
    }
    EXPECT_GT(tried, 2000u) << packet_target();
    EXPECT_EQ(wrong, 0u) << packet_target();
  });
}

TEST(Wide, IntervalsAroundAHit) {
  for (const double size : {1.0, 0.3, 1e-6, 1e9})
    expect_same_in_intervals(test::scene_of({test::uv_sphere(Vec3(0.0), 1.0, 24, 32, 0.1, 42)}), size);
}

TEST(Wide, IntervalsAroundAHitWithAPlane) {
  expect_same_in_intervals(test::scene_of({test::uv_sphere(Vec3(0.0), 1.0, 24, 32, 0.1, 42)},
                                          {test::plane(Vec3(0.0, -0.2, 0.0), Vec3(0.0, 1.0, 0.0))}),
                           1.0);
}

}  // namespace
}  // namespace gnomon
