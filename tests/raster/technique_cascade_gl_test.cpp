// Cascades and the warp: what stands still keeps its shadow while the camera moves by parts of a texel; finer
// texels near the eye; the lights and sizes they are made for.
#include "tests/support/compare_support.h"
#include "tests/support/one_world.h"
#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

Scene street() {
  Scene scene = still_life();
  scene.meshes[1] = square_mesh(30.0);
  for (int i = 0; i < 12; ++i)
    scene.instances.push_back({"post", 0, placed({-2.0 + 0.9 * (i % 3), 0.4, -1.5 * i}, 0.6), 1});
  scene.lights = {sun({0.6, -1.0, 0.35})};
  scene.camera.eye = {0.4, 1.7, 6.0};
  scene.camera.target = {0.3, 0.6, 0.0};
  return scene;
}

raster::RasterOptions cascade_options() {
  raster::RasterOptions options = small_options(256);
  options.size = {64, 48};
  options.map.technique = raster::Technique::csm;
  options.map.cascades.count = 3;
  options.map.bias = {1.0, raster::BiasUnit::texel};
  return options;
}

/// Ground points before the camera, not under the things that stand there.
std::vector<Vec3> static_receivers() {
  std::vector<Vec3> points;
  for (int i = 0; i < 20000; ++i) {
    const double a = std::fmod(i * 0.6180339887498949, 1.0), b = (i + 0.5) / 20000;
    points.emplace_back(-6.0 + 12.0 * a, 0.0, 4.0 - 22.0 * b);
  }
  return points;
}

struct Seen {
  bool lit;
  int face;
};

// The hard test of a ground point, in double precision from the map read back.
Seen look_up(const raster::LightRecord& record, const Vec3& point) {
  const LightView& view = record.map.view;
  const TexelCoordinate t = project_to_texel(view, point);
  if (!t.inside) return {true, t.face};
  const double stored = record.map.depth[record.map.texel_index(t.face, t.column(), t.row())];
  if (!holds_caster(view, stored)) return {true, t.face};
  const double gap = t.depth - depth_from_stored(view, t.face, t.row() + 0.5, stored);
  const double bias =
      record.bias_constant_world * texel_world_size(view, t) / record.rounding.constant_texel_world;
  return {!(gap > bias), t.face};
}

struct Flips {
  int all = 0, same_cascade = 0;
};

Flips count_flips(const raster::RasterOptions& options, const Vec3& step, int steps) {
  Drawn drawn = make_drawn(street());
  const std::vector<Vec3> points = static_receivers();
  std::vector<Seen> before;
  Flips flips;
  for (int k = 0; k <= steps; ++k) {
    drawn.render(options);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Seen now = look_up(drawn.light(), points[i]);
      if (k == 0) {
        before.push_back(now);
        continue;
      }
      flips.all += now.lit != before[i].lit;
      flips.same_cascade += now.lit != before[i].lit && now.face == before[i].face;
      before[i] = now;
    }
    drawn.scene->camera.eye += step, drawn.scene->camera.target += step;
  }
  return flips;
}

// 100 steps that add up to nine tenths of the finest texel: the grid moves by at most one texel.
TEST(Cascades, WithSnappingNothingThatStandsStillFlips) {
  raster::RasterOptions options = cascade_options();
  Drawn drawn = draw(street(), options);
  const double texel = texel_world_size(drawn.light().map.view, 0, 1.0);
  const Vec3 step = 0.009 * texel * glm::normalize(Vec3(0.8, 0.1, 0.6));
  const Flips snapped = count_flips(options, step, 100);
  options.map.cascades.snap = false;
  const Flips free = count_flips(options, step, 100);
  std::printf("  20000 receivers, 100 steps of 0.009 texel: flips with snapping %d, without %d\n",
              snapped.all, free.all);
  EXPECT_EQ(snapped.all, 0);
  EXPECT_GT(free.all, 100);
}

