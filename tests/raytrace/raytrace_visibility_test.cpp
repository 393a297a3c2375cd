// What a light sees: closed forms, the ambiguity at edges, and the cases where a shadow ray ends on a surface.
#include <gtest/gtest.h>

#include "raytrace/frame.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using raytrace::Accel;
using raytrace::PointVisibility;
using raytrace::Precision;
using raytrace::SurfacePoint;
using raytrace::Tracer;
using test::Random;
using test::TestWorld;

raytrace::RayTracedFrame trace(const TestWorld& w, const Tracer& tracer, ImageSize size) {
  std::vector<std::uint32_t> lights(w.scene().lights.size());
  for (std::uint32_t i = 0; i < lights.size(); ++i) lights[i] = i;
  raytrace::RaytraceOptions options;
  options.size = size;
  options.picture = false;
  return trace_frame(tracer, plan_effects(w.scene()), w.scene().camera, lights, options);
}

std::size_t count(const Image<PointVisibility>& image, PointVisibility visibility) {
  return static_cast<std::size_t>(std::count(image.data.begin(), image.data.end(), visibility));
}

TEST(PointVisibility, SphereOverPlaneEqualsTheClosedForm) {
  Scene scene = test::scene_of({}, {test::plane({0, 0, 0}, {0, 1, 0}), test::sphere({0, 1.5, 0}, 1.0)});
  scene.lights = {test::point_light({1.0, 5.0, 2.0})};
  scene.camera.eye = {0, 6, 12};
  const TestWorld w(scene);
  const auto frame = trace(w, Tracer(w.world(), Accel::bvh), {640, 360});
  const Vec3 light = scene.lights[0].position, center(0, 1.5, 0);
  int checked = 0, shadowed = 0;
  for (std::size_t i = 0; i < frame.receiver.data.size(); ++i) {
    const SurfacePoint& p = frame.receiver.data[i];
    if (p.primitive != 0) continue;
    const Vec3 u = p.position - light, c = center - light;
    const double along = glm::dot(u, c), left = along * along,
                 right = (glm::dot(c, c) - 1.0) * glm::dot(u, u);
    if (std::abs(left - right) < 1e-13 * std::abs(right)) continue;  // the closed form's own rounding
    const bool in_shadow = along > 0.0 && left >= right;
    ASSERT_EQ(frame.lights[0].centre.data[i], in_shadow ? PointVisibility::shadowed : PointVisibility::lit)
        << i;
    ++checked, shadowed += in_shadow ? 1 : 0;
  }
  EXPECT_GT(checked, 50000);
  EXPECT_GT(shadowed, 2000);
  EXPECT_EQ(count(frame.lights[0].centre, PointVisibility::uncertain), 0U);
}

TEST(PointVisibility, OrdinarySceneHasNoDoubtEvenOnAlignedDiagonals) {
  // Everything aligned on purpose: the pixel grid, the floor's diagonal, the box's edges and the light's
  // direction.
  Scene scene =
      test::scene_of({test::quad({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}), test::box({-1, 1, -1}, {1, 3, 1})});
  scene.lights = {test::sun({0, -1, 0}), test::sun({-1, -1, -1}), test::point_light({0, 8, 0})};
  scene.camera.eye = {0, 12.3, 0}, scene.camera.up = {0, 0, -1};
  const TestWorld w(scene);
  const auto frame = trace(w, Tracer(w.world(), Accel::bvh), {400, 400});
  EXPECT_GT(count(frame.lights[1].centre, PointVisibility::shadowed), 1000U);
  for (const auto& light : frame.lights) {
    EXPECT_LT(count(light.centre, PointVisibility::uncertain), 17U);  // 1e-4 of the pixels
  }
}

