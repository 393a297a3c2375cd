// The parts of the bias one by one: their formulas in double precision against the gaps that the shader
// wrote.
#include <algorithm>
#include <cmath>

#include "raster/passes/light_block.h"
#include "scene/light.h"
#include "scene/load.h"
#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

/// Depth at which the ray through (u, v) meets the receiver's plane.
double plane_depth(const LightView& view, int face, double u, double v, const Vec3& position,
                   const Vec3& normal) {
  const Ray ray = texel_ray(view, face, u, v);
  return depth_of(view, face, ray, glm::dot(normal, position - ray.origin) / glm::dot(normal, ray.direction));
}

struct Receiver {
  Vec3 position, normal, to_light;
  TexelCoordinate at;
  std::size_t pixel;
};

class Bias : public testing::TestWithParam<LightType> {
 protected:
  void SetUp() override {
    Scene scene = still_life(false);
    scene.shapes.clear();
    scene.lights = {GetParam() == LightType::directional
                        ? sun({-0.5, -1.0, -0.6})
                        : lamp(GetParam(), {0.3, 3.2, 1.2}, {0.0, 0.0, 0.0})};
    plain_ = draw(scene, small_options());
    biased_ = make_drawn(scene);
    ASSERT_NE(biased_.renderer, nullptr);
  }

  /// Calls check(receiver, gap without bias, gap with it) for receivers that face the light, away from edges.
  template <class Check>
  void compare(const raster::Bias& bias, const Check& check) {
    raster::RasterOptions options = small_options();
    options.map.bias = bias;
    biased_.render(options);
    const LightView& map = plain_.light().map.view;
    const View view = plain_.view();
    int tested = 0;
    for (int y = 0; y < view.size.height; ++y) {
      for (int x = 0; x < view.size.width; ++x) {
        const auto hit = hit_away_from_edges(*plain_.world, view, x, y);
        if (!hit || hit->primitive == no_id) continue;
        Receiver r;
        const Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
        r.position = ray.at(hit->t);
        r.normal = face_forward(geometric_normal(*plain_.world, hit->primitive, r.position), ray.direction);
        r.to_light = light_at(plain_.scene->lights[0], r.position).to_light;
        if (glm::dot(r.normal, r.to_light) < 0.05) continue;
        r.at = project_to_texel(map, r.position);
        r.pixel = plain_.frame.primitive.index(x, y);
        const float before = plain_.light().gap.data[r.pixel], after = biased_.light().gap.data[r.pixel];
        if (!std::isfinite(before) || !std::isfinite(after)) continue;
        ++tested;
        check(r, before, after);
      }
    }
    EXPECT_GT(tested, 5000);
  }
  double along(const Receiver& r) const {
    return plain_.light().map.view.projection == LightProjection::perspective ? r.at.distance / r.at.depth
                                                                              : 1.0;
  }
  Drawn plain_, biased_;
};

// Single precision on lengths of about ten units.
constexpr double tolerance = 2e-5;

TEST_P(Bias, SlopeTakesHalfTheDepthAcrossTheTexel) {
  compare({.constant = 0.0, .slope = 1.5}, [&](const Receiver& r, float before, float after) {
    const LightView& map = plain_.light().map.view;
    const auto depth = [&](double du, double dv) {
      return plane_depth(map, r.at.face, r.at.u + du, r.at.v + dv, r.position, r.normal);
    };
    const double slope =
        0.5 * (std::abs(depth(0.5, 0) - depth(-0.5, 0)) + std::abs(depth(0, 0.5) - depth(0, -0.5)));
    ASSERT_NEAR(before - after, 1.5 * slope * along(r), tolerance + 1e-3 * slope);
  });
}

// A rounding error may choose the neighbouring texel near a texel's border: receivers there are left out.
bool near_texel_border(const Receiver& r) {
  const auto close = [](double x) { return std::abs(x - std::round(x)) < 1e-3; };
  return close(r.at.u) || close(r.at.v);
}