// Steps of a third of a texel over 33 texels: what stays in its cascade still does not flip.
TEST(Cascades, WithSnappingLongWaysFlipOnlyWhatChangesItsCascade) {
  raster::RasterOptions options = cascade_options();
  Drawn drawn = draw(street(), options);
  const double texel = texel_world_size(drawn.light().map.view, 0, 1.0);
  const Vec3 step = 0.33 * texel * glm::normalize(Vec3(0.8, 0.1, 0.6));
  const Flips snapped = count_flips(options, step, 100);
  options.map.cascades.snap = false;
  const Flips free = count_flips(options, step, 100);
  std::printf("  100 steps of 0.33 texel: flips with snapping %d (in one cascade %d), without %d\n",
              snapped.all, snapped.same_cascade, free.all);
  EXPECT_EQ(snapped.same_cascade, 0);
  EXPECT_LT(20 * snapped.all, free.all);
}

TEST(Cascades, GiveFinerTexelsNearTheEye) {
  for (const bool fit_samples : {false, true}) {
    raster::RasterOptions options = cascade_options();
    options.map.cascades.fit_samples = fit_samples;
    const Drawn drawn = draw(street(), options);
    const LightView& view = drawn.light().map.view;
    ASSERT_EQ(view.face_count, 3);
    for (int i = 1; i < 3; ++i) EXPECT_LE(texel_world_size(view, i - 1, 1.0), texel_world_size(view, i, 1.0));
    options.map.technique = raster::Technique::hard;
    const Drawn hard = draw(street(), options);
    EXPECT_LT(3.0 * texel_world_size(view, 0, 1.0), texel_world_size(hard.light().map.view, 0, 1.0));
    // Every pixel that shows something looks up the cascade that the view says.
    int inside = 0;
    for (std::size_t i = 0; i < drawn.light().face.data.size(); ++i) inside += drawn.light().face.data[i] < 3;
    EXPECT_EQ(inside, int(drawn.light().face.data.size()));
  }
}

TEST(Cascades, AreForDirectionalLightsAndCubesForPointLights) {
  Scene scene = still_life();
  scene.lights = {lamp(LightType::spot, {2, 6, 3}, {0, 0, 0})};
  Drawn drawn = make_drawn(scene);
  raster::RasterOptions options = small_options(64);
  const std::vector<std::uint32_t> lights{0};
  for (const auto technique : {raster::Technique::csm, raster::Technique::lispsm, raster::Technique::cube}) {
    options.map.technique = technique;
    const auto frame = drawn.renderer->render(options, lights);
    ASSERT_FALSE(frame.has_value());
    EXPECT_EQ(frame.error().kind, ErrorKind::usage);
    EXPECT_NE(frame.error().message().find("allowed"), std::string::npos) << frame.error().message();
    EXPECT_TRUE(drawn.renderer->render(options, {}).has_value())
        << "a light that is not compared only lights the picture";
  }
  options.map.technique = raster::Technique::csm;
  options.map.size = drawn.renderer->info().max_map_size + 1;
  const auto frame = drawn.renderer->render(options, {});
  ASSERT_FALSE(frame.has_value());
  EXPECT_EQ(frame.error().kind, ErrorKind::graphics);
}

// The warp's promise (Wimmer et al. 2004): texels that are finer near the eye than far away, on the same map
// size.
TEST(Lispsm, SpendsItsTexelsNearTheEye) {
  raster::RasterOptions options = cascade_options();
  options.map.technique = raster::Technique::lispsm;
  const Drawn drawn = draw(street(), options);
  const LightView& view = drawn.light().map.view;
  ASSERT_GT(view.face(0).warp, 0.0);
  const double near = texel_world_size(view, project_to_texel(view, {0.4, 0.0, 3.0}));
  const double far = texel_world_size(view, project_to_texel(view, {0.4, 0.0, -14.0}));
  EXPECT_LT(2.0 * near, far);
  options.map.technique = raster::Technique::hard;
  const Drawn hard = draw(street(), options);
  EXPECT_LT(near, 0.7 * texel_world_size(hard.light().map.view, 0, 1.0));
}

}  // namespace
}  // namespace gnomon::test