TEST(PointVisibility, TheAmbiguityIsReal) {
  // The edge of a half plane exactly over the point: within rounding, so neither lit nor shadowed is proven.
  Scene scene =
      test::scene_of({test::quad({0, 1, -1}, {0, 0, 2}, {2, 0, 0})}, {test::plane({0, 0, 0}, {0, 1, 0})});
  const TestWorld w(scene);
  const Tracer tracer(w.world(), Accel::bvh);
  const Light light = test::sun({0, -1, 0});
  const auto at = [&](double x) {
    return tracer.centre_visibility(test::seen(tracer, {x, 0.5, 0.25}, {x, 0, 0.25}), light);
  };
  EXPECT_EQ(at(0.0), PointVisibility::uncertain);
  EXPECT_EQ(at(1e-12), PointVisibility::shadowed);
  EXPECT_EQ(at(-1e-12), PointVisibility::lit);
}

TEST(PointVisibility, SharedEdgeIsNoDoubt) {
  // The diagonal of an overhead quad: one of its two triangles blocks, whichever.
  Scene scene =
      test::scene_of({test::quad({-1, 1, -1}, {0, 0, 2}, {2, 0, 0})}, {test::plane({0, 0, 0}, {0, 1, 0})});
  const TestWorld w(scene);
  const Tracer tracer(w.world(), Accel::bvh);
  for (const double x : {-0.5, 0.0, 0.25, 0.7})
    EXPECT_EQ(tracer.centre_visibility(test::seen(tracer, {x, 0.5, x}, {x, 0, x}), test::sun({0, -1, 0})),
              PointVisibility::shadowed);
}

TEST(PointVisibility, SharedEdgeWithAHoleIsInDoubt) {
  // The same, but one of the two is a hole: within rounding of the edge, either side of it may be the true one.
  Scene scene =
      test::scene_of({test::quad({0, 1, 0}, {0, 0, 1}, {1, 0, 0})}, {test::plane({0, 0, 0}, {0, 1, 0})});
  scene.materials.resize(2);
  scene.materials[1].alpha = 0.0f;
  for (const AlphaMode mode : {AlphaMode::opaque, AlphaMode::mask})
    for (const std::uint32_t hole : {0U, 1U}) {
      scene.materials[1].alpha_mode = mode;
      scene.meshes[0].triangle_materials = {hole, 1 - hole};
      const TestWorld w(scene);
      const Tracer tracer(w.world(), Accel::bvh);
      for (const double beside : {-0x1p-53, 0.0, 0x1p-53}) {
        const SurfacePoint p = test::seen(tracer, {0.25, 0.5, 0.25 + beside}, {0.25, 0, 0.25 + beside});
        EXPECT_EQ(tracer.centre_visibility(p, test::sun({0, -1, 0})),
                  mode == AlphaMode::mask ? PointVisibility::uncertain : PointVisibility::shadowed)
            << hole << " " << beside;
      }
    }
}

TEST(PointVisibility, BvhAndBruteForceAgree) {
  Scene scene = test::scene_of(
      {test::triangle_soup(200, 3.0, 1.0, 31), test::quad({-6, -4, -6}, {0, 0, 12}, {12, 0, 0})},
      {test::sphere({1, 1, 1}, 0.7)});
  scene.lights = {test::point_light({2, 7, 1}), test::sun({1, -3, 1})};
  scene.camera.eye = {0, 4, 14};
  const TestWorld w(scene);
  const auto a = trace(w, Tracer(w.world(), Accel::bvh), {160, 90});
  const auto b = trace(w, Tracer(w.world(), Accel::brute), {160, 90});
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(a.lights[i].centre.data, b.lights[i].centre.data);
}

