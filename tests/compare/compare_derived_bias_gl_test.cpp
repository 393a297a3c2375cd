// The bias that follows from the map alone (compare/bias/derived_bias.h): of a plane it leaves nothing, whatever the light and
// the filter, and a fifth less of it does; and one constant as length, texels and stored depth.
#include "compare/bias/derived_bias.h"
#include "tests/support/compare_support.h"
#include "tests/support/one_world.h"

namespace gnomon::test {
namespace {

using enum LightType;
using raster::FilterKernel;
using raster::Technique;

struct DerivedCase {
  const char* name;
  LightType light;
  Vec3 from;  ///< where the light stands, or the direction that a sun comes from
  raster::Technique technique;
  raster::FilterKernel kernel = raster::FilterKernel::box;
  double radius = 1.5;
};

class DerivedBiasOnAPlane : public ::testing::TestWithParam<DerivedCase> {};

Scene floor_under(const DerivedCase& c) {
  Scene scene = sunlit_scene({floor_mesh(10.0, 10.0)}, -c.from);
  Light& light = scene.lights.front();
  light.type = c.light;
  if (c.light != LightType::directional) light.position = c.from;
  if (c.light == LightType::spot) light.outer_angle = 0.9;
  scene.camera = {{1.3, 14.0, 9.0}, {0.2, 0.0, 0.5}, {0, 1, 0}, 0.6};
  return scene;
}

TEST_P(DerivedBiasOnAPlane, LeavesNothing) {
  const DerivedCase& c = GetParam();
  OneWorld floor(floor_under(c));
  auto options = test_options({320, 180}, 256);
  raster::MapOptions& map = options.raster.map;
  map.technique = c.technique;
  // Square texels: the offset goes by the wider side.
  if (c.light == directional && c.technique != Technique::csm) map.window.size = {{30.0, 30.0}, 2};
  map.filter.kernel = c.kernel, map.filter.radius_texels = c.radius, map.filter.receiver_plane = false;
  const compare::Comparison first = floor.compare(options);
  const auto derived = compare::derive_bias(map, first.raster.lights[0], *first.world);
  ASSERT_TRUE(derived.has_value());
  const auto error = [&](double slope, double offset) {
    map.bias = {.constant = derived->constant_texels,
                .unit = raster::BiasUnit::texel,
                .slope = slope,
                .normal_offset_texels = offset};
    const compare::Comparison run = floor.compare(options);
    EXPECT_GT(run.lights[0].pixels.compared, 10000u);
    return run.lights[0].error.mean_absolute;
  };
  constexpr double sums_of_floats = 1e-6;  // the weights of a square add up to 1 but for rounding
  EXPECT_LT(error(derived->slope, 0.0), sums_of_floats);
  EXPECT_GT(error(0.6 * derived->slope, 0.0), 1e-4);
  if (c.light != directional) return;  // the offset's texel is that of the scene's middle
  EXPECT_LT(error(0.0, derived->normal_offset_texels), sums_of_floats);
  EXPECT_GT(error(0.0, 0.6 * derived->normal_offset_texels), 1e-4);
}

const Vec3 low_sun{0.9, 0.5, 0.62}, lamp{5.0, 3.0, 4.0};
INSTANTIATE_TEST_SUITE_P(
    Lights, DerivedBiasOnAPlane,
    ::testing::Values(DerivedCase{"sun", directional, low_sun, Technique::hard},
                      DerivedCase{"sun 2 x 2", directional, low_sun, Technique::pcf, FilterKernel::hardware},
                      DerivedCase{"sun 3 x 3", directional, low_sun, Technique::pcf},
                      DerivedCase{"sun 5 x 5", directional, low_sun, Technique::pcf, FilterKernel::box, 2.5},
                      DerivedCase{"sun square", directional, low_sun, Technique::pcf, FilterKernel::optimised,
                                  2.0},
                      DerivedCase{"sun disc", directional, low_sun, Technique::pcf, FilterKernel::vogel, 3.0},
                      DerivedCase{"cascades", directional, low_sun, Technique::csm},
                      DerivedCase{"spot", spot, lamp, Technique::hard},
                      DerivedCase{"point", point, lamp, Technique::cube}),
    [](const auto& test) {
      std::string name = test.param.name;
      std::erase(name, ' ');
      return name;
    });

// Cascades of one light: one number of texels, and as many lengths and stored numbers as there are layers.
TEST(DerivedBias, IsOneNumberOfTexelsForEveryCascade) {
  const DerivedCase sun{"", directional, low_sun, Technique::csm};
  OneWorld floor(floor_under(sun));
  auto options = test_options({320, 180}, 256, 0.25);
  options.raster.map.technique = Technique::csm;
  const compare::Comparison run = floor.compare(options);
  const raster::LightRecord& record = run.raster.lights[0];
  const auto derived = compare::derive_bias(options.raster.map, record, *run.world);
  ASSERT_TRUE(derived.has_value());
  ASSERT_EQ(derived->layers.size(), std::size_t(record.map.view.face_count));
  for (int face = 0; face < record.map.view.face_count; ++face) {
    const compare::BiasLayer& layer = derived->layers[std::size_t(face)];
    const LightFace& f = record.map.view.face(face);
    EXPECT_DOUBLE_EQ(layer.derived_world / layer.texel_world, derived->constant_texels);
    EXPECT_DOUBLE_EQ(layer.drawn_world, 0.25) << "world units: the same on every layer";
    EXPECT_DOUBLE_EQ(layer.stored_per_world * (f.far_depth - f.near_depth), 1.0);
  }
  EXPECT_GT(derived->layers.back().texel_world, 1.2 * derived->layers.front().texel_world);
  options.raster.map.technique = Technique::vsm;
  EXPECT_FALSE(compare::derive_bias(options.raster.map, record, *run.world).has_value());
}

}  // namespace
}  // namespace gnomon::test
