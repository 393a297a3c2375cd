// Biases and stored surfaces that leave no acne: the receiver's plane and the adaptive bias on a tilted plane
// at bias 0, where the plain test has one half; second-depth and midpoint on closed bodies.
#include "tests/support/compare_support.h"
#include "tests/support/one_world.h"
#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

const Vec3 tilted = glm::normalize(Vec3(0.3, 1.0, 0.2));

Scene floor_scene(const Light& light, bool as_plane) {
  Scene scene;
  scene.materials.resize(1);
  if (as_plane) {
    scene.shapes.push_back({"floor", Plane{Vec3(0.0), tilted}, 0});
  } else {
    Vec3 t, b;
    orthonormal_basis(tilted, t, b);
    Mat4 m(1.0);
    m[0] = Vec4(t, 0.0), m[1] = Vec4(tilted, 0.0), m[2] = Vec4(glm::cross(t, tilted), 0.0);
    scene.meshes = {square_mesh(20.0)};
    scene.instances.push_back({"floor", 0, m, 0});
  }
  scene.camera.eye = Vec3(1.0, 9.0, 8.0);
  scene.lights = {light};
  return scene;
}

double shadowed_share(const Drawn& drawn) {
  std::size_t inside = 0;
  double shadowed = 0.0;
  for (std::size_t i = 0; i < drawn.light().gap.data.size(); ++i) {
    if (drawn.frame.primitive.data[i] == no_id || !(drawn.light().gap.data[i] > -infinity)) continue;
    ++inside;
    shadowed += 1.0 - double{drawn.light().visibility.data[i]};
  }
  EXPECT_GT(inside, 20000u);
  return shadowed / double(inside);
}

struct PlaneCase {
  LightType light;
  bool as_plane;
  raster::DepthFormat format;
};

class PlaneAtBiasZero : public testing::TestWithParam<PlaneCase> {};

TEST_P(PlaneAtBiasZero, ReceiverPlaneAndAdaptiveLeaveNoAcne) {
  const PlaneCase c = GetParam();
  const Light light = c.light == LightType::directional ? sun({-0.7, -1.0, -0.4})
                                                        : lamp(c.light, {3.0, 7.0, 2.0}, {0.0, 0.0, 0.0});
  Drawn drawn = make_drawn(floor_scene(light, c.as_plane));
  ASSERT_NE(drawn.renderer, nullptr);
  raster::RasterOptions options = small_options(512);
  options.size = {320, 200};
  options.map.depth_format = c.format;
  drawn.render(options);
  const double hard = shadowed_share(drawn);
  EXPECT_GT(hard, 0.4);
  options.map.bias.receiver_plane = true;
  drawn.render(options);
  const double receiver_plane = shadowed_share(drawn);
  EXPECT_LT(receiver_plane, 0.001);
  options.map.technique = raster::Technique::pcf;
  for (const auto kernel : {raster::FilterKernel::box, raster::FilterKernel::hardware}) {
    options.map.filter.kernel = kernel;
    drawn.render(options);
    EXPECT_LT(shadowed_share(drawn), 0.001)
        << "each comparison of a filter follows the plane as the hard test does";
  }
  options.map.technique = raster::Technique::hard;
  options.map.bias.receiver_plane = false;
  options.map.bias.adaptive = true;
  drawn.render(options);
  const double adaptive = shadowed_share(drawn);
  EXPECT_LT(adaptive, 0.001);
  std::printf("  acne at bias 0: hard %.2f %%, receiver plane %.3f %%, adaptive %.3f %%\n", 100 * hard,
              100 * receiver_plane, 100 * adaptive);
}

using F = raster::DepthFormat;
INSTANTIATE_TEST_SUITE_P(Lights, PlaneAtBiasZero,
                         testing::Values(PlaneCase{LightType::directional, false, F::d32f},
                                         PlaneCase{LightType::directional, true, F::d16},
                                         PlaneCase{LightType::directional, false, F::d32f_reversed},
                                         PlaneCase{LightType::point, false, F::d32f},
                                         PlaneCase{LightType::point, true, F::d24},
                                         PlaneCase{LightType::spot, false, F::d32f_reversed}));

Mesh ball_mesh(double radius, int rings) {
  Mesh mesh;
  mesh.name = "ball";
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      const double a = pi * i / rings, b = pi * j / rings;
      mesh.positions.emplace_back(radius * std::sin(a) * std::cos(b), radius * std::cos(a),
                                  radius * std::sin(a) * std::sin(b));
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * 2 * rings + j % (2 * rings)); };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      if (i + 1 < rings) mesh.triangles.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
    }
  return mesh;
}

// Closed bodies that do not shadow one another: all that faces the light is lit in truth.
Scene closed_bodies(const Light& light) {
  Scene scene;
  scene.materials.resize(1);
  scene.meshes = {ball_mesh(0.7, 12), box_mesh()};
  Mat4 turned(1.0);
  turned[0] = Vec4(glm::normalize(Vec3(1, 0.3, 0.2)), 0.0);
  turned[1] = Vec4(glm::normalize(glm::cross(Vec3(0, 0, 1), Vec3(turned[0]))), 0.0);
  turned[2] = Vec4(glm::cross(Vec3(turned[0]), Vec3(turned[1])), 0.0);
  turned[3] = Vec4(2.0, 0.0, 0.0, 1.0);
  scene.instances.push_back({"mesh ball", 0, placed({0, 0, 0}, 1.0), 0});
  scene.instances.push_back({"box", 1, turned, 0});
  scene.shapes.push_back({"ball", Sphere{{-2.0, 0.0, 0.0}, 0.7}, 0});
  scene.camera.eye = {0.5, 3.0, 5.0};
  scene.lights = {light};
  return scene;
}

