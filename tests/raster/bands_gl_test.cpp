// Pictures that are made in bands against those made whole: not one bit may differ. Which of the pixels the hybrid's
// sheets decide, and which its rays, is not compared: sheets are refined by what a frame shows.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstring>

#include "hybrid/visibility.h"
#include "raster/bands.h"
#include "raster/technique_traits.h"
#include "raytrace/frame.h"
#include "scene/base/interruptible.h"
#include "scene/load.h"

namespace gnomon::test {
namespace {

constexpr ImageSize size{150, 170};  // three bands, the last of 42 rows

struct Stage {
  explicit Stage(const std::string& name) : scene(*load_scene(name)), world(make_world(scene)) {
    plan = plan_effects(scene);
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i) lights.push_back(i);
  }
  Scene scene;
  World world;
  EffectPlan plan;
  std::vector<std::uint32_t> lights;
};

template <class T>
bool same_bits(const Image<T>& whole, const Image<T>& part, const PictureRows& rows) {
  if (whole.data.empty()) return part.data.empty();
  return part.size == ImageSize{whole.size.width, rows.count} &&
         std::memcmp(&whole.at(0, rows.first), part.data.data(), part.data.size() * sizeof(T)) == 0;
}

// Field by field, for what lies between them is of no value.
bool same_points(const Image<raytrace::SurfacePoint>& whole, const Image<raytrace::SurfacePoint>& part,
                 const PictureRows& rows) {
  if (whole.data.empty()) return part.data.empty();
  bool same = part.size == ImageSize{whole.size.width, rows.count};
  for (std::size_t i = 0; same && i < part.data.size(); ++i) {
    const raytrace::SurfacePoint &a = whole.data[whole.index(0, rows.first) + i], &b = part.data[i];
    same = a.primitive == b.primitive && a.position == b.position && a.position_error == b.position_error &&
           a.normal == b.normal && a.barycentric == b.barycentric;
  }
  return same;
}

class TracedBands : public testing::TestWithParam<const char*> {};

TEST_P(TracedBands, AreTheWholesRows) {
  Stage stage(GetParam());
  for (const auto& [records, per_pixel] : {std::pair(true, 1), std::pair(false, 1), std::pair(true, 3)}) {
    raytrace::RaytraceOptions options;
    options.size = size, options.seed = 7, options.shadow_samples = 8;
    options.records = records, options.samples_per_pixel = per_pixel;
    const raytrace::Tracer tracer(stage.world, raytrace::Accel::bvh);
    const auto whole = raytrace::trace_frame(tracer, stage.plan, stage.scene.camera, stage.lights, options);
    raytrace::RayTracedFrame costs;
    for (const PictureRows& rows : bands_of(size, band_step)) {
      const auto band =
          raytrace::trace_band(tracer, stage.plan, stage.scene.camera, stage.lights, options, rows);
      EXPECT_TRUE(same_bits(whole.color, band.color, rows)) << rows.first;
      EXPECT_TRUE(same_points(whole.receiver, band.receiver, rows)) << rows.first;
      ASSERT_EQ(whole.lights.size(), band.lights.size());
      for (std::size_t i = 0; i < whole.lights.size(); ++i) {
        EXPECT_TRUE(same_bits(whole.lights[i].centre, band.lights[i].centre, rows)) << rows.first;
        EXPECT_TRUE(same_bits(whole.lights[i].visibility, band.lights[i].visibility, rows)) << rows.first;
        EXPECT_TRUE(same_bits(whole.lights[i].standard_error, band.lights[i].standard_error, rows));
      }
      raytrace::add_costs(band, costs);
    }
    EXPECT_EQ(whole.rays.primary, costs.rays.primary);
    EXPECT_EQ(whole.rays.shadow, costs.rays.shadow);
    EXPECT_EQ(whole.rays.soft_shadow, costs.rays.soft_shadow);
    EXPECT_EQ(whole.rays.reflection, costs.rays.reflection);
    EXPECT_EQ(whole.rays.interior, costs.rays.interior);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, TracedBands, testing::Values("fence", "penumbra", "whitted", "shapes"));

void expect_rows(const raster::RasterFrame& whole, const raster::RasterFrame& band, const PictureRows& rows) {
  EXPECT_TRUE(same_bits(whole.color, band.color, rows)) << rows.first;
  EXPECT_TRUE(same_bits(whole.primitive, band.primitive, rows)) << rows.first;
  for (std::size_t i = 0; i < whole.lights.size(); ++i) {
    const raster::LightRecord &a = whole.lights[i], &b = band.lights[i];
    EXPECT_TRUE(same_bits(a.visibility, b.visibility, rows)) << rows.first;
    EXPECT_TRUE(same_bits(a.texel_uv, b.texel_uv, rows)) << rows.first;
    EXPECT_TRUE(same_bits(a.face, b.face, rows)) << rows.first;
    EXPECT_TRUE(same_bits(a.distance, b.distance, rows)) << rows.first;
    EXPECT_TRUE(same_bits(a.gap, b.gap, rows)) << rows.first;
    EXPECT_TRUE(same_bits(a.outside_map, b.outside_map, rows)) << rows.first;
    EXPECT_TRUE(same_bits(a.lookups, b.lookups, rows)) << rows.first;
    EXPECT_EQ(a.map.depth, b.map.depth) << rows.first;
    EXPECT_EQ(a.bias_constant_world, b.bias_constant_world);
  }
}

struct DrawnCase {
  const char* scene;
  raster::Technique technique;
};

class DrawnBands : public testing::TestWithParam<DrawnCase> {
 protected:
  void SetUp() override {
    auto context = raster::create_context(raster::Backend::automatic);
    ASSERT_TRUE(context);
    auto made = raster::Renderer::create(std::move(*context), stage.world, stage.plan);
    ASSERT_TRUE(made);
    renderer = std::move(*made);
    renderer->use_external_visibility(raster::Technique::hybrid, hybrid::make_visibility(stage.world));
    options.size = size, options.map.size = 128, options.runs = 1, options.shadow_cost = true;
    options.map.technique = GetParam().technique;
    options.analysis = true, options.seed = 3, options.shadow_samples = 8;
  }
  Expected<raster::RasterFrame> render() const { return renderer->render(options, stage.lights); }

  Stage stage{GetParam().scene};
  raster::RasterOptions options;
  std::unique_ptr<raster::Renderer> renderer;
};

TEST_P(DrawnBands, AreTheWholesRows) {
  const auto whole = render();
  ASSERT_TRUE(whole) << whole.error().reason;
  raster::RasterFrame costs;
  for (const PictureRows& rows : bands_of(size, band_step)) {
    raster::set_rows(*renderer, rows);
    const auto band = render();
    ASSERT_TRUE(band) << band.error().reason;
    expect_rows(*whole, *band, rows);
    raster::add_costs(*band, costs);
  }
  EXPECT_EQ(whole->map_texels, costs.map_texels);
}

// Work that may be left is drawn in stripes; and wherever it is left, the next frame is drawn as if it had not been begun.
TEST_P(DrawnBands, AreWholeInStripesAndAfterOnesThatWereLeft) {
  options.map.filter.blur_radius_texels = 2;
  const auto whole = render();
  ASSERT_TRUE(whole) << whole.error().reason;
  const PictureRows rows{0, size.height};
  std::atomic<int> asked{0};
  {
    const Interruptible work([&] { return ++asked, false; });
    const auto striped = render();
    ASSERT_TRUE(striped) << striped.error().reason;
    expect_rows(*whole, *striped, rows);
  }
  const int most = asked;
  for (const int share : {0, 1, 3, 5, 7}) {
    asked = 0;
    {
      const Interruptible work([&, last = most * share / 16] { return ++asked > last; });
      EXPECT_FALSE(render()) << share;
    }
    const auto again = render();
    ASSERT_TRUE(again) << again.error().reason;
    expect_rows(*whole, *again, rows);
  }
}

using raster::Technique;
INSTANTIATE_TEST_SUITE_P(
    Techniques, DrawnBands,
    testing::Values(DrawnCase{"fence", Technique::hard}, DrawnCase{"whitted", Technique::pcf},
                    DrawnCase{"penumbra", Technique::pcss}, DrawnCase{"fence", Technique::vsm},
                    DrawnCase{"fence", Technique::msm}, DrawnCase{"fence", Technique::csm},
                    DrawnCase{"shapes", Technique::hard}, DrawnCase{"fence", Technique::izb},
                    DrawnCase{"shapes", Technique::izb}, DrawnCase{"penumbra", Technique::hybrid},
                    DrawnCase{"fence", Technique::hybrid}));

}  // namespace
}  // namespace gnomon::test
