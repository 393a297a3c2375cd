// Textures that would take more memory than is allowed are refused by their headers, whatever format names them.
#include <gtest/gtest.h>

#include "scene/files/pictures/image_io.h"
#include "scene/files/pictures/texture_memory.h"
#include "scene/load.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

class TextureBytes : public ::testing::Test {
 protected:
  void png(const std::string& name, const ImageSize& size) {
    ASSERT_TRUE(write_png(folder_.file(name), Rgb8Image(size)));
  }

  std::string json(const std::string& textures) {
    std::string materials;
    int number = 0;
    for (std::size_t at = 0, end = 0; at < textures.size(); at = end + 1) {
      end = std::min(textures.find(' ', at), textures.size());
      const std::string one = textures.substr(at, end - at);
      materials += (number == 0 ? "" : ", ") + std::string(R"({"name": "m)") + std::to_string(number) +
                   R"(", "texture": )" + (one.front() == '{' ? one : R"({"file": ")" + one + R"("})") + "}";
      ++number;
    }
    return folder_.put("scene.json", R"({"schema": "gnomon/scene/1",
      "meshes": [{"name": "floor", "generate": {"kind": "floor", "size": [4, 4]}}],
      "instances": [{"mesh": "floor", "material": "m0"}], "materials": [)" +
                                         materials + "]}");
  }

  /// The scene loads where its textures may take so many bytes, and with one less is refused.
  static void expect_bytes(const std::string& path, double bytes, const std::string& file) {
    TextureMemory enough(bytes, "enough"), less(bytes - 1.0, "too little");
    const auto loaded = load_scene(path, {.textures = &enough});
    EXPECT_TRUE(loaded) << loaded.error().message();
    const auto refused = load_scene(path, {.textures = &less});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::graphics);
    const std::string said = refused.error().message();
    EXPECT_NE(said.find(file), std::string::npos) << said;
    EXPECT_NE(said.find("too much memory (got "), std::string::npos) << said;
    EXPECT_NE(said.find("allowed too little"), std::string::npos) << said;
  }

  TemporaryFolder folder_;
};

TEST_F(TextureBytes, OfAJsonSceneAreAddedUp) {
  png("a.png", {16, 8}), png("b.png", {8, 8});
  expect_bytes(json("a.png a.png b.png"), 4 * (16 * 8 + 8 * 8), "b.png: ");
}

TEST_F(TextureBytes, OfGeneratedOnesCount) {
  expect_bytes(json(R"({"generate":{"kind":"noise","resolution":16}})"), 4 * 16 * 16, "scene.json: ");
}

TEST_F(TextureBytes, OfFloatsAreFloats) {
  const std::vector<float> values(64, 0.5f);
  ASSERT_TRUE(write_exr(folder_.file("a.exr"), {8, 8},
                        std::vector<Channel>{{"R", values}, {"G", values}, {"B", values}}));
  expect_bytes(json("a.exr"), 12 * 8 * 8, "a.exr: ");
}

TEST_F(TextureBytes, OfAModelInASceneCountWithItsOwn) {
  png("a.png", {16, 8}), png("b.png", {8, 8});
  folder_.put("m.mtl", "newmtl a\nmap_Kd b.png\n");
  folder_.put("m.obj", "mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_bytes(folder_.put("scene.json", R"({"schema": "gnomon/scene/1",
      "materials": [{"name": "m0", "texture": {"file": "a.png"}}],
      "meshes": [{"name": "model", "file": "m.obj"}], "instances": [{"mesh": "model"}]})"),
               4 * (16 * 8 + 8 * 8), ".png: ");
}

// A thin picture and a thin mask across it make one that is large both ways.
TEST_F(TextureBytes, OfAMaskAcrossItsColours) {
  png("wide.png", {64, 1}), png("high.png", {1, 64});
  folder_.put("m.mtl", "newmtl a\nmap_Kd wide.png\nmap_d high.png\n");
  expect_bytes(folder_.put("m.obj", "mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
               4 * (64 + 64 * 64), "high.png: ");
}

// Each texture of a glTF file is kept, also where several have one image. What only a mean is taken of is let go.
TEST_F(TextureBytes, OfAGltfFile) {
  png("a.png", {16, 8}), png("rough.png", {16, 8});
  const std::string positions =
      "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";  // (0 0 0) (1 0 0) (0 1 0)
  const std::string path = folder_.put("m.gltf", R"({"asset": {"version": "2.0"}, "images": [{"uri": "a.png"},
    {"uri": "rough.png"}], "textures": [{"source": 0}, {"source": 0}, {"source": 1}], "materials": [
    {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 2}}},
    {"pbrMetallicRoughness": {"baseColorTexture": {"index": 1}}}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,)" +
                                                     positions + R"("}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}], "accessors": [{"bufferView": 0, "componentType": 5126,
      "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}], "nodes": [{"mesh": 0}],
    "scenes": [{"nodes": [0]}], "scene": 0})");
  expect_bytes(path, 4.0 * 2 * 16 * 8, "m.gltf: images[");
}

}  // namespace
}  // namespace gnomon
