// Real models: hits and shadows against Embree (float, robust mode).
// Vertices and rays are rounded to float first, so that both tracers are asked the same question.
#include <gtest/gtest.h>

#include <cstdio>

#include "raytrace/frame.h"
#include "tests/support/embree.h"
#include "tests/support/places.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using raytrace::Accel;
using raytrace::PointVisibility;
using raytrace::SurfacePoint;
using raytrace::Tracer;
using test::TestWorld;

Vec3 as_float(const Vec3& v) {
  return Vec3(Vec3f(v));
}

class EmbreeScene {
 public:
  explicit EmbreeScene(const World& world) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), world.vertex_count()));
    for (const Vec3& p : positions_of(world))
      for (int a = 0; a < 3; ++a) *v++ = static_cast<float>(p[a]);
    auto* t = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                                  RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t),
                                                                  world.triangle_count()));
    for (const auto& triangle : triangles_of(world))
      for (const std::uint32_t corner : triangle) *t++ = corner;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeScene() { rtcReleaseScene(scene_), rtcReleaseDevice(device_); }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// The distance of the closest hit, or infinity.
  double closest(const Ray& ray) const {
    RTCRayHit query{};
    query.ray = start(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    test::EmbreeQuery plain;
    test::embree_intersect(scene_, plain, query);
    return query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? infinity : static_cast<double>(query.ray.tfar);
  }
  bool occluded(const Ray& ray) const {
    RTCRay query = start(ray);
    test::EmbreeQuery plain;
    test::embree_occluded(scene_, plain, query);
    return query.tfar < 0.0f;
  }

 private:
  static RTCRay start(const Ray& ray) {
    RTCRay r{};
    r.org_x = static_cast<float>(ray.origin.x), r.org_y = static_cast<float>(ray.origin.y);
    r.org_z = static_cast<float>(ray.origin.z), r.dir_x = static_cast<float>(ray.direction.x);
    r.dir_y = static_cast<float>(ray.direction.y), r.dir_z = static_cast<float>(ray.direction.z);
    r.tnear = static_cast<float>(ray.t.min), r.tfar = static_cast<float>(ray.t.max);
    r.mask = 0xffffffffu;
    return r;
  }
  RTCDevice device_;
  RTCScene scene_;
};

/// The model, rounded to float, over a floor, seen by a camera and lit by a point and a sun.
std::optional<Scene> model_scene(const std::string& file) {
  std::optional<Mesh> mesh = test::read_obj(gnomon::test::shared_data() + "/" + file);
  if (!mesh) return std::nullopt;
  *mesh = test::normalised(std::move(*mesh));
  double low = 0.0;
  for (Vec3& p : mesh->positions) p = as_float(p), low = std::min(low, p.y);
  Scene scene = test::scene_of({std::move(*mesh), test::quad({-1, low, -1}, {0, 0, 2}, {2, 0, 0})});
  scene.lights = {test::point_light({0.7, 1.2, 0.9}), test::sun({-0.5, -1, -0.4})};
  scene.camera.eye = as_float({0.3, 0.4, 1.3});
  return scene;
}

/// Whether rays a float's rounding away from this one do not all agree with each other: then neither answer
/// is wrong.
template <class Answer>
bool float_rounding_decides(const Ray& ray, const Answer& answer) {
  test::Random random(51);
  bool yes = false, no = false;
  for (int i = 0; i < 64; ++i) {
    const Ray moved{ray.origin + 1e-7 * random.in_box(1.0), ray.direction + 2e-7 * random.in_box(1.0), ray.t};
    (answer(moved) ? yes : no) = true;
  }
  return yes && no;
}

/// Both tracers side by side, every difference printed with its reason.
class Comparison {
 public:
  Comparison(const World& world, const std::vector<Light>& lights)
      : tracer_(world, Accel::bvh), embree_(world), lights_(lights) {}

  void pixel(const View& view, int x, int y) {
    Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
    ray.direction = as_float(ray.direction);
    const double theirs = embree_.closest(ray);
    // The same surface: float's t is good to 1e-6 or so here, more where it grazes.
    const auto agrees = [&](const Ray& r) {
      const auto hit = tracer_.closest_hit(r);
      return hit ? std::abs(hit->t - theirs) < 1e-4 : theirs == infinity;
    };
    check(ray, agrees(ray), agrees, x, y, "primary hit");
    if (const auto hit = tracer_.closest_hit(ray)) shadows(tracer_.surface_point(ray, *hit), x, y);
  }

  int rays = 0, differ = 0, unexplained = 0;

 private:
  void shadows(const SurfacePoint& p, int x, int y) {
    for (const Light& light : lights_) {
      if (light_cannot_reach(light, p.position, p.normal)) continue;
      // Lifted off the surface by more than float's error, for both: not the offsets are compared here.
      Ray ray = tracer_.shadow_ray(p, light);
      ray.origin = as_float(ray.origin + 1e-5 * p.normal), ray.direction = as_float(ray.direction);
      ray.t.max = std::min(ray.t.max, 10.0);
      const auto occluded = [&](const Ray& r) { return tracer_.occluded(r); };
      check(ray, occluded(ray) == embree_.occluded(ray), occluded, x, y, "shadow");
    }
  }

  template <class Answer>
  void check(const Ray& ray, bool same, const Answer& answer, int x, int y, const char* what) {
    ++rays;
    if (same) return;
    const bool explained = float_rounding_decides(ray, answer);
    ++differ, unexplained += explained ? 0 : 1;
    std::printf("  %s at pixel (%d, %d): %s\n", what, x, y,
                explained ? "within float rounding of an edge" : "UNEXPLAINED");
  }

  Tracer tracer_;
  EmbreeScene embree_;
  const std::vector<Light>& lights_;
};

void compare_with_embree(const std::string& file) {
  std::optional<Scene> scene = model_scene(file);
  if (!scene) GTEST_SKIP() << file << " is not here";
  const TestWorld w(std::move(*scene));
  const View view = make_view(w.scene().camera, {640, 480});
  Comparison comparison(w.world(), w.scene().lights);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) comparison.pixel(view, x, y);
  std::printf("  %s: %d of %d rays differ\n", file.c_str(), comparison.differ, comparison.rays);
  EXPECT_GT(comparison.rays, 600000);
  EXPECT_LE(comparison.differ, comparison.rays / 100000);
  EXPECT_EQ(comparison.unexplained, 0);
}

TEST(Models, BunnyAgreesWithEmbree) {
  compare_with_embree("common_organic/stanford-bunny.obj");
}
TEST(Models, ArmadilloAgreesWithEmbree) {
  compare_with_embree("libigl_armadillo/armadillo.obj");
}

TEST(Models, ShadowsOfTheBunnyAreHardlyEverInDoubt) {
  std::optional<Scene> scene = model_scene("common_organic/stanford-bunny.obj");
  if (!scene) GTEST_SKIP() << "the bunny is not here";
  const TestWorld w(std::move(*scene));
  raytrace::RaytraceOptions options;
  options.size = {640, 480}, options.picture = false;
  const auto frame = trace_frame(Tracer(w.world(), Accel::bvh), plan_effects(w.scene()), w.scene().camera,
                                 std::vector<std::uint32_t>{0, 1}, options);
  for (const auto& light : frame.lights) {
    const auto uncertain =
        std::count(light.centre.data.begin(), light.centre.data.end(), PointVisibility::uncertain);
    EXPECT_LE(uncertain, 30);  // 1e-4 of the pixels
  }
}

}  // namespace
}  // namespace gnomon
