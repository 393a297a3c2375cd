// Cascades and the warped map: round trips between every pair of conventions, and the fits' promises.
#include <gtest/gtest.h>

#include "scene/camera.h"
#include "scene/generate/random.h"
#include "scene/light_map/cascade_fit.h"
#include "tests/support/small_scenes.h"

namespace gnomon {
namespace {

Scene street() {
  Scene scene = test::sunlit_scene({test::floor_mesh(20, 20), test::box_mesh({-1, 0, -1}, {1, 1.5, 0.5})},
                                   {1, -2, 0.5});
  scene.camera = {{0.5, 1.7, 12}, {0, 1.0, 0}, {0, 1, 0}, 0.8};
  return scene;
}

struct Kind {
  const char* name;
  bool warped, reversed, snap, parallel = false;
};

class Shapes : public testing::TestWithParam<Kind> {
 protected:
  Shapes() : scene_(street()), world_(make_world(scene_)) {
    if (GetParam().parallel) scene_.camera.orthographic_height = 9.0;
  }
  LightView fitted(int size) const {
    const Kind k = GetParam();
    auto view = k.warped
                    ? fit_warped(world_, scene_.lights[0], scene_.camera, 1.6, size, k.snap)
                    : fit_cascades(world_, scene_.lights[0], scene_.camera, 1.6, size, {.snap = k.snap}, {});
    EXPECT_TRUE(view.has_value());
    view->reversed = k.reversed;
    return *view;
  }
  Scene scene_;
  World world_;
};

TEST_P(Shapes, TexelRayReturnsToItsTexel) {
  const LightView view = fitted(64);
  Random random(7);
  for (int i = 0; i < 20000; ++i) {
    const int face = static_cast<int>(random.between(0, view.face_count));
    const double u = random.between(0, 64), v = random.between(0, 64);
    const TexelCoordinate t =
        project_to_face(view, face, texel_ray(view, face, u, v).at(random.between(-20, 20)));
    ASSERT_NEAR(t.u, u, 1e-9);
    ASSERT_NEAR(t.v, v, 1e-9);
    ASSERT_TRUE(t.inside);
  }
}

TEST_P(Shapes, ClipMatrixAndStoredDepthAgree) {
  const LightView view = fitted(256);
  const Vec3 reference(0.3, 0.2, -1.0);
  Random random(7);
  for (int i = 0; i < 20000; ++i) {
    const int face = static_cast<int>(random.between(0, view.face_count));
    const LightFace& f = view.face(face);
    const double u = random.between(0, 256), v = random.between(0, 256);
    const Vec3 p = texel_ray(view, face, u, v).at(random.between(f.near_depth, f.far_depth));
    const TexelCoordinate t = project_to_face(view, face, p);
    const Vec4 clip = light_clip_from_relative(view, face, reference) * Vec4(p - reference, 1.0);
    ASSERT_GT(clip.w, 0.0);
    ASSERT_NEAR(0.5 * (clip.x / clip.w + 1.0) * 256, t.u, 1e-8);
    ASSERT_NEAR(0.5 * (clip.y / clip.w + 1.0) * 256, t.v, 1e-8);
    const double stored = stored_from_depth(view, face, t.v, t.depth);
    ASSERT_NEAR(clip.z / clip.w, stored, 1e-10);
    ASSERT_GE(stored, -1e-12);
    ASSERT_LE(stored, 1.0 + 1e-12);
    ASSERT_NEAR(depth_from_stored(view, face, t.v, stored), t.depth, 1e-9);
  }
}

TEST_P(Shapes, ColumnCornersAreThoseOfTheirTexel) {
  const LightView view = fitted(32);
  Random random(7);
  for (int i = 0; i < 5000; ++i) {
    const int face = static_cast<int>(random.between(0, view.face_count));
    const double u = random.between(0, 32), v = random.between(0, 32);
    const auto column = static_cast<int>(u), row = static_cast<int>(v);
    const std::array<Vec2, 4> corners = column_corners(view, face, column, row);
    const LightFace& f = view.face(face);
    for (int k = 0; k < 4; ++k) {
      const Vec2 c = corners[static_cast<std::size_t>(k)];
      const TexelCoordinate t = project_to_face(view, face, view.origin + c.x * f.right + c.y * f.up);
      ASSERT_NEAR(t.u, column + (k == 1 || k == 2), 1e-9);
      ASSERT_NEAR(t.v, row + (k >= 2), 1e-9);
    }
  }
}

TEST_P(Shapes, NothingThatTheCameraSeesIsCutOff) {
  const LightView view = fitted(512);
  const View eye = make_view(scene_.camera, {160, 100});
  Random random(7);
  int seen = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p{random.between(-20, 20), 0.0, random.between(-20, 20)};
    const Vec3 pixel = project_to_pixels(eye, p);
    if (!(pixel.z > 0 && pixel.x >= 0 && pixel.y >= 0 && pixel.x < 160 && pixel.y < 100)) continue;
    ++seen;
    const TexelCoordinate t = project_to_texel(view, p);
    ASSERT_TRUE(t.inside);
    ASSERT_GT(t.depth, view.face(t.face).near_depth);
    ASSERT_LT(t.depth, view.face(t.face).far_depth);
  }
  EXPECT_GT(seen, 1000);
}

INSTANTIATE_TEST_SUITE_P(
    All, Shapes,
    testing::Values(Kind{"cascades", false, false, true}, Kind{"tight", false, true, false},
                    Kind{"orthographic", false, false, true, true},
                    Kind{"orthographic_tight", false, false, false, true}, Kind{"warped", true, false, false},
                    Kind{"warped_snapped", true, false, true}, Kind{"warped_reversed", true, true, false}),
    [](const auto& chosen) { return std::string(chosen.param.name); });

// Zhang et al. 2006, equation 9: even and logarithmic splits, and their mean.
TEST(Splits, LambdaMovesTexelsTowardsTheEye) {
  const Scene scene = street();
  const World world = make_world(scene);
  double last = infinity;
  for (const double lambda : {0.0, 0.5, 1.0}) {
    const auto view =
        fit_cascades(world, scene.lights[0], scene.camera, 1.6, 256, {.count = 3, .lambda = lambda}, {});
    ASSERT_TRUE(view.has_value());
    const double finest = texel_world_size(*view, 0, 1.0);
    EXPECT_LT(finest, last);
    last = finest;
  }
}

// Of a camera whose rays are parallel slices are boxes of one width: between them lie even splits of what is seen, each
// face holds its own slice, and the given splits are where they are said to be.
TEST(Splits, AnOrthographicCamerasSlicesBeginWhereSomethingIsSeen) {
  Scene scene = street();
  scene.camera.eye *= 10.0;
  scene.camera.orthographic_height = 8.0;
  const World world = make_world(scene);
  const View eye = make_view(scene.camera, {160, 100});
  const auto view = fit_cascades(world, scene.lights[0], scene.camera, 1.6, 256,
                                 {.count = 3, .lambda = 0.0, .snap = false}, {});
  ASSERT_TRUE(view.has_value());
  Interval seen{infinity, -infinity};
  for (const double x : {-20.0, 20.0})
    for (const double z : {-20.0, 20.0})
      for (const double y : {0.0, 1.5}) {
        const double depth = project_to_pixels(eye, {x, y, z}).z;
        seen.min = std::min(seen.min, depth), seen.max = std::max(seen.max, depth);
      }
  Random random(7);
  std::array<int, 3> in_slice{};
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p{random.between(-20, 20), 0.0, random.between(-20, 20)};
    const Vec3 pixel = project_to_pixels(eye, p);
    if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < 160 && pixel.y < 100)) continue;
    const auto slice = static_cast<int>(3.0 * (pixel.z - seen.min) / (seen.max - seen.min));
    const TexelCoordinate t = project_to_face(*view, slice, p);
    ASSERT_TRUE(t.inside) << slice;
    ++in_slice[static_cast<std::size_t>(slice)];
  }
  for (const int count : in_slice) EXPECT_GT(count, 20);
  const auto whole = fit_light_view(world, scene.lights[0], scene.camera, 1.6, 256);
  ASSERT_TRUE(whole.has_value());
  for (int i = 0; i < 3; ++i) EXPECT_LT(texel_world_size(*view, i, 1.0), texel_world_size(*whole, 0, 1.0));
}

