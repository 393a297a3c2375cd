// The methods in which a frame is traced: each gives the same picture, and the one that is chosen says why.
#include <gtest/gtest.h>

#include "raytrace/choose_tracer.h"
#include "raytrace/frame.h"
#include "tests/support/effects_support.h"

namespace gnomon {
namespace {

using raytrace::Accel;
using raytrace::RayTracedFrame;
using raytrace::RaytraceOptions;
using raytrace::Tracer;
using test::TestWorld;

/// A wavy sheet over a plane, with a mirror in it: triangles with normals of their own, lit in the given
/// methods.
Scene waves(std::vector<Light> lights) {
  constexpr std::uint32_t side = 24;
  Mesh mesh;
  for (std::uint32_t z = 0; z <= side; ++z)
    for (std::uint32_t x = 0; x <= side; ++x) {
      const Vec2 place = Vec2(x, z) / 6.0 - 2.0;
      mesh.positions.emplace_back(place.x, 0.5 + 0.3 * std::sin(3.0 * place.x) * std::cos(2.0 * place.y),
                                  place.y);
      mesh.normals.emplace_back(glm::normalize(Vec3f(0.3f * static_cast<float>(place.x), 1.0f, 0.1f)));
    }
  for (std::uint32_t z = 0; z < side; ++z)
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t corner = z * (side + 1) + x;
      mesh.triangles.push_back({corner, corner + side + 1, corner + 1});
      mesh.triangles.push_back({corner + 1, corner + side + 1, corner + side + 2});
      mesh.triangle_materials.insert(mesh.triangle_materials.end(), {x % 5 == 0 ? 1u : 0u, 0u});
    }
  Scene scene = test::scene_of({mesh}, {test::plane({0, 0, 0}, {0, 1, 0})});
  scene.materials.push_back(test::mirror_of(0.6f));
  scene.lights = std::move(lights);
  scene.background = {0.3f, 0.5f, 0.8f}, scene.ambient = Vec3f(0.1f);
  scene.camera.eye = {0.25, 2.25, 4}, scene.camera.target = {0, 0.5, 0};
  return scene;
}

Light spot(const Vec3& from) {
  Light light = test::point_light(from);
  light.type = LightType::spot, light.direction = glm::normalize(-from), light.outer_angle = 0.4;
  return light;
}

// Where only the picture is wanted its receivers are found again instead of stored: the same picture.
TEST(Frame, ThePictureAloneIsThatOfTheFrame) {
  const Light sun = test::sun({1, -2, -1}), bulb = test::point_light({-1, 1.2, 1});
  Light lamp = bulb;
  lamp.extent = SphereLight{0.2};
  for (const std::vector<Light>& lights :
       {std::vector<Light>{sun}, {bulb}, {sun, bulb}, {spot({-1, 2, 1})}, {sun, lamp}}) {
    const TestWorld w(waves(lights));
    const Tracer tracer(w.world(), Accel::bvh);
    std::vector<std::uint32_t> all(lights.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    for (const std::span<const std::uint32_t> traced : {std::span<const std::uint32_t>(all), {}}) {
      RaytraceOptions options;
      options.size = {83, 61};
      const EffectPlan plan = plan_effects(w.scene());
      const RayTracedFrame whole = trace_frame(tracer, plan, w.scene().camera, traced, options);
      options.records = false;
      const RayTracedFrame alone = trace_frame(tracer, plan, w.scene().camera, traced, options);
      EXPECT_EQ(alone.color.data, whole.color.data) << lights.size() << " lights";
      EXPECT_EQ(alone.rays.primary, whole.rays.primary);
      EXPECT_EQ(alone.rays.reflection, whole.rays.reflection);
      for (std::size_t i = 0; i < traced.size(); ++i) {
        if (has_size(lights[i])) continue;
        EXPECT_EQ(alone.lights[i].centre.data, whole.lights[i].centre.data);
        EXPECT_EQ(alone.lights[i].rays, whole.lights[i].rays);
      }
    }
  }
}

TEST(Frame, ThePictureAloneStoresNoReceivers) {
  const TestWorld w(waves({test::sun({1, -2, -1})}));
  RaytraceOptions options;
  options.size = {40, 30}, options.records = false;
  const std::vector<std::uint32_t> lights{0};
  const RayTracedFrame frame =
      trace_frame(Tracer(w.world(), Accel::bvh), plan_effects(w.scene()), w.scene().camera, lights, options);
  EXPECT_TRUE(frame.receiver.data.empty());
}

raytrace::TracerPlan ways_of(Scene scene, Accel accel, raytrace::Precision precision,
                             const RaytraceOptions& options) {
  const TestWorld w(std::move(scene));
  const Tracer tracer(w.world(), accel, precision);
  const std::vector<std::uint32_t> lights{0};
  return choose_tracer(tracer, make_view(w.scene().camera, {40, 30}), lights, options);
}

// One function chooses, and says why: each of its reasons once.
TEST(Ways, EveryWayHasItsReason) {
  using raytrace::Precision, raytrace::PrimaryMethod, raytrace::ReceiverStore, raytrace::ShadowMethod;
  const Scene plain = waves({test::sun({1, -2, -1})});
  Scene wide = plain, spot = plain, soft = plain;
  wide.camera.vertical_fov = 2.9;
  spot.lights[0].type = LightType::spot;
  soft.lights[0].extent = SunDisc{0.01};
  const RaytraceOptions records;
  RaytraceOptions picture, samples;
  picture.records = samples.records = false, samples.samples_per_pixel = 4;
  struct Case {
    raytrace::TracerPlan methods;
    PrimaryMethod primary;
    ReceiverStore receivers;
    ShadowMethod shadow;
  };
  const auto robust = [&](const Scene& scene, const RaytraceOptions& options) {
    return ways_of(scene, Accel::bvh, Precision::robust, options);
  };
  const Case cases[] = {
      {robust(plain, records), PrimaryMethod::blocks, ReceiverStore::stored, ShadowMethod::blocks},
      {robust(plain, picture), PrimaryMethod::blocks, ReceiverStore::found_again, ShadowMethod::blocks},
      {robust(spot, picture), PrimaryMethod::blocks, ReceiverStore::stored, ShadowMethod::blocks},
      {robust(soft, picture), PrimaryMethod::blocks, ReceiverStore::stored, ShadowMethod::none},
      {robust(wide, picture), PrimaryMethod::single_rays, ReceiverStore::stored, ShadowMethod::blocks},
      {robust(plain, samples), PrimaryMethod::none, ReceiverStore::none, ShadowMethod::none},
      {ways_of(plain, Accel::bvh, Precision::fast, records), PrimaryMethod::single_rays,
       ReceiverStore::stored, ShadowMethod::single_rays},
      {ways_of(plain, Accel::grid, Precision::robust, records), PrimaryMethod::single_rays,
       ReceiverStore::stored, ShadowMethod::single_rays},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(&c - cases);
    EXPECT_EQ(c.methods.primary, c.primary);
    EXPECT_EQ(c.methods.receivers, c.receivers);
    EXPECT_EQ(c.methods.shadow, c.shadow);
    EXPECT_FALSE(c.methods.primary_reason.empty() || c.methods.receivers_reason.empty() ||
                 c.methods.shadow_reason.empty());
  }
}

}  // namespace
}  // namespace gnomon
