// Texel lists against brute force, and sheets: one surface is one sheet however it is tessellated, its
// outline is a boundary, and what the sheets promise about shadows is what the rays find.
#include <gtest/gtest.h>

#include <set>

#include "raytrace/frame.h"
#include "raytrace/sheets.h"
#include "raytrace_support.h"
#include "scene/cascade_fit.h"

namespace gnomon {
namespace {

using raytrace::Accel;
using raytrace::PointVisibility;
using raytrace::Sheet;
using raytrace::TexelKey;
using raytrace::TexelLists;
using raytrace::Topology;
using raytrace::Tracer;
using test::Random;
using test::TestWorld;

/// Straight down on [-half, half]^2 of x and z.
LightView downwards(int size, double half) {
  LightView view;
  view.size = size;
  LightFace& face = view.faces[0];
  face.right = {1, 0, 0}, face.up = {0, 0, -1}, face.forward = {0, -1, 0};
  view.set_extent(Vec2(half), -10.0, 10.0);
  return view;
}

/// The same, off the middle and warped: rows at low y are 2.3 times as fine as those at high y.
LightView warped(int size, double half) {
  LightView view = downwards(size, 0.9 * half);
  view.faces[0].center = {0.05 * half, -0.03 * half};
  view.faces[0].warp = 0.4 / (0.9 * half);
  return view;
}

/// The cube map of a point light.
LightView around(const Vec3& position, int size) {
  Scene scene = test::scene_of({}, {test::sphere(position + Vec3(0, -1, 0), 0.1)});
  const TestWorld w(scene);
  return fit_light_view(w.world(), test::point_light(position), Camera{}, 1.0, size).value();
}

LightView spot_down(const Vec3& position, double angle, int size) {
  Light light = test::point_light(position);
  light.type = LightType::spot, light.direction = {0, -1, 0}, light.outer_angle = angle;
  const TestWorld w(test::scene_of({}, {test::sphere(position + Vec3(0, -1, 0), 0.1)}));
  return fit_light_view(w.world(), light, Camera{}, 1.0, size).value();
}

std::vector<TexelKey> all_keys(const LightView& view) {
  std::vector<TexelKey> keys;
  for (int face = 0; face < view.face_count; ++face)
    for (int row = 0; row < view.size; ++row)
      for (int column = 0; column < view.size; ++column) keys.push_back(TexelKey::pack(face, column, row));
  return keys;
}

/// A world, its tracer, topology and the lists of every texel of a map.
struct Columns {
  const World& world;
  LightView view;
  Topology topology;
  TexelLists lists;
  Columns(const World& w, const LightView& v)
      : world(w), view(v), topology(w), lists(build_texel_lists(Tracer(w, Accel::bvh), v, all_keys(v))) {}
  std::vector<Sheet> sheets(TexelKey key) const {
    return find_sheets(world, topology, view, key, lists[lists.find(key)]);
  }
  std::vector<Sheet> sheets_at(const Vec3& p) const {
    const TexelCoordinate t = project_to_texel(view, p);
    return sheets(TexelKey::pack(t.face, t.column(), t.row()));
  }
};

/// y = waves(x, z) over [-half, half]^2; a slope of at most 1.3.
Mesh waves(int steps, double half) {
  Mesh mesh;
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i <= steps; ++i) {
      const double x = half * (2.0 * i / steps - 1.0), z = half * (2.0 * j / steps - 1.0);
      mesh.positions.emplace_back(x, 0.3 * std::sin(3.0 * x) * std::cos(2.0 * z), z);
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (steps + 1) + i); };
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < steps; ++i) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      mesh.triangles.push_back({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  return mesh;
}

TEST(Topology, WeldsByPositionAndFindsNeighbours) {
  Mesh split =
      test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});  // the second triangle on vertices of its own, one at -0
  split.positions.insert(split.positions.end(), {{-0.0, 0, 0}, {1, 1, 0}, {0, 1, -0.0}});
  split.triangles = {{0, 1, 2}, {4, 5, 6}};
  const TestWorld w(test::scene_of({split}));
  const Topology t(w.world());
  EXPECT_EQ(t.across(0, 2), 1U);
  EXPECT_EQ(t.across(1, 0), 0U);
  EXPECT_EQ(t.across(0, 0), Topology::boundary);
  EXPECT_EQ(t.welded(0, 0), t.welded(1, 0));
  EXPECT_NE(t.welded(0, 1), t.welded(1, 1));
}

