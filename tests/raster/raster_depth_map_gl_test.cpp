// Stored depths against the exact depth of a tilted plane and of a sphere, in every format and projection.
#include <cmath>

#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

using raster::DepthFormat;

/// A tilted square seen whole by every light, as triangles or, by `as_plane`, as an infinite plane.
Scene tilted(const Light& light, bool as_plane) {
  Scene scene;
  scene.materials.resize(1);
  const Vec3 normal = glm::normalize(Vec3(0.4, 1.0, 0.25));
  Vec3 t, b;
  orthonormal_basis(normal, t, b);
  if (as_plane) {
    scene.shapes.push_back({"plane", Plane{Vec3(0.0), normal}, 0});
    scene.shapes.push_back({"ball", Sphere{Vec3(0.0, 1.0, 0.0), 0.5}, 0});
  } else {
    scene.meshes = {square_mesh(2.0)};
    Mat4 m(1.0);
    m[0] = Vec4(t, 0.0), m[1] = Vec4(normal, 0.0), m[2] = Vec4(glm::cross(t, normal), 0.0);
    scene.instances.push_back({"square", 0, m, 0});
  }
  scene.camera.eye = Vec3(0.5, 4.0, 5.0);
  scene.lights = {light};
  return scene;
}

double quantum(DepthFormat format) {
  switch (format) {
    case DepthFormat::d16:
      return 1.0 / 65535.0;
    case DepthFormat::d24:
      return 1.0 / 16777215.0;
    case DepthFormat::d32f:
    case DepthFormat::d32f_reversed:
      break;
  }
  return std::exp2(-24);  // spacing of floats in [0.5, 1]
}

struct DepthCase {
  const char* name;
  LightType light;
  bool as_plane;
  DepthFormat format;
};

class StoredDepth : public testing::TestWithParam<DepthCase> {};

Light light_of(LightType type) {
  if (type == LightType::directional) return sun({-0.3, -1.0, -0.2});
  return lamp(type, {0.7, 4.0, 0.9}, {0.0, 0.0, 0.0});
}

// Half a quantum of rounding, and what single-precision interpolation of depth over a triangle may add (a few
// units in the last place of 1): the wider of the two is the bound.
TEST_P(StoredDepth, IsExactWithinOneQuantum) {
  const DepthCase c = GetParam();
  raster::RasterOptions options = small_options(128);
  options.map.depth_format = c.format;
  const Drawn drawn = draw(tilted(light_of(c.light), c.as_plane), options);
  const raster::ShadowMap& map = drawn.light().map;
  double worst = 0.0;
  int tested = 0;
  for (int face = 0; face < map.view.face_count; ++face) {
    for (int row = 0; row < map.view.size; ++row) {
      for (int column = 0; column < map.view.size; ++column) {
        const auto hit = hit_away_from_edges(*drawn.world, map.view, face, column, row);
        if (!hit) continue;
        const double stored = map.depth[map.texel_index(face, column, row)];
        const Ray ray = texel_ray(map.view, face, column + 0.5, row + 0.5);
        const double exact =
            stored_from_depth(map.view, face, row + 0.5, depth_of(map.view, face, ray, hit->t));
        if (hit->primitive == no_id || exact > 1.0) {
          ASSERT_EQ(stored, 1.0) << "nothing lies on this ray before the far depth";
          continue;
        }
        worst = std::max(worst, std::abs(stored - exact));
        ++tested;
      }
    }
  }
  EXPECT_GT(tested, 2000);
  EXPECT_LE(worst, std::max(quantum(c.format), 8.0 * std::exp2(-24)))
      << worst / quantum(c.format) << " quanta";
}

std::vector<DepthCase> cases() {
  std::vector<DepthCase> all;
  for (const auto format : {DepthFormat::d16, DepthFormat::d24, DepthFormat::d32f}) {
    for (const bool as_plane : {false, true}) {
      all.push_back({"directional", LightType::directional, as_plane, format});
      all.push_back({"spot", LightType::spot, as_plane, format});
      all.push_back({"point", LightType::point, as_plane, format});
    }
  }
  return all;
}

