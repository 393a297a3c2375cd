// Where glTF puts the vertices of meshes that are more than placed by a node: skins, morph targets, instances.
#include <array>

#include "scene/world.h"
#include "tests/support/gltf_support.h"

namespace gnomon::gltf_test {
namespace {

int floats(Builder& b, const std::vector<float>& values, const std::string& type, std::size_t components) {
  return b.accessor(values, 5126, type, components);
}

Json& primitive(Builder& b) {
  return b.json["meshes"][0]["primitives"][0];
}

// Vertices 0 and 1 depend on the first joint, 2 on the second, 3 on both by halves.
Builder skinned() {
  Builder b = simple();
  const std::vector<std::uint8_t> joints{0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
  primitive(b)["attributes"]["JOINTS_0"] = b.accessor(joints, 5121, "VEC4", 4);
  primitive(b)["attributes"]["WEIGHTS_0"] =
      floats(b, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, "VEC4", 4);
  b.json["skins"] = Json::array({{{"joints", {1, 2}}}});
  b.json["nodes"] = Json::array({{{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}},
                                 {{"translation", {0, 0, 5}}, {"children", {2}}},
                                 {{"translation", {2, 0, 0}}, {"scale", {3, 3, 3}}}});
  b.json["scenes"][0]["nodes"] = {0, 1};
  return b;
}

TEST_F(Gltf, SkinsAreAppliedInTheStoredPose) {
  const Scene without = loaded(skinned());
  ASSERT_EQ(without.instances.size(), 1u);
  // By hand: joint 1 moves by (0, 0, 5); joint 2 scales by 3 and moves by (2, 0, 5). The node's own move counts
  // for nothing.
  EXPECT_EQ(positions_of(make_world(without)),
            (std::vector<Vec3>{{0, 0, 5}, {1, 0, 5}, {2, 3, 5}, {0.5 * (1 + 5), 0.5 * (1 + 3), 5}}));
  Builder b = skinned();
  const std::vector<float> inverse{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, -5, 1,
                                   1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 0, 0,  1};
  b.json["skins"][0]["inverseBindMatrices"] = floats(b, inverse, "MAT4", 16);
  EXPECT_EQ(make_world(loaded(b)).position(1), Vec3(1, 0, 0));
  EXPECT_EQ(make_world(loaded(b)).position(2), Vec3(3 * 10 + 2, 3, 5));
}

TEST_F(Gltf, ASkinWithoutBoundVerticesChangesNothing) {
  Builder b = skinned();
  primitive(b)["attributes"].erase("JOINTS_0");
  EXPECT_EQ(make_world(loaded(b)).position(1), Vec3(101, 0, 0));
}

TEST_F(Gltf, MistakesInSkinsHaveTheirPath) {
  Builder b = skinned();
  b.json["skins"][0]["joints"] = {1, 9};
  EXPECT_EQ(error(b.text()).substr(0, 34), "skins[0].joints[1]: out of range (");
  b = skinned();
  b.json["skins"][0]["inverseBindMatrices"] = 0;
  EXPECT_EQ(error(b.text()).substr(0, 54), "skins[0].inverseBindMatrices: the accessor's type does");
  b = skinned();
  b.json["nodes"][0]["skin"] = 3;
  EXPECT_EQ(error(b.text()).substr(0, 27), "nodes[0].skin: out of range");
}

TEST_F(Gltf, MorphTargetsFollowTheStoredWeights) {
  Builder b = simple();
  const std::vector<float> up{0, 0, 4, 0, 0, 4, 0, 0, 4, 0, 0, 8}, aside{1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0};
  primitive(b)["targets"] =
      Json::array({{{"POSITION", b.positions(up)}}, {{"POSITION", b.positions(aside)}}});
  EXPECT_EQ(make_world(loaded(b)).position(3), Vec3(1, 1, 0));  // weights that are not given are 0
  b.json["meshes"][0]["weights"] = {0.5, 0};
  EXPECT_EQ(make_world(loaded(b)).position(3), Vec3(1, 1, 4));
  // A node's own weights come first; the other node shows the mesh's, so there are two meshes.
  b.json["nodes"] = Json::array({{{"mesh", 0}, {"weights", {0.25, 1}}}, {{"mesh", 0}}});
  b.json["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = loaded(b);
  EXPECT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(make_world(scene).position(3), Vec3(2, 1, 2));
  EXPECT_EQ(make_world(scene).position(7), Vec3(1, 1, 4));
}

TEST_F(Gltf, InstancesOfANode) {
  Builder b = simple();
  const int places = floats(b, {0, 0, 0, 10, 0, 0, 0, 10, 0}, "VEC3", 3);
  const float half = std::sqrt(0.5f);
  const int turns = floats(b, {0, 0, 0, 1, 0, 0, half, half, 0, 0, 0, 1}, "VEC4", 4);
  const int sizes = floats(b, {1, 1, 1, 2, 2, 2, 3, 3, 3}, "VEC3", 3);
  Json& attributes = b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  attributes = {{"TRANSLATION", places}, {"ROTATION", turns}, {"SCALE", sizes}, {"_ID", sizes}};
  b.json["nodes"][0]["translation"] = {0, 0, 7};
  b.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const Scene scene = loaded(b);
  ASSERT_EQ(scene.instances.size(), 3u);
  EXPECT_EQ(scene.meshes.size(), 1u);
  const World world = make_world(scene);
  EXPECT_EQ(world.position(1), Vec3(1, 0, 7));
  // Twice as large, turned a quarter about z, then moved; the turn is given in single precision.
  EXPECT_NEAR(glm::length(world.position(5) - Vec3(10, 2, 7)), 0.0, 1e-6);
  EXPECT_EQ(world.position(10), Vec3(0, 13, 7));
  b.json["accessors"][static_cast<std::size_t>(sizes)]["count"] = 2;
  EXPECT_EQ(error(b.text()), "nodes[0].extensions.EXT_mesh_gpu_instancing: the attributes' counts differ");
}

TEST_F(Gltf, HiddenNodesAreNotShown) {
  Builder b = simple();
  b.json["nodes"] =
      Json::array({{{"mesh", 0}},
                   {{"children", {2}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}},
                   {{"mesh", 0}}});
  b.json["scenes"][0]["nodes"] = {0, 1};
  EXPECT_EQ(loaded(b).instances.size(), 1u);
}

TEST_F(Gltf, ALightThatIsNotUsedIsNotDenied) {
  Builder b = simple();
  b.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({{{"type", "directional"}}});
  b.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  const std::size_t node = b.json["nodes"].size() - 1;
  const auto says = [&](const std::string& why) {
    const Scene scene = loaded(b);
    EXPECT_FALSE(test::has_note(scene, "the file has none")) << why;
    return test::has_note(scene, "Made, as " + why);
  };
  EXPECT_TRUE(says("no node that is shown has one of the file's lights"));
  b.json["scenes"][0]["nodes"].push_back(node);
  EXPECT_EQ(loaded(b).lights[0].name.find("sun"), std::string::npos) << "it is used";
  b.json["nodes"][node]["extensions"]["KHR_node_visibility"]["visible"] = false;
  EXPECT_TRUE(says("the file hides its lights"));
  b.json["nodes"][node]["extensions"].erase("KHR_node_visibility");
  b.json["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "laser";
  EXPECT_TRUE(says("none of the file's lights can be used"));
}

}  // namespace
}  // namespace gnomon::gltf_test