TEST(Topology, NonManifoldAndInconsistentEdgesAreSaid) {
  Mesh fan;
  fan.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}};
  fan.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  const TestWorld w(test::scene_of({fan}));
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(Topology(w.world()).across(i, 0), Topology::non_manifold);
  fan.triangles = {{0, 1, 2}, {0, 1, 3}};
  const TestWorld w2(test::scene_of({fan}));
  EXPECT_EQ(Topology(w2.world()).across(0, 0), Topology::non_manifold);
}

TEST(TexelLists, HoldEveryPrimitiveThatARayOfTheColumnMeets) {
  Scene scene = test::scene_of({test::triangle_soup(400, 2.0, 0.5, 41)},
                               {test::sphere({0.5, 0, 0}, 0.4), test::plane({0, -3, 0}, {0, 1, 0})});
  const TestWorld w(scene);
  const Tracer brute(w.world(), Accel::brute);
  Random random(42);
  for (const LightView& view : {downwards(32, 3.0), warped(32, 3.0), around({0.3, 0.2, -0.1}, 16),
                                spot_down({0.1, 6, 0.2}, 0.6, 32)}) {
    const Columns columns(w.world(), view);
    const TexelLists from_brute = build_texel_lists(brute, view, all_keys(view));
    EXPECT_EQ(columns.lists.primitives, from_brute.primitives);
    EXPECT_EQ(columns.lists.offsets, from_brute.offsets);
    for (int i = 0; i < 20000; ++i) {
      const auto face = static_cast<int>(random.below(static_cast<std::uint32_t>(view.face_count)));
      const double u = random.uniform(0.0, view.size), v = random.uniform(0.0, view.size);
      const std::size_t at =
          columns.lists.find(TexelKey::pack(face, static_cast<int>(u), static_cast<int>(v)));
      Ray ray = texel_ray(view, face, u, v);
      for (int depth = 0; depth < 4; ++depth) {  // the first hits along the ray
        const auto hit = brute.closest_hit(ray);
        if (!hit) break;
        ASSERT_TRUE(std::binary_search(columns.lists[at].begin(), columns.lists[at].end(), hit->primitive));
        ray.t.min = hit->t;
      }
    }
  }
}

TEST(TexelLists, AreTight) {
  // A triangle over half the map: texels beyond its slanted side must not list it.
  Mesh mesh;
  mesh.positions = {{-1, 0, -1}, {-1, 0, 1}, {1, 0, -1}};
  mesh.triangles = {{0, 1, 2}};
  const TestWorld w(test::scene_of({mesh}));
  const Columns columns(w.world(), downwards(64, 1.0));
  EXPECT_LE(columns.lists.primitives.size(), 64U * 65U / 2U + 2U * 64U);
  EXPECT_GE(columns.lists.primitives.size(), 64U * 65U / 2U);
}

TEST(Sheets, WavyHeightFieldIsOneSheetWithoutBoundary) {
  for (const int steps : {8, 40, 200}) {
    const TestWorld w(test::scene_of({waves(steps, 2.0)}));
    for (const LightView& view : {downwards(16, 1.5), warped(16, 1.3), spot_down({0.1, 7, 0.2}, 0.2, 16)}) {
      const Columns columns(w.world(), view);
      for (const TexelKey key : columns.lists.keys) {
        const auto sheets = columns.sheets(key);
        ASSERT_EQ(sheets.size(), 1U) << steps;
        ASSERT_FALSE(sheets[0].has_boundary) << steps;
        ASSERT_TRUE(sheets[0].faces_light);
      }
    }
  }
}

