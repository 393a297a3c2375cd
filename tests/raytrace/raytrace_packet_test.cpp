// Packets of floats against the double kernels (support/packet_checks.h): random and hard scenes.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <filesystem>
#include <limits>

#include "scene/load.h"
#include "tests/support/packet_checks.h"
#include "tests/support/places.h"

namespace gnomon {
namespace {

using raytrace::Accel;
using raytrace::PointVisibility;
using raytrace::SurfacePoint;
using raytrace::Tracer;
using test::check;
using test::expect_same;
using test::lights_around;
using test::look;
using test::Reference;
using test::reference_of;
using test::TestWorld;

TEST(Packets, RandomTriangles) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    for (const double size : {0.02, 0.2, 1.5}) {
      Scene scene = test::scene_of({test::triangle_soup(2000, 1.0, size, seed)});
      look(scene, {0.3, 0.4, 3.0}, {0, 0, 0});
      scene.lights = lights_around(Vec3(0.0), 2.0);
      check(scene, {101, 67});
    }
  }
}

raytrace::ShadowRayCounts counts_of(const Scene& scene, ImageSize size, raytrace::PacketUse packets) {
  const TestWorld w(scene);
  const Tracer tracer(w.world(), Accel::bvh);
  const View view = make_view(scene.camera, size);
  Image<SurfacePoint> receivers(size);
  primary_pass(tracer, view, edge_setup_of_eye(tracer, view),
               {.size = size, .hits = {}, .receivers = &receivers, .quantised = {}});
  Image<PointVisibility> visibility(size, PointVisibility::lit);
  return shadow_pass({.tracer = tracer, .size = size, .stored = &receivers, .packets = packets},
                     scene.lights[0], visibility);
}

// What is counted as a single ray: of foliage what its tiles give up, of a few large triangles next to nothing.
TEST(Packets, SingleRaysAreThoseThatTilesGiveUp) {
  using raytrace::PacketUse;
  Scene foliage = test::scene_of({test::triangle_soup(20000, 1.0, 0.03, 7)});
  look(foliage, {0.3, 0.4, 3.0}, {0, 0, 0});
  foliage.lights = {test::sun({-0.3, -1.0, -0.2})};
  Scene large = foliage;
  large.meshes = {test::triangle_soup(30, 1.0, 1.0, 7)};
  const auto chosen = counts_of(foliage, {101, 67}, PacketUse::where_cheaper);
  EXPECT_GT(chosen.single, chosen.cast / 2);
  EXPECT_LT(counts_of(foliage, {101, 67}, PacketUse::always).single, chosen.cast / 10);
  const auto few = counts_of(large, {640, 400}, PacketUse::where_cheaper);
  EXPECT_GT(few.cast, 10000u);
  EXPECT_LT(few.single, few.cast / 1000);
}

// Foliage: neighbouring pixels see triangles far apart, and between them and the lights lie more than a packet is worth.
TEST(Packets, ScatteredReceiversGoOnOneByOne) {
  Scene scene = test::scene_of({test::triangle_soup(20000, 1.0, 0.03, 7)});
  look(scene, {0.3, 0.4, 3.0}, {0, 0, 0});
  scene.lights = lights_around(Vec3(0.0), 2.0);
  check(scene, {101, 67});
}

// Backs that are not seen, among such as are: from afar, from within, and with eyes in triangles' planes.
TEST(Packets, SingleSidedTriangles) {
  for (const double size : {0.05, 1.5}) {
    Mesh mesh = test::triangle_soup(2000, 1.0, size, 5);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) mesh.triangle_materials.push_back(i % 3 / 2);
    Scene scene = test::scene_of({mesh, test::quad({-2, -1, -2}, {0, 0, 4}, {4, 0, 0})});
    scene.materials.resize(2);
    scene.materials[0].double_sided = false;
    scene.instances[1].material = 1;
    scene.lights = lights_around(Vec3(0.0), 2.0);
    for (const Vec3& eye :
         {Vec3(0.3, 0.4, 3.0), Vec3(0.01, 0.02, -0.03), mesh.positions[4] + Vec3(0, 0, 0.5)}) {
      look(scene, eye, {0, 0, 0});
      check(scene, {101, 67});
    }
  }
  Scene inside_out =
      test::scene_of({test::box({-1, 0, -1}, {1, 1, 1}), test::box({-0.5, 1, -0.5}, {0.5, 2, 0.5})});
  inside_out.materials[0].double_sided = false;
  inside_out.lights = lights_around(Vec3(0.0), 2.0);
  for (const Vec3& eye : {Vec3(4, 1, 5), Vec3(0.2, 0.5, 0.1), Vec3(1, 0.5, 4), Vec3(-3, 1, 0)}) {
    look(inside_out, eye, {0, 1, 0});
    inside_out.camera.up = {0, 1, 0};
    check(inside_out, {120, 90});
  }
}

