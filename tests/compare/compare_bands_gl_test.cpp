// A comparison in bands against the same in one piece: every number, picture, channel and the page's data, to the last
// bit.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "compare/compare.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/picture_set.h"
#include "hybrid/visibility.h"
#include "report/page.h"
#include "report/pixels/page_data.h"
#include "scene/load.h"
#include "tests/support/temporary_folder.h"

namespace gnomon::test {
namespace {

using namespace compare;  // its functions, by their names

struct BandCase {
  const char* scene;
  raster::Technique technique;
  raster::Bias bias{};
  ImageSize size{160, 330};  ///< six bands, the last of ten rows; more rows than edges depend on
};

/// More rows than are kept for the widths of soft shadows.
constexpr ImageSize tall{40, compare::penumbra_rows_kept + 300};

class CompareBands : public testing::TestWithParam<BandCase> {
 protected:
  CompareBands() : scene_(*load_scene(GetParam().scene)), world_(make_world(scene_)) {
    for (std::uint32_t i = 0; i < scene_.lights.size(); ++i) lights_.push_back(i);
    options_.raster.size = options_.raytrace.size = GetParam().size;
    options_.raster.map.size = 128;
    options_.raster.map.technique = GetParam().technique;
    options_.raster.map.bias = GetParam().bias;
    options_.raytrace.shadow_samples = 16;
    options_.raytrace.seed = 5;
  }

  std::unique_ptr<raster::Renderer> renderer() {
    auto made = raster::Renderer::create(std::move(*raster::create_context(raster::Backend::automatic)),
                                         world_, plan_effects(scene_));
    EXPECT_TRUE(made);
    (*made)->use_external_visibility(raster::Technique::hybrid, hybrid::make_visibility(world_));
    return std::move(*made);
  }
  std::string path(const char* name) const { return folder_ / name; }

  Scene scene_;
  World world_;
  std::vector<std::uint32_t> lights_;
  compare::CompareOptions options_;
  const test::TemporaryFolder folder_;
};

void expect_same(const compare::EncodedPicture& whole, const compare::EncodedPicture& banded) {
  EXPECT_EQ(whole.file_name, banded.file_name);
  EXPECT_EQ(whole.size, banded.size) << whole.file_name;
  EXPECT_TRUE(whole.png == banded.png) << whole.file_name;
}

void expect_same(const compare::PictureSet& whole, const compare::PictureSet& banded) {
  expect_same(whole.raster, banded.raster);
  expect_same(whole.raytraced, banded.raytraced);
  ASSERT_EQ(whole.lights.size(), banded.lights.size());
  for (std::size_t i = 0; i < whole.lights.size(); ++i) {
    const compare::LightPictures &a = whole.lights[i], &b = banded.lights[i];
    expect_same(a.difference, b.difference), expect_same(a.labels, b.labels), expect_same(a.error, b.error);
    expect_same(a.flip, b.flip), expect_same(a.ssim, b.ssim), expect_same(a.decisions, b.decisions);
    expect_same(a.edges, b.edges), expect_same(a.detachment, b.detachment);
    expect_same(a.depth_map, b.depth_map), expect_same(a.depth_map_small, b.depth_map_small);
  }
}

void expect_same_page(const Comparison& whole, const Comparison& banded,
                      const compare::PictureSet& pictures) {
  const auto a = report::page_data({whole, pictures, {}, {}}),
             b = report::page_data({banded, pictures, {}, {}});
  EXPECT_EQ(a.head, b.head);
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (std::size_t i = 0; i < a.parts.size(); ++i)
    EXPECT_TRUE(a.parts[i].json == b.parts[i].json) << a.parts[i].name;
}

std::string cascades_of(const Comparison& comparison) {
  return nlohmann::json::parse(result_json(comparison))
      .at("lights")
      .front()
      .value("by_cascade", nlohmann::json())
      .dump();
}

TEST_P(CompareBands, AreTheWhole) {
  const auto whole = compare_world(world_, *renderer(), lights_, options_);
  ASSERT_TRUE(whole) << whole.error().reason;
  const auto drawn = renderer();
  const raytrace::Tracer tracer(world_, options_.accel, options_.precision);
  Plan plan = plan_of(tracer, lights_, options_);
  plan.bands = bands_of(GetParam().size, band_step);
  plan.folder = folder_.path(), plan.aov = path("bands.exr");
  Comparison banded;
  const auto parts = measure(banded, plan, frames_of(tracer, *drawn, lights_, options_));
  ASSERT_TRUE(parts) << parts.error().reason;
  // What the hybrid holds of a light grows with the receivers that it has been asked for at a time.
  banded.raster.map_bytes = whole->raster.map_bytes;
  for (std::size_t i = 0; i < lights_.size(); ++i)
    if (auto& external = banded.raster.lights[i].external)
      external->bytes = whole->raster.lights[i].external->bytes;
  EXPECT_EQ(result_line(*whole, {}), result_line(banded, {}));
  EXPECT_EQ(cascades_of(*whole), cascades_of(banded));
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    const auto& edges = banded.lights[i].edges;
    EXPECT_GT(edges.edges, 0U) << "nothing hangs on rows nearby";
    const auto& penumbra = banded.lights[i].penumbra;
    EXPECT_TRUE(!penumbra || penumbra->edges > 0U) << "no width was measured";
  }
  if (GetParam().technique == raster::Technique::csm) {
    EXPECT_FALSE(banded.lights.front().cascades.empty());
  }
  const auto pictures = encode_pictures(*whole), in_bands = encode_pictures(banded, &(*parts)->pictures);
  ASSERT_TRUE(pictures && in_bands);
  expect_same(*pictures, *in_bands);
  expect_same_page(*whole, banded, *pictures);
  ASSERT_TRUE(write_aov(*whole, std::vector{path("whole.exr")}));
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    ASSERT_TRUE((*parts)->channels[i].close((*parts)->channels[i].path()));
    EXPECT_TRUE(test::bytes_of(aov_path(*whole, whole->lights[i], path("whole.exr"))) ==
                test::bytes_of(aov_path(*whole, whole->lights[i], path("bands.exr"))));
  }
}

using raster::Technique;
INSTANTIATE_TEST_SUITE_P(
    Cases, CompareBands,
    testing::Values(BandCase{"fence", Technique::hard},
                    BandCase{
                        "floating-box", Technique::hard, {.constant = 0.6, .unit = raster::BiasUnit::world}},
                    BandCase{"fence", Technique::csm}, BandCase{"fence", Technique::vsm},
                    BandCase{"penumbra", Technique::pcss}, BandCase{"penumbra", Technique::pcss, {}, tall},
                    BandCase{"whitted", Technique::pcf}, BandCase{"shapes", Technique::hybrid}));

}  // namespace
}  // namespace gnomon::test
