// glTF files that show a mesh many times, by nodes below nodes and by EXT_mesh_gpu_instancing: a whole comparison with
// these instances kept is that of the same file flattened, to the last bit.
#include <glm/gtc/matrix_transform.hpp>

#include "compare/compare.h"
#include "tests/support/gltf_support.h"
#include "tests/support/raster_fixture.h"

namespace gnomon::gltf_test {
namespace {

/// Mesh 0 is a roof of four slopes over a box without a floor, mesh 1 a ground to see shadows on; no nodes.
Builder roof_and_ground() {
  Builder b;
  const int roof = b.positions(
      {-1, 0, -1, 1, 0, -1, 1, 0, 1, -1, 0, 1, -1, 1, -1, 1, 1, -1, 1, 1, 1, -1, 1, 1, 0, 2.2f, 0});
  const std::vector<std::uint16_t> walls{0, 4, 5, 0, 5, 1, 1, 5, 6, 1, 6, 2, 2, 6, 7, 2, 7, 3,
                                         3, 7, 4, 3, 4, 0, 4, 8, 5, 5, 8, 6, 6, 8, 7, 7, 8, 4};
  const int corners = b.accessor(walls, 5123, "SCALAR", 1);
  const int ground = b.positions({-9, 0, -9, -9, 0, 9, 9, 0, -9, 9, 0, 9});
  const int halves = b.accessor(std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3}, 5123, "SCALAR", 1);
  const auto mesh = [](int positions, int indices) {
    return Json{
        {"primitives",
         Json::array({{{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", 0}}})}};
  };
  b.json["materials"] = Json::array({{{"doubleSided", true}}});  // else what is mirrored would be flattened
  b.json["meshes"] = Json::array({mesh(roof, corners), mesh(ground, halves)});
  b.json["scenes"] = Json::array({{{"nodes", {0, 1}}}});
  b.json["scene"] = 0;
  return b;
}

/// Houses at three levels, under turns, unequal scales and a mirroring, so that some are sheared.
Builder nested() {
  Builder b = roof_and_ground();
  b.json["nodes"] = Json::array(
      {{{"mesh", 1}},
       {{"translation", {0.3, 0.1, -0.2}},
        {"rotation", {0.0, 0.3826834, 0.0, 0.9238795}},
        {"children", {2, 3, 6}}},
       {{"mesh", 0}, {"scale", {1.1, 0.7, 0.9}}, {"children", {4}}},
       {{"mesh", 0}, {"translation", {3.7, 0.0, 0.4}}, {"scale", {-0.8, 1.3, 0.6}}, {"children", {5}}},
       {{"mesh", 0},
        {"translation", {0.2, 2.4, 0.1}},
        {"rotation", {0.0, 0.1305262, 0.0, 0.9914449}},
        {"scale", {0.4, 0.4, 0.4}}},
       {{"mesh", 0}, {"matrix", {0.5, 0.1, 0, 0, -0.1, 0.5, 0.2, 0, 0, 0, 0.6, 0, 0.3, 2.3, -0.4, 1}}},
       {{"translation", {-3.1, 0.0, 2.9}}, {"children", {7, 8}}},
       {{"mesh", 0}},
       {{"mesh", 0}, {"translation", {0.0, 0.0, -5.3}}, {"rotation", {0.0871557, 0.0, 0.0, 0.9961947}}}});
  return b;
}

/// A village by EXT_mesh_gpu_instancing, below a node that turns and stretches it; its node has a child besides.
Builder instanced() {
  Builder b = roof_and_ground();
  std::vector<float> places, turns, sizes;
  for (int i = 0; i < 12; ++i) {
    const auto at = static_cast<float>(i);
    places.insert(places.end(), {2.9f * static_cast<float>(i % 4) - 4.3f, 0.01f * at,
                                 3.1f * static_cast<float>(i / 4) - 3.0f});
    turns.insert(turns.end(), {0.0f, std::sin(0.21f * at), 0.0f, std::cos(0.21f * at)});
    sizes.insert(sizes.end(), {0.5f + 0.05f * at, 1.1f - 0.04f * at, i % 5 == 4 ? -0.6f : 0.6f});
  }
  const int t = b.positions(places), r = b.accessor(turns, 5126, "VEC4", 4), s = b.positions(sizes);
  const Json attributes{{"TRANSLATION", t}, {"ROTATION", r}, {"SCALE", s}};
  b.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  b.json["nodes"] = Json::array(
      {{{"mesh", 1}},
       {{"rotation", {0.0, -0.1736482, 0.0, 0.9848078}}, {"scale", {1.2, 0.9, 1.0}}, {"children", {2}}},
       {{"mesh", 0},
        {"translation", {0.2, 0.0, 0.3}},
        {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}},
        {"children", {3}}},
       {{"mesh", 0}, {"translation", {0.0, 3.0, 0.0}}}});
  return b;
}

compare::Comparison comparison_of(const World& world) {
  auto renderer = raster::Renderer::create(test::software_context(), world, plan_effects(*world.scene));
  compare::CompareOptions options;
  options.raster = test::small_options();
  options.raytrace.size = options.raster.size;
  const std::array<std::uint32_t, 1> lights{0};
  auto made = compare::compare_world(world, **renderer, lights, options);
  EXPECT_TRUE(made) << made.error().message();
  return std::move(*made);
}

void expect_same_kept(const Scene& scene, std::size_t instances) {
  ASSERT_EQ(scene.instances.size(), instances);
  const World kept_world = make_world(scene, InstanceChoice::keep);
  const World flat_world = make_world(scene, InstanceChoice::flatten);
  EXPECT_TRUE(
      std::all_of(kept_world.parts.begin(), kept_world.parts.end(), [](const auto& p) { return p.kept(); }));
  const compare::Comparison kept = comparison_of(kept_world), flat = comparison_of(flat_world);
  EXPECT_EQ(kept.raster.primitive.data, flat.raster.primitive.data);
  EXPECT_EQ(kept.raster.color.data, flat.raster.color.data);
  EXPECT_EQ(kept.raytraced.color.data, flat.raytraced.color.data);
  for (std::size_t i = 0; i < flat.raytraced.receiver.data.size(); ++i) {
    const auto &a = kept.raytraced.receiver.data[i], &b = flat.raytraced.receiver.data[i];
    ASSERT_TRUE(a.primitive == b.primitive && a.position == b.position && a.normal == b.normal &&
                a.position_error == b.position_error && a.barycentric == b.barycentric);
  }
  ASSERT_EQ(kept.lights.size(), 1u);
  EXPECT_EQ(kept.raytraced.lights[0].centre.data, flat.raytraced.lights[0].centre.data);
  EXPECT_EQ(kept.raster.lights[0].map.depth, flat.raster.lights[0].map.depth);
  EXPECT_EQ(kept.raster.lights[0].gap.data, flat.raster.lights[0].gap.data);
  EXPECT_EQ(kept.lights[0].labels.data, flat.lights[0].labels.data);
  for (std::size_t k = 0; k < flat.lights[0].rungs.size(); ++k)
    EXPECT_EQ(kept.lights[0].rungs[k].data, flat.lights[0].rungs[k].data) << k;
  const auto& centre = flat.raytraced.lights[0].centre.data;
  EXPECT_GT(std::count(centre.begin(), centre.end(), raytrace::PointVisibility::shadowed), 50);
}

TEST_F(Gltf, NestedNodesKeptAreThoseFlattened) {
  expect_same_kept(loaded(nested()), 7);
}

TEST_F(Gltf, InstancesOfANodeKeptAreThoseFlattened) {
  expect_same_kept(loaded(instanced()), 14);
}

}  // namespace
}  // namespace gnomon::gltf_test
