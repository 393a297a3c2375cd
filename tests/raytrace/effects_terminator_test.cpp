// The smooth body above a mesh's facets: Hanika's places against a closed form, and pictures of a coarse sphere against
// the sphere itself.
#include <gtest/gtest.h>

#include "raytrace/shading/smooth_surface.h"
#include "scene/shapes/tessellate.h"
#include "tests/support/effects_support.h"

namespace gnomon {
namespace {

using raytrace::SurfacePoint;

// A circle's chord of one sector of n: in its middle the planes through its ends stand r sin^2(pi/n) above it, along normals
// that lean from the facet's own by pi/n, so that the point rises by r sin^2(pi/n) cos(pi/n).
TEST(SmoothBody, MiddleOfAChordRisesAsTheClosedFormSays) {
  for (const int n : {6, 12, 48})
    for (const double side : {1.0, -1.0}) {
      const double r = 0.7, half = pi / n;
      const double x = r * std::sin(half), y = r * std::cos(half);
      const Vec3f left(float(-std::sin(half)), float(std::cos(half)), 0.0f), right(-left.x, left.y, 0.0f);
      Mesh mesh;
      mesh.positions = {{-x, y, 0.0}, {x, y, 0.0}, {x, y, 1.0}, {-x, y, 1.0}};
      mesh.normals = {left, right, right, left};
      mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
      const test::TestWorld w(test::scene_of({mesh}, {}));
      const raytrace::Tracer tracer(w.world(), raytrace::Accel::bvh);
      const Ray down{{0.0, y + 3.0 * side, 0.5}, {0.0, -side, 0.0}, {0.0, infinity}};
      const auto hit = tracer.closest_hit(down);
      ASSERT_TRUE(hit.has_value());
      const SurfacePoint body = raytrace::on_smooth_body(w.world(), tracer.surface_point(down, *hit));
      // From the hollow side the planes lie on the point's own side already.
      const double rise = side > 0.0 ? r * std::sin(half) * std::sin(half) * std::cos(half) : 0.0;
      EXPECT_NEAR(body.position.y - y, rise, 1e-6) << n << ", side " << side;
      EXPECT_NEAR(body.normal.y, side, 1e-6);
    }
}

Scene ball_under_a_lamp() {
  Scene scene = test::scene_of({}, {test::sphere({0, 0, 0}, 1.0)});
  scene.lights = {test::sun({-1.0, -0.4, -0.3})};
  scene.camera.eye = {0.0, 0.5, 4.0}, scene.camera.target = Vec3(0.0);
  return scene;
}

struct Picture {
  int lit = 0;   ///< pixels
  int torn = 0;  ///< of the ball, black though the exact sphere is clearly lit there
  ColorImage colour;
};

Picture picture_of(const Scene& scene, bool offset, const ColorImage* exact = nullptr) {
  const test::TestWorld w(scene);
  const std::vector<std::uint32_t> lights{0};
  raytrace::RaytraceOptions options;
  options.size = {160, 160}, options.terminator_offset = offset;
  const raytrace::Tracer tracer(w.world(), raytrace::Accel::bvh);
  const auto frame = trace_frame(tracer, plan_effects(w.scene()), scene.camera, lights, options);
  Picture out{.colour = frame.color};
  for (std::size_t i = 0; i < frame.color.data.size(); ++i) {
    const bool on_ball = frame.receiver.data[i].primitive != no_id;
    out.lit += frame.color.data[i].x > 0.0f ? 1 : 0;
    if (exact != nullptr && on_ball && frame.color.data[i].x == 0.0f && exact->data[i].x > 0.05f) ++out.torn;
  }
  return out;
}

// The teeth are gone with the offset, and the border of light is the sphere's own.
TEST(TerminatorOffset, BringsTheSpheresOwnBorderOfLight) {
  const Scene ball = ball_under_a_lamp();
  const Picture exact = picture_of(ball, false);
  const Scene coarse = tessellate_shapes(ball, 12);
  const Picture facets = picture_of(coarse, false, &exact.colour),
                smooth = picture_of(coarse, true, &exact.colour);
  std::printf("  black where the sphere is lit: %d of %d pixels, with the offset %d\n", facets.torn,
              exact.lit, smooth.torn);
  EXPECT_GT(facets.torn, 100);
  EXPECT_LT(smooth.torn, facets.torn / 20);
}

// What has no normals of its own is not moved, and what has none of the effect is the same picture.
TEST(TerminatorOffset, LeavesShapesAndFlatMeshesAlone) {
  Scene scene = ball_under_a_lamp();
  scene.shapes.push_back(test::plane({0, -1, 0}, {0, 1, 0}));
  EXPECT_EQ(picture_of(scene, true).colour.data, picture_of(scene, false).colour.data);
}

}  // namespace
}  // namespace gnomon
