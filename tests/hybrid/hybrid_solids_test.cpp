// Quadrics, tori and implicit surfaces: what interval arithmetic calls sure of them is what the rays find,
// near and far from the origin, from every kind of light; and most of it is sure.
#include <gtest/gtest.h>

#include "tests/hybrid/hybrid_support.h"
#include "tests/support/solid_samples.h"

namespace gnomon {
namespace {

using test::run;
using test::Stage;

Light spot(const Vec3& position, const Vec3& target) {
  Light light = test::point_light(position);
  light.type = LightType::spot;
  light.direction = glm::normalize(target - position);
  light.inner_angle = 0.2, light.outer_angle = 0.5;
  return light;
}

/// Over a floor; the last light stands inside the solid's ball, where nothing can be known.
Scene scene_with(const Shape& solid, const Vec3& at) {
  Scene scene = test::scene_of({}, {solid, test::plane(at + Vec3(0, -1.2, 0), {0, 1, 0})});
  scene.name = solid.name;
  scene.lights = {test::sun(glm::normalize(Vec3(-0.5, -1, -0.3))),
                  test::point_light(at + Vec3(1.1, 2.2, 1.4)), spot(at + Vec3(-0.9, 2.4, 1.0), at),
                  test::point_light(at + Vec3(0.1, 0.05, 0.0))};
  scene.camera.eye = at + Vec3(1.6, 1.4, 3.2), scene.camera.target = at + Vec3(0, -0.3, 0);
  return scene;
}

/// With surfaces that are given by expressions: a body, a thin wall that is cut open, one with many pieces.
std::vector<Shape> samples(const Vec3& at) {
  std::vector<Shape> out = test::solid_samples(1.4, at);
  const Aabb box{Vec3(-0.8), Vec3(0.8)};
  for (Shape shape :
       {test::implicit("heart", "(4*x^2 + 9*z^2 + 4*y^2 - 1)^3 - 32*x^2*y^3 - 3.6*z^2*y^3", box, true),
        test::implicit("saddle", "y - x*z", box, false),
        test::implicit("gyroid", "abs(sin(5*x)*cos(5*y) + sin(5*y)*cos(5*z) + sin(5*z)*cos(5*x)) - 0.4", box,
                       true)}) {
    std::get<Implicit>(shape.geometry).frame = test::tilted_frame(0.0, at);
    out.push_back(std::move(shape));
  }
  return out;
}

TEST(HybridSolids, EqualRayTracing) {
  for (const Vec3& at : {Vec3(0.0), Vec3(2048.5, -511.25, 77.0)})
    for (const Shape& solid : samples(at)) {
      const Stage stage(scene_with(solid, at), {96, 54});
      for (std::uint32_t light = 0; light < stage.scene.lights.size(); ++light)
        for (const int size : {7, 128}) EXPECT_EQ(run(stage, light, size).different, 0u) << light;
    }
}

TEST(HybridSolids, MostIsSure) {
  for (const Shape& solid : test::solid_samples(1.4)) {
    const Stage stage(scene_with(solid, Vec3(0.0)), {480, 270});
    const double share = run(stage, 0, 512).ray_share(), by_lamp = run(stage, 1, 512).ray_share();
    std::printf("  %-24s rays: %5.2f %% sun, %5.2f %% point\n", solid.name.c_str(), 100.0 * share,
                100.0 * by_lamp);
    const double most = is_convex(solid.geometry) ? 0.11 : 0.25;  // nearly all of it around outlines and rims
    EXPECT_LT(share, most) << solid.name;
    EXPECT_LT(by_lamp, most) << solid.name;
  }
}

}  // namespace
}  // namespace gnomon