TEST_P(Bias, ReceiverPlaneComparesAtTheTexelsCentre) {
  compare({.constant = 0.0, .receiver_plane = true}, [&](const Receiver& r, float before, float after) {
    if (near_texel_border(r)) return;
    const double center = plane_depth(plain_.light().map.view, r.at.face, r.at.column() + 0.5,
                                      r.at.row() + 0.5, r.position, r.normal);
    ASSERT_NEAR(after - before, (center - r.at.depth) * along(r),
                tolerance + 1e-3 * std::abs(center - r.at.depth));
  });
}

TEST_P(Bias, NormalOffsetLooksUpAMovedReceiver) {
  raster::Bias bias{.constant = 0.0};
  bias.normal_offset_texels = 2.0;
  compare(bias, [&](const Receiver& r, float, float after) {
    const LightView& map = plain_.light().map.view;
    const double sine = glm::length(glm::cross(r.normal, r.to_light));
    const Vec3 moved = r.position + r.normal * (2.0 * texel_world_size(map, r.at) * sine);
    Receiver m = r;
    m.at = project_to_texel(map, moved);
    if (near_texel_border(m) || !m.at.inside) return;
    const auto& shadow_map = plain_.light().map;
    const double stored = shadow_map.depth[shadow_map.texel_index(m.at.face, m.at.column(), m.at.row())];
    ASSERT_NEAR(after, (m.at.depth - depth_from_stored(map, m.at.face, m.at.v, stored)) * along(m),
                4.0 * tolerance);
    ASSERT_EQ(plain_.light().texel_uv.data[r.pixel], biased_.light().texel_uv.data[r.pixel])
        << "the own place moved";
    ASSERT_EQ(plain_.light().distance.data[r.pixel], biased_.light().distance.data[r.pixel]);
  });
}

TEST_P(Bias, ConstantInTexelsBecomesWorldUnitsOnce) {
  const LightView& map = plain_.light().map.view;
  const TexelCoordinate center = project_to_texel(map, plain_.world->finite_bounds.center());
  const auto world_units = [&](const raster::Bias& bias) {
    return raster::constant_bias_world(bias, plain_.light().rounding, map, *plain_.world);
  };
  const double texel = texel_world_size(map, center);
  EXPECT_DOUBLE_EQ(world_units({3.0, raster::BiasUnit::texel}), 3.0 * texel);
  EXPECT_EQ(world_units({3.0, raster::BiasUnit::world}), 3.0);
  EXPECT_EQ(plain_.light().texel_world, texel);
  EXPECT_DOUBLE_EQ(world_units({2.0}), 2.0 * (texel / 16.0 + plain_.light().rounding_world));
  raster::RasterOptions options = small_options();
  options.map.bias.constant = 3.0;
  biased_.render(options);
  EXPECT_DOUBLE_EQ(biased_.light().bias_constant_world, 3.0 * texel);
}

INSTANTIATE_TEST_SUITE_P(Lights, Bias,
                         testing::Values(LightType::directional, LightType::point, LightType::spot));

// Edge-on to the light neither the receiver's plane nor its slope has a bound, and the shader's gap would be
// no number (whitted: one pixel).
TEST(BiasOfAScene, LeavesNumbersEverywhere) {
  Expected<Scene> scene = load_scene("whitted");
  ASSERT_TRUE(scene);
  raster::RasterOptions options = small_options();
  options.size = {480, 270};
  options.map.size = 1024;
  options.map.bias.slope = 1.0, options.map.bias.receiver_plane = true;
  const Drawn drawn = draw(std::move(*scene), options);
  const auto& gaps = drawn.light().gap.data;
  EXPECT_EQ(std::count_if(gaps.begin(), gaps.end(), [](float gap) { return std::isnan(gap); }), 0);
}

}  // namespace
}  // namespace gnomon::test
