// What lies beyond a side of what a clip matrix shows covers no pixel: no point of a box that is left out is within, and
// most boxes that lie outside are left out.
#include "raster/world/triangle_runs.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>

namespace gnomon::test {
namespace {

struct Random {
  std::mt19937_64 engine{3};
  double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(engine); }
  Vec3 in_box(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
};

bool is_shown(const Mat4& matrix, const Vec3& relative) {
  const Vec4 clip = matrix * Vec4(relative, 1.0);
  return clip.w > 0.0 && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w;
}

Mat4 seen_from(Random& random, bool perspective) {
  const Vec3 eye = random.in_box(2.0), target = random.in_box(2.0);
  const Mat4 view = glm::lookAt(eye, target, random.in_box(1.0));
  const double width = random.uniform(0.3, 2.0);
  return (perspective ? glm::perspective(width, 1.5, 0.1, 50.0) : glm::ortho(-width, width, -0.5, 0.7)) *
         view;
}

TEST(ClipSides, LeaveOutNothingThatIsShown) {
  Random random;
  int outside = 0, left_out = 0;
  for (int i = 0; i < 4000; ++i) {
    const Mat4 matrix = seen_from(random, i % 2 == 0);
    const Vec3 reference = random.in_box(1e6);
    Aabb box;
    const Vec3 middle = random.in_box(5.0);
    for (int k = 0; k < 2; ++k) box.grow(reference + middle + random.in_box(random.uniform(0.01, 1.5)));
    const bool is_left_out = raster::ClipSides(matrix, reference).surely_outside(box);
    bool any_shown = false;
    for (int k = 0; k < 200; ++k) {
      Vec3 p;
      for (int a = 0; a < 3; ++a) p[a] = random.uniform(box.min[a], box.max[a]) - reference[a];
      any_shown = any_shown || is_shown(matrix, p);
    }
    EXPECT_FALSE(is_left_out && any_shown) << i;
    outside += any_shown ? 0 : 1, left_out += is_left_out ? 1 : 0;
  }
  EXPECT_GT(left_out, 0.9 * outside);  // the others cross the planes of two sides, outside of both
}

// A box of no thickness that touches a side: its floats may lie on either side.
TEST(ClipSides, KeepWhatFloatsCannotTell) {
  const raster::ClipSides sides(glm::ortho(-1.0, 1.0, -1.0, 1.0), Vec3(0.0));
  const auto slab = [](double x) { return Aabb{{x, -0.5, -0.5}, {x, 0.5, 0.5}}; };
  EXPECT_FALSE(sides.surely_outside(slab(1.0)));
  EXPECT_FALSE(sides.surely_outside(slab(1.0 + 0x1p-23)));
  EXPECT_FALSE(sides.surely_outside(slab(-1.0 - 0x1p-23)));
  EXPECT_TRUE(sides.surely_outside(slab(1.00001)));
  EXPECT_TRUE(sides.surely_outside(slab(-1.00001)));
}

}  // namespace
}  // namespace gnomon::test
