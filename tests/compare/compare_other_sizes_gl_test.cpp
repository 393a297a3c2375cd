// What a map of another size would leave, held to what maps of these sizes draw.
#include "compare/ladder/other_sizes.h"

#include <algorithm>

#include "raster/technique_traits.h"
#include "tests/support/compare_support.h"

namespace gnomon::test {
namespace {

using raster::FilterKernel;
using raster::Technique;

/// A leaning plate with a grid of holes' worth of edges over a floor: strips of several widths under a slanting light.
Scene strips_scene(LightType type) {
  std::vector<Mesh> meshes{floor_mesh(6.0, 6.0)};
  for (int i = 0; i < 12; ++i) {
    Mesh strip;
    const double x = -2.4 + 0.4 * i, width = 0.03 + 0.02 * (i % 5);
    strip.positions = {
        {x, 0.3, -2.0}, {x + width, 0.3, -2.0}, {x + width + 0.5, 1.4, 2.0}, {x + 0.5, 1.4, 2.0}};
    strip.triangles = {{0, 2, 1}, {0, 3, 2}};
    meshes.push_back(std::move(strip));
  }
  Scene scene = sunlit_scene(std::move(meshes), glm::normalize(Vec3(0.4, -1.0, 0.3)));
  scene.camera = {{0.5, 4.0, 6.0}, {0.0, 0.0, 0.0}, {0, 1, 0}, 0.8};
  if (type == LightType::directional) return scene;
  Light& light = scene.lights[0];
  light.type = type, light.position = {-1.5, 4.0, -1.0},
  light.direction = glm::normalize(Vec3(0.35, -1.0, 0.25));
  light.intensity = Vec3f(20.0f), light.inner_angle = 0.8, light.outer_angle = 0.9;
  return scene;
}

struct Drawing {
  std::string name;
  LightType light = LightType::directional;
  raster::MapOptions map{};
};

std::vector<Drawing> drawings() {
  const auto with = [](auto&& change) {
    raster::MapOptions map;
    map.bias = {0.5, raster::BiasUnit::texel, 1.0};
    change(map);
    return map;
  };
  const auto pcf = [&](FilterKernel kernel, double radius, bool plane) {
    return with([&](raster::MapOptions& map) {
      map.technique = Technique::pcf, map.filter.kernel = kernel, map.filter.radius_texels = radius;
      map.filter.receiver_plane = plane;
    });
  };
  return {
      {"hard", LightType::directional, with([](auto&) {})},
      {"hard, no bias", LightType::directional, with([](auto& map) {
         map.bias = {0.0, raster::BiasUnit::world};
       })},
      {"hard, 16 bits", LightType::directional,
       with([](auto& map) { map.depth_format = raster::DepthFormat::d16; })},
      {"hard, normal offset", LightType::directional,
       with([](auto& map) { map.bias.normal_offset_texels = 1.5; })},
      {"hard, receiver plane", LightType::spot, with([](auto& map) { map.bias.receiver_plane = true; })},
      {"hard, adaptive", LightType::directional, with([](auto& map) { map.bias.adaptive = true; })},
      {"hard, spot", LightType::spot, with([](auto&) {})},
      {"cube", LightType::point, with([](auto& map) { map.technique = Technique::cube; })},
      {"lispsm", LightType::directional, with([](auto& map) { map.technique = Technique::lispsm; })},
      {"csm", LightType::directional,
       with([](auto& map) { map.technique = Technique::csm, map.cascades.blend = 0.0; })},
      {"pcf box", LightType::directional, pcf(FilterKernel::box, 1.5, true)},
      {"pcf box, no plane", LightType::directional, pcf(FilterKernel::box, 2.5, false)},
      {"pcf hardware", LightType::spot, pcf(FilterKernel::hardware, 0.5, true)},
      {"pcf optimised", LightType::directional, pcf(FilterKernel::optimised, 1.7, true)},
  };
}

compare::CompareOptions options_of(const Drawing& drawing, int size) {
  compare::CompareOptions options = test_options({192, 144}, size);
  options.raster.map = drawing.map;
  options.raster.map.size = size;
  options.perceptual = true;
  return options;
}

/// The frames of a comparison as its parts read them.
struct Frames {
  raytrace::Tracer tracer;
  raytrace::Topology topology;
  compare::LadderInput input;
  explicit Frames(const Compared& run)
      : tracer(*run.world, raytrace::Accel::bvh, raytrace::Precision::robust),
        topology(*run.world),
        input{tracer, topology, run.result.raster, run.result.raytraced} {}
};

// A map of the drawn size would give what was drawn. Both sides round alike but for the rasterizer's floats: a texel of a
// strip's edge in a thousand may be covered or not.
TEST(OtherSizes, GiveWhatWasDrawnAtTheDrawnSize) {
  for (const Drawing& drawing : drawings()) {
    SCOPED_TRACE(drawing.name);
    const Compared run = run_comparison(strips_scene(drawing.light), options_of(drawing, 128));
    ASSERT_FALSE(run.result.lights.empty());
    const Frames frames(run);
    const compare::OtherSize same(frames.input, 128);
    double off = 0.0;
    for (std::size_t i = 0; i < run.light().labels.data.size(); ++i)
      if (compare::is_compared(run.light().labels.data[i]))
        off += std::abs(same.visibility(i) - run.result.raster.lights[0].visibility.data[i]);
    EXPECT_LT(off / static_cast<double>(run.light().pixels.compared), 1e-3);
    EXPECT_GT(run.light().error.mean_absolute, 0.01);  // else nothing would be held
  }
}

// The texels of the other map lie elsewhere by a part of one, which changes single edges: a fifth of the error and four
// standard errors are allowed.
TEST(OtherSizes, EstimateWhatMapsOfTheseSizesDraw) {
  for (const Drawing& drawing : drawings()) {
    SCOPED_TRACE(drawing.name);
    const Compared run = run_comparison(strips_scene(drawing.light), options_of(drawing, 128));
    ASSERT_EQ(run.light().other_sizes.size(), 3U);
    for (const compare::OtherMapSize& other : run.light().other_sizes) {
      const Compared drawn = run_comparison(strips_scene(drawing.light), options_of(drawing, other.size));
      const double error = drawn.light().error.mean_absolute;
      EXPECT_NEAR(other.mean_absolute, error, 0.2 * error + 4.0 * other.standard_error) << other.size;
    }
  }
}

TEST(OtherSizes, AreNotEstimatedWhereTexelsDoNotDecide) {
  for (const Technique technique :
       {Technique::vsm, Technique::pcss, Technique::second_depth, Technique::izb}) {
    Drawing drawing{"", LightType::directional, {}};
    drawing.map.technique = technique;
    const Compared run = run_comparison(strips_scene(drawing.light), options_of(drawing, 128));
    ASSERT_FALSE(run.result.lights.empty());
    EXPECT_TRUE(run.light().other_sizes.empty()) << raster::traits_of(technique).name;
  }
}

}  // namespace
}  // namespace gnomon::test
