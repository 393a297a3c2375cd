// glTF and GLB files that are wrong, cut off or hostile: an error with its path, or a scene, never more.
#include <functional>

#include "tests/support/gltf_support.h"

namespace gnomon::gltf_test {
namespace {

struct GltfMistake {
  std::string_view what;
  std::function<void(Builder&)> break_it;
  std::string_view start;
};

TEST_F(Gltf, MistakesHaveTheirPath) {
  const auto primitive = [](Builder& b) -> Json& { return b.json["meshes"][0]["primitives"][0]; };
  const GltfMistake mistakes[] = {
      {"no asset", [](Builder& b) { b.json.erase("asset"); }, ": asset is missing"},
      {"version", [](Builder& b) { b.json["asset"]["version"] = "1.0"; },
       "asset.version: unknown version (got \"1.0\", allowed 2.x)"},
      {"count 2^62", [](Builder& b) { b.json["accessors"][0]["count"] = 4611686018427387904; },
       "accessors[0].count: out of range (got 4611686018427387904"},
      {"count beyond", [](Builder& b) { b.json["accessors"][0]["count"] = 5; },
       "accessors[0]: reaches past its bufferView (got bytes up to 60, allowed up to 48)"},
      {"negative count", [](Builder& b) { b.json["accessors"][0]["count"] = -1; },
       "accessors[0].count: out of range (got -1"},
      {"count without data",
       [](Builder& b) {
         b.json["accessors"][0].erase("bufferView"), b.json["accessors"][0]["count"] = 4000000000;
       },
       "accessors[0].count: no data stands behind these elements"},
      {"offset", [](Builder& b) { b.json["accessors"][0]["byteOffset"] = 4; },
       "accessors[0]: reaches past its bufferView"},
      {"huge offset", [](Builder& b) { b.json["accessors"][0]["byteOffset"] = 9007199254740992; },
       "accessors[0]: reaches past its bufferView"},
      {"view", [](Builder& b) { b.json["bufferViews"][0]["byteLength"] = 1000; },
       "bufferViews[0]: reaches past its buffer"},
      {"view index", [](Builder& b) { b.json["accessors"][0]["bufferView"] = 7; },
       "accessors[0].bufferView: out of range (got 7, allowed a whole number in [0, 1])"},
      {"component type", [](Builder& b) { b.json["accessors"][0]["componentType"] = 5124; },
       "accessors[0].componentType: unknown component type"},
      {"type", [](Builder& b) { b.json["accessors"][0]["type"] = "VEC5"; },
       "accessors[0].type: unknown type"},
      {"position type", [](Builder& b) { b.json["accessors"][0]["type"] = "VEC2"; },
       "meshes[0].primitives[0].attributes.POSITION: the accessor's type does not fit (got VEC2, allowed "
       "VEC3)"},
      {"vertex index", [](Builder& b) { b.buffer[48] = 4; },
       "meshes[0].primitives[0].indices[0]: vertex index out of range (got 4, allowed 0 to 3)"},
      {"accessor index", [&](Builder& b) { primitive(b)["indices"] = 9; },
       "meshes[0].primitives[0].indices: out of range"},
      {"material index", [&](Builder& b) { primitive(b)["material"] = 0; },
       "meshes[0].primitives[0].material: refers to a list that is empty or missing"},
      {"mode", [&](Builder& b) { primitive(b)["mode"] = 7; }, "meshes[0].primitives[0].mode: out of range"},
      {"no attributes", [&](Builder& b) { primitive(b).erase("attributes"); },
       "meshes[0].primitives[0]: attributes is missing"},
      {"no POSITION",
       [&](Builder& b) {
         primitive(b)["attributes"] = {{"NORMAL", 0}};
       },
       ": the file has no triangles"},
      {"NaN", [](Builder& b) { b.buffer.replace(0, 4, "\xff\xff\xff\x7f"); },
       "meshes[0].primitives[0].attributes.POSITION[0]: position (got [nan, 0, 0], allowed up to 1e+15 in "
       "magnitude)"},
      {"own child", [](Builder& b) { b.json["nodes"][0]["children"] = {0}; },
       "nodes[0]: the node is its own ancestor"},
      {"cycle",
       [](Builder& b) {
         b.json["nodes"] = Json::array({{{"children", {1}}}, {{"children", {0}}}});
       },
       "nodes[0]: the node is its own ancestor"},
      {"two parents",
       [](Builder& b) {
         b.json["nodes"] = Json::array({{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}});
       },
       "nodes[1].children[0]: node 2 has two parents (0 and 1)"},
      {"child index", [](Builder& b) { b.json["nodes"][0]["children"] = {-1}; },
       "nodes[0].children[0]: out of range (got -1"},
      {"matrix",
       [](Builder& b) {
         b.json["nodes"][0]["matrix"] = {1, 2, 3};
       },
       "nodes[0].matrix: wrong type (got an array of 3, allowed an array of 16)"},
      {"huge matrix",
       [](Builder& b) {
         b.json["nodes"][0]["translation"] = {1e200, 0, 0};
       },
       "instances[0].matrix: is not finite or above 1e+15 in magnitude"},
      {"scene index", [](Builder& b) { b.json["scene"] = 3; }, "scene: out of range (got 3"},
      {"light index",
       [](Builder& b) { b.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0; },
       "nodes[0].extensions.KHR_lights_punctual.light: refers to a list that is empty or missing"},
      {"stride", [](Builder& b) { b.json["bufferViews"][0]["byteStride"] = 13; },
       "bufferViews[0].byteStride: not a multiple of 4 (got 13, allowed 4 to 252)"},
      {"camera without type", [](Builder& b) { b.json["cameras"][0]["name"] = "eye"; },
       "cameras[0]: type is missing"},
      {"camera type", [](Builder& b) { b.json["cameras"][0]["type"] = "fisheye"; },
       "cameras[0].type: unknown value (got \"fisheye\", allowed perspective, orthographic)"},
      {"camera without numbers", [](Builder& b) { b.json["cameras"][0]["type"] = "perspective"; },
       "cameras[0]: perspective is missing"},
      {"orthographic",
       [](Builder& b) {
         b.json["cameras"][0] = {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", "x"}}}};
       },
       "cameras[0].orthographic.ymag: wrong type (got \"x\", allowed a number > 0)"},
      {"light without type",
       [](Builder& b) { b.json["extensions"]["KHR_lights_punctual"]["lights"][0]["name"] = "sun"; },
       "extensions.KHR_lights_punctual.lights[0]: type is missing"},
      {"spot", [](Builder& b) { b.json["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "spot"; },
       "extensions.KHR_lights_punctual.lights[0]: spot is missing"},
      {"sparse count",
       [](Builder& b) {
         b.json["accessors"][0]["sparse"] = {{"count", 5},
                                             {"indices", {{"bufferView", 1}, {"componentType", 5121}}},
                                             {"values", {{"bufferView", 0}}}};
       },
       "accessors[0].sparse.count: out of range (got 5"},
      {"sparse overrun",
       [](Builder& b) {
         b.json["accessors"][0]["sparse"] = {{"count", 4},
                                             {"indices", {{"bufferView", 1}, {"componentType", 5125}}},
                                             {"values", {{"bufferView", 0}}}};
       },
       "accessors[0].sparse.indices: reaches past its bufferView"},
      {"draco",
       [&](Builder& b) {
         primitive(b)["extensions"]["KHR_draco_mesh_compression"] = Json::object();
         for (Json& accessor : b.json["accessors"]) accessor.erase("bufferView");
       },
       "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression: bufferView or attributes is missing"},
      {"wrong types", [](Builder& b) { b.json["meshes"] = "none"; }, "meshes: wrong type"},
      {"number for object", [](Builder& b) { b.json["nodes"][0] = 5; },
       "nodes[0]: wrong type (got 5, allowed an object)"},
  };
  for (const GltfMistake& m : mistakes) {
    Builder b = simple();
    m.break_it(b);
    const std::string message = error(b.text());
    EXPECT_EQ(message.substr(0, m.start.size()), m.start) << m.what << "\n  " << message;
  }
  const auto scene = load(R"({
  "asset": {"version": "2.0"},
  "scene": 4})");
  EXPECT_EQ(scene.error().message(),
            path_ + ":3:12: scene: refers to a list that is empty or missing (got 4, allowed no index)");
}

TEST_F(Gltf, HostileContainers) {
  const std::string glb = simple().glb();
  const auto patched = [&](std::size_t at, char value) {
    std::string bytes = glb;
    bytes[at] = value;
    return bytes;
  };
  EXPECT_EQ(error("", "m.glb"), "magic: not a GLB file (it must start with \"glTF\")");
  EXPECT_EQ(error("glTG", "m.glb"), "magic: not a GLB file (it must start with \"glTF\")");
  EXPECT_EQ(error(glb.substr(0, 12), "m.glb"),
            "header: the file is cut off (got 12 bytes, allowed 20 or more)");
  EXPECT_EQ(error(patched(4, 1), "m.glb"), "version: unknown version (got 1, allowed 2)");
  EXPECT_EQ(error(glb.substr(0, glb.size() - 4), "m.glb").substr(0, 31), "length: more than the file has ");
  EXPECT_EQ(error(glb + "more", "m.glb"), "loaded");  // the specification's validator only warns
  EXPECT_EQ(error(patched(14, '\x7f'), "m.glb").substr(0, 32), "chunks[0]: the chunk is cut off ");
  EXPECT_EQ(error(patched(16, 'B'), "m.glb"), "chunks[0]: the first chunk is not JSON");
  for (std::size_t n = 0; n < glb.size(); n += 7) EXPECT_NE(error(glb.substr(0, n), "m.glb"), "loaded") << n;
}

TEST_F(Gltf, ConfinedBuffers) {
  Builder b = simple();
  folder_.put("data.bin", b.buffer);
  b.text();
  b.json["buffers"][0]["uri"] = "../data.bin";
  const std::string path = folder_.put("in/m.gltf", b.json.dump());
  EXPECT_TRUE(load_scene(path));
  LoadOptions confined;
  confined.confine_paths = true;
  const auto refused = load_scene(path, confined);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message().find("outside the scene's folder"), std::string::npos)
      << refused.error().message();
  folder_.put("in/data.bin", b.buffer);
  b.json["buffers"][0]["uri"] = "data.bin";
  const auto inside = load_scene(folder_.put("in/m.gltf", b.json.dump()), confined);
  EXPECT_TRUE(inside) << inside.error().message();
}

// Any one byte of a small file changed: an error or a scene, never more.
TEST_F(Gltf, EveryByteFlipped) {
  const std::string glb = simple().glb();
  int errors = 0;
  for (std::size_t i = 0; i < glb.size(); ++i) {
    std::string bytes = glb;
    bytes[i] = static_cast<char>(bytes[i] ^ 0x15);
    errors += !load(bytes, "m.glb");
  }
  EXPECT_GT(errors, 200);
}

}  // namespace
}  // namespace gnomon::gltf_test