TEST(Sheets, HeightFieldsBorderIsABoundary) {
  const TestWorld w(test::scene_of({waves(20, 1.0)}));
  const Columns columns(w.world(), downwards(31, 1.5));
  const auto inside = columns.sheets_at({0.5, 0, 0.5});
  ASSERT_EQ(inside.size(), 1U);
  EXPECT_FALSE(inside[0].has_boundary);
  const auto border = columns.sheets_at({1.0, 0, 0.3});
  ASSERT_EQ(border.size(), 1U);
  EXPECT_TRUE(border[0].has_boundary);
  EXPECT_TRUE(columns.sheets_at({1.3, 0, 0.3}).empty());
}

TEST(Sheets, ClosedSphereHasTwoSheetsAndABoundaryAtItsOutline) {
  const TestWorld w(test::scene_of({test::uv_sphere({0, 0, 0}, 1.0, 40, 60, 0.0, 1)}, {}));
  for (const LightView& view :
       {downwards(32, 1.2), warped(32, 1.4), around({0, 4, 0}, 32), spot_down({0.0, 4, 0.0}, 0.3, 32)}) {
    const Columns columns(w.world(), view);
    const auto middle = columns.sheets_at({0.31, 0, 0.17});
    ASSERT_EQ(middle.size(), 2U);
    for (const Sheet& s : middle) EXPECT_FALSE(s.has_boundary);
    const Sheet& front = middle[middle[0].faces_light ? 0 : 1];
    const Sheet& back = middle[middle[0].faces_light ? 1 : 0];
    EXPECT_TRUE(front.faces_light);
    EXPECT_FALSE(back.faces_light);
    EXPECT_LT(front.farthest, back.nearest);
    const double outline =
        view.projection == LightProjection::perspective ? std::sqrt(1.0 - 1.0 / 16.0) : 1.0;
    const auto edge =
        columns.sheets_at({outline, view.projection == LightProjection::perspective ? 0.25 : 0.0, 0});
    ASSERT_FALSE(edge.empty());
    for (const Sheet& s : edge) EXPECT_TRUE(s.has_boundary);
  }
}

TEST(Sheets, ParallelQuadsAreTwoSheets) {
  const TestWorld w(test::scene_of(
      {test::quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}), test::quad({-2, 1, -2}, {0, 0, 4}, {4, 0, 0})}));
  const Columns columns(w.world(), downwards(8, 1.0));
  for (const TexelKey key : columns.lists.keys) {
    const auto sheets = columns.sheets(key);
    ASSERT_EQ(sheets.size(), 2U);
    for (const Sheet& s : sheets) ASSERT_FALSE(s.has_boundary);
    // Two triangles each: 0 and 1 below, 2 and 3 above.
    const std::size_t lower = sheets[0].primitives[0] < 2 ? 0 : 1, upper = 1 - lower;
    ASSERT_GE(sheets[upper].primitives[0], 2U);
    ASSERT_EQ(sheet_of(sheets, sheets[upper].primitives[0], true), upper);
    ASSERT_NEAR(sheets[upper].nearest, -1.0, 1e-12);
    ASSERT_NEAR(sheets[lower].farthest, 0.0, 1e-12);
    ASSERT_LE(sheets[upper].nearest, -1.0);
    ASSERT_GE(sheets[lower].farthest, 0.0);
  }
  // Primitives beside the column, given all the same, make no sheet of their own.
  const std::vector<std::uint32_t> all{0, 1, 2, 3};
  EXPECT_EQ(find_sheets(w.world(), columns.topology, columns.view, TexelKey::pack(0, 0, 0), all).size(), 2U);
  EXPECT_EQ(sheet_of(columns.sheets(columns.lists.keys[0]), 99, true), 2U);
}