/// Second-depth stores the backs of closed bodies. A front that is shadowed falsely lies in a texel that the
/// body's outline crosses, and nowhere else: there the body is a wedge, thinner at the texel's centre than
/// its front rises towards the light from the receiver to there, so that even the back is nearer to the light
/// than the receiver. Such a texel has neighbours that hold nothing.
void expect_outlines_alone(const compare::Comparison& c) {
  const compare::LightComparison& light = c.lights[0];
  const raster::LightRecord& record = c.raster.lights[0];
  const raster::ShadowMap& map = record.map;
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    if (!compare::is_compared(light.labels.data[i])) continue;
    if (!(light.rungs[0].data[i] > 0.5f && light.rungs[6].data[i] < 0.5f)) continue;
    const Vec2f uv = record.texel_uv.data[i];
    const int column = static_cast<int>(uv.x), row = static_cast<int>(uv.y), face = record.face.data[i];
    int empty = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        empty += !holds_caster(map.view, map.depth[map.texel_index(face, column + dx, row + dy)]);
    std::printf("    false shadow: label %s, receiver on %u, gap %g, %d empty neighbours\n",
                std::string(compare::label_name(light.labels.data[i])).c_str(), c.raster.primitive.data[i],
                static_cast<double>(record.gap.data[i]), empty);
    EXPECT_GT(empty, 0);
  }
}

class ClosedBodies : public testing::TestWithParam<LightType> {};

TEST_P(ClosedBodies, SecondDepthLeavesNoAcneAndMidpointLess) {
  const Light light = GetParam() == LightType::directional
                          ? sun({0.2, -1.0, -0.5})
                          : lamp(GetParam(), {0.3, 6.0, 4.0}, {0.0, 0.0, 0.0});
  OneWorld one(closed_bodies(light));
  compare::CompareOptions options = test_options({320, 200}, 256);
  const auto false_shadow = [&](raster::Technique technique, const raster::Bias& bias) {
    options.raster.map.technique = technique, options.raster.map.bias = bias;
    const compare::Comparison c = one.compare(options);
    EXPECT_GT(c.lights[0].pixels.compared, 3000u);
    if (technique == raster::Technique::second_depth) expect_outlines_alone(c);
    return c.lights[0].error.false_shadow;
  };
  const auto without_bias = [&](raster::Technique technique) {
    return false_shadow(technique, {.constant = 0.0});
  };
  const auto hard = without_bias(raster::Technique::hard),
             second = without_bias(raster::Technique::second_depth),
             midpoint = without_bias(raster::Technique::midpoint),
             hard_biased = false_shadow(raster::Technique::hard, {1.0, raster::BiasUnit::texel}),
             second_biased = false_shadow(raster::Technique::second_depth, {1.0, raster::BiasUnit::texel});
  std::printf(
      "  false shadow at bias 0: hard %llu, second-depth %llu, midpoint %llu; with a bias of one "
      "texel: hard %llu, second-depth %llu\n",
      static_cast<unsigned long long>(hard), static_cast<unsigned long long>(second),
      static_cast<unsigned long long>(midpoint), static_cast<unsigned long long>(hard_biased),
      static_cast<unsigned long long>(second_biased));
  EXPECT_GT(hard_biased, 100u);
  EXPECT_EQ(second_biased, 0u);
  EXPECT_GT(hard, 1000u);
  EXPECT_LE(second, GetParam() == LightType::directional ? 0 : hard / 1000);
  EXPECT_LT(midpoint, hard / 20);
}

INSTANTIATE_TEST_SUITE_P(Lights, ClosedBodies,
                         testing::Values(LightType::directional, LightType::point, LightType::spot));

// Two plates over a floor: the map holds the middle between the upper two surfaces.
TEST(Midpoint, LiesHalfwayBetweenTheFirstTwoSurfaces) {
  for (const LightType type : {LightType::directional, LightType::spot}) {
    for (const auto format :
         {raster::DepthFormat::d16, raster::DepthFormat::d32f, raster::DepthFormat::d32f_reversed}) {
      Scene scene;
      scene.materials.resize(1);
      scene.meshes = {square_mesh(2.0)};
      for (const double y : {0.0, 1.0, 1.5})
        scene.instances.push_back({"plate", 0, placed({0, y, 0}, 1.0), 0});
      scene.camera.eye = {0.0, 8.0, 0.1};
      scene.lights = {type == LightType::directional ? sun({0, -1, 0}) : lamp(type, {0, 6, 0}, {0, 0, 0})};
      raster::RasterOptions options = small_options(64);
      options.map.technique = raster::Technique::midpoint;
      options.map.depth_format = format;
      const Drawn drawn = draw(std::move(scene), options);
      const raster::ShadowMap& map = drawn.light().map;
      const double stored = map.depth[map.texel_index(0, 32, 32)];
      const Ray ray = texel_ray(map.view, 0, 32.5, 32.5);
      const double depth = depth_from_stored(map.view, 0, 32.5, stored);
      const double along = depth / glm::dot(ray.direction, map.view.face(0).forward);
      EXPECT_NEAR(ray.at(along).y, 1.25, format == raster::DepthFormat::d16 ? 1e-2 : 1e-5);
    }
  }
}

}  // namespace
}  // namespace gnomon::test