// A light along the view has no warp to give (Wimmer et al. 2004, section 3).
TEST(Warp, VanishesWhereTheLightFollowsTheView) {
  Scene scene = street();
  const World world = make_world(scene);
  scene.lights[0].direction = glm::normalize(scene.camera.target - scene.camera.eye);
  const auto view = fit_warped(world, scene.lights[0], scene.camera, 1.6, 256);
  ASSERT_TRUE(view.has_value());
  EXPECT_EQ(view->face(0).warp, 0.0);
}

// The square of a snapped cascade stands on a grid that does not move with the camera.
class Snap : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(PinholeAndOrthographic, Snap, testing::Values(0.0, 6.0));

TEST_P(Snap, CascadesMoveByWholeTexels) {
  Scene scene = street();
  scene.camera.orthographic_height = GetParam();
  const World world = make_world(scene);
  const CascadeOptions options{.lambda = scene.camera.orthographic() ? 0.0 : 0.5};
  const auto fitted = [&] {
    return fit_cascades(world, scene.lights[0], scene.camera, 1.6, 256, options, {}).value();
  };
  const LightView first = fitted();
  for (int k = 0; k < 50; ++k) {
    scene.camera.eye += Vec3(0.013, 0.001, -0.017), scene.camera.target += Vec3(0.013, 0.001, -0.017);
    const LightView now = fitted();
    for (int face = 0; face < now.face_count; ++face) {
      ASSERT_NEAR(now.face(face).half_extent.x / first.face(face).half_extent.x, 1.0, 1e-14);
      ASSERT_NEAR(now.face(face).half_extent.y / first.face(face).half_extent.y, 1.0, 1e-14);
      const Vec2 moved = (now.face(face).center - first.face(face).center) / texel_world_size(now, face, 1.0);
      ASSERT_NEAR(moved.x, std::round(moved.x), 1e-9);
      ASSERT_NEAR(moved.y, std::round(moved.y), 1e-9);
    }
  }
}

}  // namespace
}  // namespace gnomon