TEST(PointVisibility, NearestOccluderIsThereExactlyWhenShadowed) {
  Scene scene = test::scene_of({test::triangle_soup(200, 3.0, 1.0, 32)},
                               {test::sphere({1, 1, 1}, 0.7), test::plane({0, -4, 0}, {0, 1, 0})});
  scene.lights = {test::point_light({2, 7, 1})};
  scene.camera.eye = {0, 4, 14};
  const TestWorld w(scene);
  const Tracer tracer(w.world(), Accel::bvh);
  const auto frame = trace(w, tracer, {160, 90});
  for (std::size_t i = 0; i < frame.receiver.data.size(); ++i) {
    const SurfacePoint& p = frame.receiver.data[i];
    if (p.primitive == no_id || light_cannot_reach(scene.lights[0], p.position, p.normal)) continue;
    const PointVisibility visibility = frame.lights[0].centre.data[i];
    if (visibility == PointVisibility::uncertain) continue;
    ASSERT_EQ(tracer.nearest_occluder(p, scene.lights[0]).has_value(),
              visibility == PointVisibility::shadowed)
        << i;
  }
}

TEST(PointVisibility, Case22LightInTheReceiversPlaneIsUnlit) {
  const TestWorld w(test::scene_of({test::quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0})}));
  for (const Accel accel : {Accel::bvh, Accel::brute}) {
    const Tracer tracer(w.world(), accel);
    const SurfacePoint p = test::seen(tracer, {0.2, 1, 0.1}, {0.2, 0, 0.1});
    EXPECT_TRUE(light_cannot_reach(test::point_light({5, p.position.y, 0}), p.position, p.normal));
    EXPECT_TRUE(light_cannot_reach(test::sun({1, 0, 0}), p.position, p.normal));
  }
}

TEST(PointVisibility, Case23LightAtAVertexIsLit) {
  // The occluder touches the light: a surface at the light's own place does not lie before it.
  Scene scene = test::scene_of({test::box({-1, 2, -1}, {1, 3, 1})}, {test::plane({0, 0, 0}, {0, 1, 0})});
  const TestWorld w(scene);
  for (const Accel accel : {Accel::bvh, Accel::brute}) {
    const Tracer tracer(w.world(), accel);
    Random random(33);
    for (int i = 0; i < 300; ++i) {
      const Vec3 foot{random.uniform(1.5, 4.0), 0.0, random.uniform(1.5, 4.0)};
      const SurfacePoint p = test::seen(tracer, foot + Vec3(0, 0.5, 0), foot);
      ASSERT_EQ(tracer.centre_visibility(p, test::point_light({1, 2, 1})), PointVisibility::lit);
    }
  }
}

TEST(PointVisibility, Case25LightInsideAClosedMeshReachesNothingOutside) {
  Scene scene = test::scene_of({test::uv_sphere({0, 2, 0}, 1.0, 16, 16, 0.05, 34)},
                               {test::plane({0, 0, 0}, {0, 1, 0})});
  const TestWorld w(scene);
  const Tracer tracer(w.world(), Accel::bvh);
  const Light light = test::point_light({0.1, 2.1, -0.2});
  Random random(35);
  for (int i = 0; i < 20000; ++i) {
    Vec3 foot{random.uniform(-5.0, 5.0), 0.0, random.uniform(-5.0, 5.0)};
    if (i % 2 == 0) {  // straight below a vertex, seen from the light
      const Vec3 d = w.world().position(random.below(w.world().vertex_count())) - light.position;
      if (d.y < -0.05) foot = light.position - d * (light.position.y / d.y), foot.y = 0.0;
    }
    ASSERT_NE(tracer.centre_visibility(test::seen(tracer, foot + Vec3(0, 0.01, 0), foot), light),
              PointVisibility::lit);
  }
}

TEST(PointVisibility, Case26CoplanarDuplicatesDoNotShadowEachOther) {
  const Vec3 corner(-1.1, 0.3, -0.9), a(0.1, 0.2, 2.2), b(2.1, -0.3, 0.2);
  const TestWorld w(test::scene_of(
      {test::quad(corner, a, b), test::quad(corner, a, b), test::quad(corner + 0.2 * a, 0.5 * a, 0.5 * b)}));
  const Tracer tracer(w.world(), Accel::bvh);
  Random random(36);
  for (int i = 0; i < 2000; ++i) {
    const double u = random.uniform(0.25, 0.65), v = random.uniform(0.05, 0.45);
    const Vec3 target = corner + u * a + v * b;
    const SurfacePoint p = test::seen(tracer, target + Vec3(0, 3, 0), target);
    ASSERT_EQ(tracer.centre_visibility(p, test::point_light({random.uniform(-3, 3), 4, 0})),
              PointVisibility::lit)
        << i;
  }
}