TEST(Packets, FromWithinAndWideOpen) {
  Scene scene = test::scene_of({test::triangle_soup(3000, 1.0, 0.1, 7)});
  look(scene, {0.01, 0.02, -0.03}, {1, 0.2, 0.1}, 2.6);
  scene.lights = lights_around(Vec3(0.05), 0.1);
  check(scene, {96, 64});
}

TEST(Packets, RaysThroughVerticesAndEdges) {
  // A regular grid seen so that pixel centres fall on its vertices, edges and diagonals.
  std::vector<Mesh> meshes;
  for (int x = -8; x < 8; ++x)
    for (int y = -8; y < 8; ++y)
      meshes.push_back(test::quad({x / 8.0, y / 8.0, 0}, {0.125, 0, 0}, {0, 0.125, 0}));
  meshes.push_back(test::quad({-1, -1, -0.5}, {2, 0, 0}, {0, 2, 0}));
  meshes.push_back(test::box({-0.25, -0.25, 0.25}, {0.25, 0.25, 0.5}));
  Scene scene = test::scene_of(meshes);
  scene.camera.eye = {0, 0, 2}, scene.camera.target = {0, 0, 0}, scene.camera.up = {0, 1, 0};
  scene.camera.vertical_fov = 2.0 * std::atan(0.5);
  scene.lights = {test::point_light({0, 0, 4}), test::sun({0, 0, -1}), test::sun({0.5, 0, -1}),
                  test::point_light({0.25, 0.25, 1.0})};
  for (const ImageSize size : {ImageSize{65, 65}, ImageSize{64, 64}}) check(scene, size);
}

TEST(Packets, EdgeOnWallsAndLightsInTheirPlanes) {
  Scene scene = test::scene_of({test::box({-1, 0, -1}, {1, 1, 1}), test::box({-0.5, 1, -0.5}, {0.5, 2, 0.5}),
                                test::quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0})});
  look(scene, {4, 3, 5}, {0, 1, 0});
  scene.camera.up = {0, 1, 0};
  scene.lights = {test::sun({0, -1, 0}),        test::sun({-1, -1, 0}),       test::point_light({1, 4, 0}),
                  test::point_light({1, 1, 3}), test::point_light({1, 1, 1}), test::point_light({0, 2, 0})};
  check(scene, {120, 90});
}

TEST(Packets, FarFromTheOrigin) {
  for (const double far : {1e3, 1e6}) {
    Mesh mesh = test::uv_sphere({0, 1, 0}, 1.0, 24, 48, 0.05, 3);
    Mesh floor = test::quad({-4, 0, -4}, {0, 0, 8}, {8, 0, 0});
    const Vec3 shift(far, -far, 2.0 * far);
    for (Mesh* m : {&mesh, &floor})
      for (Vec3& p : m->positions) p += shift;
    Scene scene = test::scene_of({mesh, floor});
    look(scene, shift + Vec3(3, 3, 4), shift + Vec3(0, 0.7, 0));
    scene.lights = lights_around(shift + Vec3(0, 1, 0), 2.0);
    check(scene, {96, 64});
  }
}