std::string case_name(const testing::TestParamInfo<DepthCase>& chosen) {
  const char* formats[] = {"d16", "d24", "d32f"};
  return std::string(chosen.param.name) + (chosen.param.as_plane ? "_shapes_" : "_triangles_") +
         formats[static_cast<int>(chosen.param.format)];
}

INSTANTIATE_TEST_SUITE_P(Formats, StoredDepth, testing::ValuesIn(cases()), case_name);

// Whether a map is drawn in a timed run or once, and whether records are asked for, it is the same map.
TEST(DepthMap, IsTheSameTimedOrNotAndWithRecordsOrNot) {
  Scene scene = still_life(true);
  scene.lights = {sun({-0.5, -1.0, -0.6}), lamp(LightType::point, {0.2, 2.0, 1.2}, {0.0, 0.0, 0.0})};
  Drawn drawn = draw(scene);
  const raster::RasterFrame once = drawn.frame;
  raster::RasterOptions options = once.options;
  options.runs = 2;
  drawn.render(options);
  ASSERT_EQ(drawn.light(1).map_pass.runs.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(drawn.light(i).map.depth, once.lights[i].map.depth);
    EXPECT_EQ(drawn.light(i).visibility.data, once.lights[i].visibility.data);
  }
  options.runs = 0, options.analysis = false;
  drawn.render(options);
  EXPECT_EQ(drawn.frame.color.data, once.color.data);
  EXPECT_TRUE(drawn.light().map.depth.empty());
  EXPECT_TRUE(drawn.light().gap.data.empty());
}

// The front of a closed body is nearer than its back, and each texel keeps the side that is asked for; the fronts of a
// mirrored body are those of the mesh (glTF 2.0, section 3.7.4).
class DepthMapCulling : public testing::TestWithParam<bool> {};

TEST_P(DepthMapCulling, KeepsTheOtherSide) {
  Scene scene = still_life();
  scene.instances.pop_back();
  if (GetParam())
    for (MeshInstance& instance : scene.instances) instance.world_from_object[0] *= -1.0;
  scene.lights = {sun({-0.5, -1.0, -0.6})};
  Drawn drawn = make_drawn(scene);
  ASSERT_NE(drawn.renderer, nullptr);
  const auto depths = [&](raster::Cull cull) {
    raster::RasterOptions options = small_options(64);
    options.map.cull = cull;
    drawn.render(options);
    return drawn.light().map.depth;
  };
  const auto all = depths(raster::Cull::none);
  const auto fronts = depths(raster::Cull::back);
  const auto backs = depths(raster::Cull::front);
  int covered = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i], std::min(fronts[i], backs[i]));
    if (all[i] == 1.0f) continue;
    ++covered;
    EXPECT_LE(fronts[i], backs[i]);
  }
  EXPECT_GT(covered, 500);
  EXPECT_NE(fronts, backs);
}

INSTANTIATE_TEST_SUITE_P(Mirrored, DepthMapCulling, testing::Bool());

TEST(DepthMap, CountsItsTexelsAndBytes) {
  Scene scene = still_life();
  scene.lights = {sun({-0.5, -1.0, -0.6}), lamp(LightType::point, {0.2, 2.0, 1.2}, {0.0, 0.0, 0.0})};
  raster::RasterOptions options = small_options(32);
  options.map.depth_format = DepthFormat::d16;
  const Drawn drawn = draw(scene, options);
  EXPECT_EQ(drawn.frame.map_texels, 7u * 32u * 32u);
  EXPECT_EQ(drawn.frame.map_bytes, 2u * 6u * 32u * 32u);
  EXPECT_EQ(drawn.frame.lights[1].map.depth.size(), 6u * 32u * 32u);
}

}  // namespace
}  // namespace gnomon::test
