// Rays in a triangle's plane, to the last bit or but for rounding (hard case 4).
#include <gtest/gtest.h>

#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using raytrace::Accel;
using raytrace::Hit;
using raytrace::Tracer;
using test::Random;
using test::TestWorld;

TEST(EdgeOn, Case4CoplanarRayMisses) {
  const TestWorld w(test::scene_of({test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}));
  for (const Accel accel : {Accel::bvh, Accel::brute}) {
    const Tracer tracer(w.world(), accel);
    EXPECT_FALSE(tracer.closest_hit({{-1.0, 0.5, 0.0}, {1.0, 0.0, 0.0}}));
    EXPECT_FALSE(tracer.occluded({{-1.0, -1.0, 0.0}, {1.0, 1.0, 0.0}}));
    EXPECT_TRUE(tracer.occluded({{0.5, 0.5, -1.0}, {0.0, 0.0, 1.0}}));
  }
}

// Rays along an edge: one that is parallel to the triangle to the last bit misses it; one whose direction is rounded
// may hit it, but nowhere else than on that edge.
TEST(EdgeOn, Case4RayAlongAnEdgeHitsNothingElse) {
  Random random(4);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    Mesh mesh;
    mesh.positions = {random.in_box(4.0), random.in_box(4.0), random.in_box(4.0)};
    mesh.triangles = {{0, 1, 2}};
    const TestWorld w(test::scene_of({mesh}));
    const Tracer tracer(w.world(), Accel::brute);
    const Vec3 p = mesh.positions[0], along = mesh.positions[1] - p;  // exact: multiples of 2^-50
    EXPECT_FALSE(tracer.closest_hit({p - 3.0 * along, along})) << i;
    const std::optional<Hit> hit = tracer.closest_hit({p - 3.0 * along, along / 3.0});
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(hit->t, 10.5, 1.5 + 1e-9) << i;
  }
  EXPECT_GT(hits, 100);
}

}  // namespace
}  // namespace gnomon