TEST(Packets, SlimTrianglesAndGlancingLights) {
  Mesh mesh;
  test::Random random(11);
  for (std::uint32_t i = 0; i < 600; ++i) {
    const Vec3 p = random.in_box(1.0), along = 2.0 * random.direction();
    mesh.positions.insert(mesh.positions.end(), {p, p + along, p + 0.5 * along + 1e-7 * random.direction()});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  Scene scene = test::scene_of({mesh, test::quad({-3, -1, -3}, {0, 0, 6}, {6, 0, 0})});
  look(scene, {3, 2, 3}, {0, 0, 0});
  scene.lights = {test::sun({-1, -0.001, 0}), test::point_light({2.9, -0.999, 0}),
                  test::point_light({0, 2, 0})};
  check(scene, {96, 64});
}

// A small body on an infinite floor that fills the picture up to the horizon.
Scene body_on_a_plain(double tilt) {
  Scene scene = test::scene_of({test::uv_sphere({0, 1, 0}, 1.0, 24, 48, 0.05, 3)},
                               {test::plane({0, -0.1, 0}, {0, 1, 0}), test::plane({0, 0, -900}, {0, 0, 1})});
  look(scene, {3, 1.5, 6}, {0, 1, 0});
  scene.lights = {test::sun({tilt, -1.0, 0.3 * tilt}), test::point_light({1.0, 9.0, -2.0})};
  return scene;
}

TEST(Packets, ReceiversFarBeyondAllThatIsFinite) {
  for (const double tilt : {0.0, 0.4, 4.0}) check(body_on_a_plain(tilt), {128, 72});
}

TEST(Packets, SheetsNearerThanFloatsCanTell) {
  // Every triangle twice, the copy's corners moved by less than a float's rounding: which one is in front,
  // and whether the one shadows the other, only double knows.
  Mesh mesh = test::triangle_soup(500, 1.0, 0.4, 13);
  test::Random random(17);
  const auto corners = static_cast<std::uint32_t>(mesh.positions.size());
  const std::size_t triangles = mesh.triangles.size();
  for (std::uint32_t i = 0; i < corners; ++i)
    mesh.positions.push_back(mesh.positions[i] + random.in_box(1e-8));
  for (std::size_t i = 0; i < triangles; ++i) {
    auto t = mesh.triangles[i];
    for (std::uint32_t& corner : t) corner += corners;
    mesh.triangles.push_back(t);
  }
  Scene scene = test::scene_of({mesh});
  look(scene, {0.3, 0.4, 3.0}, {0, 0, 0});
  scene.lights = lights_around(Vec3(0.0), 2.0);
  check(scene, {101, 67});
}

TEST(Packets, ShapesMasksAndBuiltInScenes) {
  for (const char* name :
       {"fence", "courtyard", "whitted", "teapot", "sphere-plane", "acne-floor", "thin-wall"}) {
    SCOPED_TRACE(name);
    const Expected<Scene> scene = load_scene(name);
    ASSERT_TRUE(scene.has_value());
    check(*scene, {112, 63});
  }
}

TEST(Packets, Bunny) {
  const std::string path = gnomon::test::shared_data() + "/common_organic/stanford-bunny.obj";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "the bunny is not here";
  const Expected<Scene> loaded = load_scene(path);
  ASSERT_TRUE(loaded.has_value());
  Scene scene = *loaded;
  scene.lights.push_back(test::sun({-0.4, -1.0, -0.3}));
  scene.lights.push_back(test::point_light(scene.camera.eye + Vec3(0.1, 0.5, 0.05)));
  check(scene, {320, 180});
}

TEST(Packets, SameForAnyNumberOfThreads) {
  Scene scene = test::scene_of({test::triangle_soup(4000, 1.0, 0.1, 5)});
  look(scene, {0.3, 0.4, 3.0}, {0, 0, 0});
  scene.lights = lights_around(Vec3(0.0), 2.0);
  const TestWorld w(scene);
  const Tracer tracer(w.world(), Accel::bvh);
  const Reference reference = reference_of(tracer, w.scene(), {101, 67});
  for (const std::size_t threads : {1, 2, 3}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    expect_same(w.scene(), tracer, reference, {101, 67});
  }
}

}  // namespace
}  // namespace gnomon
