// Fits of lights' maps leave out blocks of triangles that cannot matter. They find what they find without leaving out any.
#include <gtest/gtest.h>

#include <atomic>

#include "scene/generate/random.h"
#include "scene/light_map/cascade_fit.h"
#include "scene/shapes/triangle_blocks.h"
#include "tests/support/small_scenes.h"

namespace gnomon {
namespace {

/// Small triangles in clusters, so that the boxes of blocks differ.
Mesh clusters(std::uint32_t triangles, double extent, std::uint64_t seed) {
  Random random(seed);
  Mesh mesh;
  Vec3 middle(0.0);
  for (std::uint32_t i = 0; i < triangles; ++i) {
    if (i % 700 == 0) middle = extent * random.in_ball();
    const Vec3 at = middle + 0.2 * extent * random.in_ball();
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(at + 0.02 * extent * random.in_ball());
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

/// Flattened parts of many blocks and of one, and kept ones.
Scene clustered_scene(std::uint64_t seed) {
  Scene scene = test::sunlit_scene({clusters(60000, 5.0, seed), clusters(900, 3.0, seed + 1)}, {1, -2, 0.5});
  Random random(seed + 2);
  for (int i = 0; i < 12; ++i) {
    Mat4 matrix(0.3);
    matrix[3] = Vec4(Vec3(9.0, 2.0, 9.0) * random.in_ball(), 1.0);
    scene.instances.push_back({"kept", 1, matrix, 0});
  }
  scene.camera = {{0.5, 1.7, 9}, {0, 1.0, 0}, {0, 1, 0}, 0.8};
  return scene;
}

/// Returns the same world, but no block's box says anything.
World without_boxes(World world) {
  for (TriangleBlock& block : world.blocks) block.bounds = {Vec3(-1e100), Vec3(1e100)};
  return world;
}

void expect_same(const LightView& a, const LightView& b) {
  EXPECT_EQ(a.origin, b.origin);
  ASSERT_EQ(a.face_count, b.face_count);
  for (int i = 0; i < a.face_count; ++i) {
    EXPECT_EQ(a.face(i).near_depth, b.face(i).near_depth);
    EXPECT_EQ(a.face(i).far_depth, b.face(i).far_depth);
    EXPECT_EQ(a.face(i).half_extent, b.face(i).half_extent);
    EXPECT_EQ(a.face(i).center, b.face(i).center);
    EXPECT_EQ(a.face(i).warp, b.face(i).warp);
  }
}

TEST(TriangleBlocks, HoldEveryTriangleOnce) {
  for (const InstanceChoice choice : {InstanceChoice::keep, InstanceChoice::flatten}) {
    const Scene scene = clustered_scene(7);
    const World world = make_world(scene, choice);
    std::vector<int> times(world.triangle_count(), 0);
    for (const TriangleBlock& block : world.blocks) {
      const WorldPart& part = world.parts[block.part];
      for (std::uint32_t i = block.first; i < block.first + block.count; ++i) {
        ++times[part.first_triangle + i];
        for (const Vec3& corner : part.corners(i))
          EXPECT_EQ(glm::clamp(corner, block.bounds.min, block.bounds.max), corner);
      }
    }
    EXPECT_EQ(std::count(times.begin(), times.end(), 1), static_cast<std::ptrdiff_t>(times.size()));
  }
}

TEST(TriangleBlocks, AreAllAskedFor) {
  for (const std::uint32_t blocks : {1u, 2u, 3u, 4u, 31u, 32u, 33u, 100u, 127u}) {
    const std::uint32_t count = TriangleBlock::most * (blocks - 1) + 5;
    const Scene scene = test::sunlit_scene({clusters(count, 1.0, blocks)}, {1, -2, 0.5});
    const World world = make_world(scene);
    ASSERT_EQ(world.blocks.size(), blocks);
    std::vector<std::atomic<int>> times(count);
    over_blocks(
        world, 0, [](int, const Aabb&) { return false; },
        [&](int&, const WorldPart&, std::uint32_t triangle) { ++times[triangle]; }, [](int&, int) {});
    EXPECT_TRUE(std::all_of(times.begin(), times.end(), [](const auto& n) { return n == 1; }));
  }
}

TEST(TriangleBlocks, FitsAreThoseOfAllTriangles) {
  Random random(3);
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    Scene scene = clustered_scene(seed);
    const Vec3 away = seed % 2 == 0 ? Vec3(0.0) : Vec3(3e5, -2e5, 1e5);
    for (MeshInstance& instance : scene.instances) instance.world_from_object[3] += Vec4(away, 0.0);
    scene.camera.eye += away, scene.camera.target += away;
    const World world = make_world(scene, seed % 3 == 0 ? InstanceChoice::flatten : InstanceChoice::keep);
    const World all = without_boxes(world);
    for (int i = 0; i < 24; ++i) {
      Light light = scene.lights[0];
      light.direction = random.direction();
      light.position = away + 12.0 * random.in_ball();
      Camera camera = scene.camera;
      camera.eye = camera.target + 12.0 * random.in_ball();
      const auto cascades = [&](const World& w) {
        return *fit_cascades(w, light, camera, 1.5, 256, {.snap = false}, {});
      };
      expect_same(cascades(world), cascades(all));
      const auto warped = [&](const World& w) { return *fit_warped(w, light, camera, 1.5, 256, false); };
      expect_same(warped(world), warped(all));
      for (const LightType type : {LightType::directional, LightType::point}) {
        light.type = type;
        const auto fit = [&](const World& w) { return *fit_light_view(w, light, camera, 1.5, 256); };
        expect_same(fit(world), fit(all));
      }
    }
  }
}

NumberList numbers(std::initializer_list<double> values) {
  NumberList list;
  for (const double value : values) list.push_back(value);
  return list;
}

// A light straight down: right is along x or z, forward is -y; depth from (1, 10, 2) is 10 - y.
TEST(Window, LiesWhereItIsGiven) {
  const Scene scene = test::sunlit_scene({test::box_mesh({-1, 0, -1}, {1, 2, 1})}, {0, -1, 0});
  const World world = make_world(scene);
  const LightWindow window{
      .size = numbers({8, 4}), .origin = numbers({1, 10, 2}), .depths = numbers({0.5, 20})};
  const LightView view = *fit_light_view(world, scene.lights[0], scene.camera, 1.5, 64, window);
  EXPECT_EQ(view.face(0).half_extent, Vec2(4, 2));
  EXPECT_EQ(view.face(0).near_depth, 0.5);
  EXPECT_EQ(view.face(0).far_depth, 20.0);
  const TexelCoordinate middle = project_to_texel(view, {1, 3, 2});
  EXPECT_DOUBLE_EQ(middle.u, 32.0);
  EXPECT_DOUBLE_EQ(middle.v, 32.0);
  EXPECT_DOUBLE_EQ(middle.depth, 7.0);
  EXPECT_DOUBLE_EQ(stored_from_depth(view, 0, 32.0, 0.5), 0.0);
  EXPECT_DOUBLE_EQ(stored_from_depth(view, 0, 32.0, 20.0), 1.0);
  EXPECT_DOUBLE_EQ(texel_world_size(view, 0, 1.0), 8.0 / 64.0);
  Camera aside = scene.camera;
  aside.eye += Vec3(3, 1, 2);
  EXPECT_FALSE(window_moves(world, scene.lights[0], {scene.camera, aside}, 1.5, 64, window));
}

// What is not given stays fitted: an origin moves the window and counts its depths from there, the box still between them.
TEST(Window, FitsWhatIsNotGiven) {
  const Scene scene = test::sunlit_scene({test::box_mesh({-1, 0, -1}, {1, 2, 1})}, {0, -1, 0});
  const World world = make_world(scene);
  const LightView fitted = *fit_light_view(world, scene.lights[0], scene.camera, 1.5, 64);
  const LightView moved =
      *fit_light_view(world, scene.lights[0], scene.camera, 1.5, 64, {.origin = numbers({0, 10, 0})});
  EXPECT_EQ(moved.face(0).half_extent, fitted.face(0).half_extent);
  EXPECT_NEAR(moved.face(0).near_depth, 8.0, 0.01);
  EXPECT_NEAR(moved.face(0).far_depth, 10.0, 0.01);
  const LightView wide =
      *fit_light_view(world, scene.lights[0], scene.camera, 1.5, 64, {.size = numbers({10, 10})});
  EXPECT_EQ(wide.origin, fitted.origin);
  EXPECT_EQ(wide.face(0).half_extent, Vec2(5));
}

TEST(Window, OfASpotLightHasDepthsAlone) {
  Scene scene = test::sunlit_scene({test::box_mesh({-1, 0, -1}, {1, 2, 1})}, {0, -1, 0});
  Light& light = scene.lights[0];
  light.type = LightType::spot, light.position = {0, 10, 0};
  const World world = make_world(scene);
  const auto fit = [&](const LightWindow& window) {
    return fit_light_view(world, light, scene.camera, 1.5, 64, window);
  };
  EXPECT_EQ(fit({.depths = numbers({1, 30})})->face(0).far_depth, 30.0);
  EXPECT_FALSE(fit({.depths = numbers({0, 30})}));
  EXPECT_FALSE(fit({.size = numbers({4, 4})}));
  EXPECT_FALSE(fit({.origin = numbers({4, 4, 4})}));
}

TEST(Window, TellsWhichCastersItHolds) {
  std::vector<Mesh> boxes;
  for (const double x : {0.0, 4.0, 20.0}) boxes.push_back(test::box_mesh({x - 1, 0, -1}, {x + 1, 2, 1}));
  boxes.push_back(test::box_mesh({-1, 7, -1}, {1, 8, 1}));
  boxes.push_back(test::box_mesh({-1, -9, -1}, {1, -8, 1}));
  Scene scene = test::sunlit_scene(std::move(boxes), {0, -1, 0});
  scene.shapes.push_back({"ball", Sphere{{0, 1, 0}, 0.5}, 0});
  const World world = make_world(scene);
  const LightWindow window{.size = numbers({8, 8}), .origin = numbers({0, 5, 0}), .depths = numbers({0, 10})};
  const LightView view = *fit_light_view(world, scene.lights[0], scene.camera, 1.5, 64, window);
  const WindowCasters casters = window_casters(world, view);
  // A box, the ball, and of the box at the border the side that looks into the window; the side beyond it lies beside.
  EXPECT_EQ(casters.inside, 12u + 1u + 2u);
  EXPECT_EQ(casters.cut, 8u);
  EXPECT_EQ(casters.beside, 12u + 2u);
  EXPECT_EQ(casters.before, 12u);
  EXPECT_EQ(casters.beyond, 12u);
  EXPECT_EQ(casters.count(), world.primitive_count());
}

TEST(Cascades, EndWhereTheyAreGiven) {
  Scene scene = test::sunlit_scene({test::box_mesh({-40, 0, -40}, {40, 1, 40})}, {0.3, -1, 0.2});
  scene.camera = {{0.5, 1.7, 9}, {0, 1.0, 0}, {0, 1, 0}, 0.8};
  const World world = make_world(scene);
  CascadeOptions options{.count = 2, .snap = false};
  const auto widths = [&](const NumberList& splits) {
    options.splits = splits;
    const LightView view = *fit_cascades(world, scene.lights[0], scene.camera, 1.5, 64, options, {});
    return Vec2(view.face(0).half_extent.x, view.face(1).half_extent.x);
  };
  EXPECT_LT(widths(numbers({0.5, 4})).x, widths(numbers({2, 4})).x);
  EXPECT_LE(widths(numbers({2, 3})).y, widths(numbers({2, 30})).y);
}

}  // namespace
}  // namespace gnomon