TEST(Sheets, NonManifoldEdgeIsABoundary) {
  Mesh fins =
      test::quad({-1, 0, -1}, {0, 0, 2}, {1, 0, 0});  // two quads meet at x = 0, and a fin stands on the seam
  for (const Mesh& more :
       {test::quad({0, 0, -1}, {0, 0, 2}, {1, 0, 0}), test::quad({0, 0, -1}, {0.2, 1, 0}, {0, 0, 2})}) {
    const auto base = static_cast<std::uint32_t>(fins.positions.size());
    fins.positions.insert(fins.positions.end(), more.positions.begin(), more.positions.end());
    for (const auto& t : more.triangles) fins.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
  const TestWorld w(test::scene_of({fins}));
  const Columns columns(w.world(), downwards(10, 1.05));
  for (const Sheet& s : columns.sheets_at({0.0, 0, 0.3})) EXPECT_TRUE(s.has_boundary);
  for (const Sheet& s : columns.sheets_at({-0.6, 0, 0.3})) EXPECT_FALSE(s.has_boundary);
}

TEST(Sheets, FanThatWindsTwiceIsABoundary) {
  // A spiral stair round the y axis: two turns, closed on itself below, so that every edge is shared by two
  // triangles.
  const auto fan = [](int turns) {
    Mesh mesh;
    mesh.positions.emplace_back(0.0, 0.0, 0.0);
    const int n = 8 * turns;
    for (int i = 0; i < n; ++i) {
      const double a = 2.0 * pi * i / 8.0, rise = turns == 1 ? 0.0 : 0.4 * std::sin(pi * i / n);
      mesh.positions.emplace_back(3.0 * std::cos(a), rise, -3.0 * std::sin(a));
    }
    for (int i = 0; i < n; ++i)
      mesh.triangles.push_back(
          {0U, static_cast<std::uint32_t>(1 + i), static_cast<std::uint32_t>(1 + (i + 1) % n)});
    return mesh;
  };
  // The same position may not appear twice, or welding would make edges of four triangles: rise keeps them
  // apart.
  for (const int turns : {1, 2}) {
    const TestWorld w(test::scene_of({fan(turns)}));
    const Columns columns(w.world(), downwards(9, 1.0));
    const auto sheets = columns.sheets_at({0, 0, 0});
    ASSERT_EQ(sheets.size(), 1U);
    EXPECT_EQ(sheets[0].has_boundary, turns == 2);
    EXPECT_EQ(sheets[0].primitives.size(), 8U * static_cast<unsigned>(turns));
  }
}

TEST(Sheets, MaskedTrianglesAreBoundary) {
  Scene scene = test::scene_of({test::quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0})});
  scene.materials[0].alpha_mode = AlphaMode::mask;
  const TestWorld w(scene);
  EXPECT_TRUE(Columns(w.world(), downwards(8, 1.0)).sheets_at({0.1, 0, 0.1})[0].has_boundary);
}

TEST(Sheets, EdgeOnTriangleIsABoundary) {
  const TestWorld w(test::scene_of({test::quad({0.1, -1, -2}, {0, 2, 0}, {0, 0, 4})}));
  const auto sheets = Columns(w.world(), downwards(8, 1.0)).sheets_at({0.1, 0, 0.1});
  ASSERT_FALSE(sheets.empty());
  for (const Sheet& s : sheets) EXPECT_TRUE(s.has_boundary);
}

/// What sheets promise (see DESIGN's second use of them), held against the exact visibility at every pixel.
using Fit = Expected<LightView> (*)(const World&, const Light&, const Camera&, double, int);
Expected<LightView> three_cascades(const World& world, const Light& light, const Camera& camera,
                                   double aspect, int size) {
  return fit_cascades(world, light, camera, aspect, size, {.count = 3}, {});
}