TEST(PointVisibility, Case26CopiesOfASphereDoNotShadowEachOther) {
  const Shape ball = test::sphere({0.3, 0.1, -0.7}, 0.9);
  const TestWorld w(test::scene_of({}, {ball, ball}));
  const Light light = test::point_light({1.0, 4.0, 2.0});
  for (const Precision precision : {Precision::robust, Precision::exact}) {
    const Tracer tracer(w.world(), Accel::bvh, precision);
    Random random(37);
    int lit = 0;
    for (int i = 0; i < 500; ++i) {
      const SurfacePoint p =
          test::seen(tracer, {2.0, 4.0, 3.0}, std::get<Sphere>(ball.geometry).center + random.in_box(0.5));
      if (light_cannot_reach(light, p.position, p.normal)) continue;
      EXPECT_EQ(tracer.centre_visibility(p, light), PointVisibility::lit) << i;
      ++lit;
    }
    EXPECT_GT(lit, 300);
  }
}

TEST(PointVisibility, Case27BoxNearAPlaneShadowsRightUpToItsFoot) {
  for (const double gap : {0.0, 1e-7, 1e-4}) {
    Scene scene = test::scene_of({test::box({-1, gap, -1}, {1, 1, 1})}, {test::plane({0, 0, 0}, {0, 1, 0})});
    const TestWorld w(scene);
    const Tracer tracer(w.world(), Accel::bvh);
    const Light light = test::sun({1, -1, 0});  // shadows towards +x, at 45 degrees
    const auto at = [&](double x) {
      return tracer.centre_visibility(test::seen(tracer, {x, 1e-3, 0.3}, {x, 0, 0.3}), light);
    };
    EXPECT_EQ(at(1.0 + gap + 1e-9), PointVisibility::shadowed)
        << gap;  // the light slips below the box by `gap`, no more
    EXPECT_EQ(at(1.9), PointVisibility::shadowed);
    EXPECT_EQ(at(2.0 + 1e-9), PointVisibility::lit);
    EXPECT_EQ(at(-1.0 - 1e-9), PointVisibility::lit) << gap;
  }
}

TEST(PointVisibility, MaskedSurfacesLetLightThroughTheirHoles) {
  Scene scene =
      test::scene_of({test::quad({-1, 1, -1}, {0, 0, 2}, {2, 0, 0})}, {test::plane({0, 0, 0}, {0, 1, 0}, 1)});
  scene.meshes[0].uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  Texture checker;
  checker.size = {2, 1}, checker.nearest = true;
  checker.texels = {{255, 255, 255, 255}, {255, 255, 255, 0}};
  scene.textures = {checker};
  scene.materials[0].diffuse_texture = 0, scene.materials[0].alpha_mode = AlphaMode::mask;
  scene.materials.emplace_back();
  const TestWorld w(scene);
  for (const Accel accel : {Accel::bvh, Accel::brute}) {
    const Tracer tracer(w.world(), accel);
    const Light light = test::sun({0, -1, 0});
    for (const double x : {-0.75, -0.25, 0.25, 0.75}) {
      const Ray up{{x, 0.5, 0.1}, {0, 1, 0}};
      EXPECT_EQ(tracer.occluded(up), x < 0.0);
      EXPECT_EQ(tracer.closest_hit(up).has_value(), x < 0.0);
      EXPECT_EQ(tracer.centre_visibility(test::seen(tracer, {x, 0.5, 0.1}, {x, 0, 0.1}), light),
                x < 0.0 ? PointVisibility::shadowed : PointVisibility::lit);
    }
  }
}

}  // namespace
}  // namespace gnomon