void expect_sheets_keep_their_word(const Scene& scene, int map_size, double least_sure,
                                   Fit fit = fit_light_view) {
  const TestWorld w(scene);
  const Tracer tracer(w.world(), Accel::bvh);
  const Topology topology(w.world());
  raytrace::RaytraceOptions options;
  options.size = {240, 160}, options.picture = false;
  std::vector<std::uint32_t> lights(scene.lights.size());
  for (std::uint32_t i = 0; i < lights.size(); ++i) lights[i] = i;
  const auto frame = trace_frame(tracer, plan_effects(w.scene()), scene.camera, lights, options);
  for (const auto& truth : frame.lights) {
    const Light& light = scene.lights[truth.light];
    const LightView view = fit(w.world(), light, scene.camera, 1.5, map_size).value();
    int sure = 0, tried = 0;
    for (std::size_t i = 0; i < frame.receiver.data.size(); ++i) {
      const raytrace::SurfacePoint& p = frame.receiver.data[i];
      if (p.primitive == no_id || light_cannot_reach(light, p.position, p.normal)) continue;
      const TexelCoordinate t = project_to_texel(view, p.position);
      if (!t.inside) continue;
      const TexelKey key = TexelKey::pack(t.face, t.column(), t.row());
      const TexelLists list = build_texel_lists(tracer, view, {key});
      const auto sheets = find_sheets(w.world(), topology, view, key, list[0]);
      const Vec3 to_light =
          light.type == LightType::directional ? -light.direction : light.position - p.position;
      const bool faces = glm::dot(geometric_normal(w.world(), p.primitive, p.position), to_light) > 0.0;
      const std::size_t own = sheet_of(sheets, p.primitive, faces);
      ASSERT_LT(own, sheets.size()) << i;
      const double slack = 1e-12 * (1.0 + std::abs(t.distance));
      ASSERT_LE(sheets[own].nearest, t.distance + slack) << i;
      ASSERT_GE(sheets[own].farthest, t.distance - slack) << i;
      bool lit = !sheets[own].has_boundary, shadowed = false;
      for (std::size_t j = 0; j < sheets.size(); ++j) {
        if (j == own) continue;
        lit = lit && sheets[j].nearest > t.distance;
        shadowed = shadowed || (!sheets[j].has_boundary && sheets[j].farthest < t.distance);
      }
      ++tried, sure += lit || shadowed ? 1 : 0;
      if (!lit && !shadowed) continue;
      ASSERT_EQ(truth.centre.data[i], shadowed ? PointVisibility::shadowed : PointVisibility::lit) << i;
    }
    EXPECT_GT(tried, 3000);
    EXPECT_GT(sure, least_sure * tried);
  }
}

TEST(Sheets, KeepTheirWordOnASceneOfEverything) {
  Scene scene = test::scene_of({waves(30, 3.0), test::uv_sphere({0.8, 1.0, 0.4}, 0.6, 24, 32, 0.02, 43),
                                test::box({-1.5, 0.5, -1}, {-0.7, 1.4, 0})},
                               {test::sphere({-0.4, 1.3, 1.2}, 0.4), test::plane({0, -0.5, 0}, {0, 1, 0}),
                                test::sphere({0, 0, 0}, 20.0)});
  scene.lights = {test::sun({-0.5, -1, -0.4}), test::point_light({1.0, 3.5, 1.5}),
                  test::point_light({-1.5, 4, 2})};
  scene.lights[2].type = LightType::spot, scene.lights[2].direction = glm::normalize(Vec3(1.5, -4, -2)),
  scene.lights[2].outer_angle = 0.5;
  scene.camera.eye = {1, 4, 7};
  // The sky sphere holds the camera and the lights; a sun would be shadowed by it everywhere, so it sees the
  // rest alone.
  Scene open = scene;
  open.shapes.pop_back();
  open.lights.resize(1);
  expect_sheets_keep_their_word(open, 256, 0.85);
  const auto warped = [](const World& world, const Light& light, const Camera& camera, double aspect,
                         int size) { return fit_warped(world, light, camera, aspect, size); };
  expect_sheets_keep_their_word(open, 256, 0.85, warped);
  expect_sheets_keep_their_word(open, 256, 0.85, three_cascades);
  scene.lights.erase(scene.lights.begin());
  expect_sheets_keep_their_word(scene, 256, 0.85);
}

}  // namespace
}  // namespace gnomon
