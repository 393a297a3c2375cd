// Cut-outs of OBJ files: map_d of map_Kd's file, however the two are spelt, and of a file of its own.
#include "scene/files/pictures/image_io.h"
#include "scene/load.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

class ObjAlpha : public ::testing::Test {
 protected:
  ObjAlpha() {
    Texture leaf;
    leaf.size = {2, 1};
    leaf.texels = {{200, 100, 50, 255}, {200, 100, 50, 0}};
    const auto png = encode_png(leaf);
    EXPECT_TRUE(png);
    folder.put("rgba.png", *png);
    folder.put("tex/rgba.png", *png);
    Rgb8Image grey({2, 1});
    grey.data = {{0, 0, 0}, {255, 255, 255}};
    EXPECT_TRUE(write_png(folder.file("grey.png"), grey));
    Rgb8Image colours({3, 1});
    colours.data = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}};
    EXPECT_TRUE(write_png(folder.file("colours.png"), colours));
  }

  Scene load(const std::string& statements) const {
    folder.put("m.mtl", "newmtl a\nKd 1 1 1\n" + statements);
    auto scene =
        load_scene(folder.put("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"));
    EXPECT_TRUE(scene) << scene.error().message();
    return scene ? std::move(*scene) : Scene();
  }
  bool is_cut_out(const std::string& statements) const {
    const Scene scene = load(statements);
    return scene.materials.front().alpha_mode == AlphaMode::mask && !test::has_note(scene, "map_d");
  }
  TemporaryFolder folder;
};

TEST_F(ObjAlpha, OneFileHasManySpellings) {
  EXPECT_TRUE(is_cut_out("map_Kd rgba.png\nmap_d rgba.png\n"));
  EXPECT_TRUE(is_cut_out("map_Kd ./rgba.png\nmap_d rgba.png\n"));
  EXPECT_TRUE(is_cut_out("map_Kd rgba.png\nmap_d ./rgba.png\n"));
  EXPECT_TRUE(is_cut_out("map_Kd tex\\rgba.png\nmap_d tex/rgba.png\n"));
  EXPECT_TRUE(is_cut_out("map_Kd tex/../rgba.png\nmap_d rgba.png\n"));
  EXPECT_TRUE(is_cut_out("map_Kd rgba.png\nmap_d " + folder.file("rgba.png") + "\n"));
}

// Crytek's Sponza has its leaves and chains so.
TEST_F(ObjAlpha, AMaskOfItsOwn) {
  EXPECT_TRUE(is_cut_out("map_Kd colours.png\nmap_d grey.png\n"));
  const Scene leaf = load("map_Kd rgba.png\nmap_d grey.png\n");
  ASSERT_EQ(leaf.textures.size(), 1u);
  EXPECT_EQ(leaf.textures[0].texels, (std::vector<glm::u8vec4>{{200, 100, 50, 0}, {200, 100, 50, 255}}));
  const Scene other = load("map_Kd grey.png\nmap_d tex/rgba.png\n");
  EXPECT_EQ(other.textures[0].texels, (std::vector<glm::u8vec4>{{0, 0, 0, 255}, {255, 255, 255, 0}}));
  EXPECT_TRUE(other.textures[0].srgb);
}

// MTL's default for maps that are numbers, -imfchan l; colours are what a JPEG makes of a grey mask.
TEST_F(ObjAlpha, AMaskInColoursIsItsLuminance) {
  const Scene scene =
      load("map_Kd colours.png\nmap_d ./tex/../colours.png\nnewmtl b\nmap_Kd rgba.png\nmap_d colours.png\n");
  EXPECT_EQ(scene.materials[0].alpha_mode, AlphaMode::opaque);
  EXPECT_EQ(scene.materials[1].alpha_mode, AlphaMode::mask);
  const std::vector<glm::u8vec4>& texels = scene.textures[scene.materials[1].diffuse_texture].texels;
  ASSERT_EQ(texels.size(), 3u);
  EXPECT_EQ(texels[0], glm::u8vec4(200, 100, 50, 54));  // 0.2126 of 255
  EXPECT_EQ(texels[1].a, 182);
  EXPECT_EQ(texels[2].a, 18);
}

TEST_F(ObjAlpha, AMaskAloneLeavesThePlainColour) {
  const Scene scene = load("Kd 0.5 0.25 1\nmap_d -clamp on -s 2 1 1 grey.png\n");
  EXPECT_EQ(scene.materials[0].diffuse, Vec3f(0.5f, 0.25f, 1.0f));
  EXPECT_EQ(scene.materials[0].texture_transform.scale, Vec2(2.0, 1.0));
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_FALSE(scene.textures[0].repeat_s);
  EXPECT_EQ(scene.textures[0].texels, (std::vector<glm::u8vec4>{{255, 255, 255, 0}, {255, 255, 255, 255}}));
}

// Six texels of three: the middle of each pair lies where the lookup mixes a quarter of the next texel in.
TEST_F(ObjAlpha, ColoursAndMaskOfOtherSizesMeetAtTheLarger) {
  Rgb8Image mask({6, 2});
  for (std::size_t i = 0; i < mask.data.size(); ++i) mask.data[i] = glm::u8vec3(i % 2 == 0 ? 0 : 255);
  ASSERT_TRUE(write_png(folder.file("mask.png"), mask));
  const Scene scene = load("map_Kd -clamp on colours.png\nmap_d -clamp on mask.png\n");
  const Texture& made = scene.textures.at(0);
  ASSERT_EQ(made.size, (ImageSize{6, 2}));
  EXPECT_EQ(made.texels[0], glm::u8vec4(255, 0, 0, 0));
  EXPECT_EQ(made.texels[1], glm::u8vec4(225, 137, 0, 255));  // 0.75 and 0.25 of light, sRGB-encoded
  EXPECT_EQ(made.texels[2], glm::u8vec4(137, 225, 0, 0));
  EXPECT_EQ(made.texels[11], glm::u8vec4(0, 0, 255, 255));
}

TEST_F(ObjAlpha, WhatIsNotThereIsNoted) {
  const Scene no_mask = load("map_Kd colours.png\nmap_d none.png\n");
  EXPECT_EQ(no_mask.materials[0].alpha_mode, AlphaMode::opaque);
  EXPECT_TRUE(test::has_note(no_mask, "none.png is not there; map_d is not used"));
  const Scene no_colours = load("map_Kd none.png\nmap_d grey.png\n");
  EXPECT_EQ(no_colours.materials[0].alpha_mode, AlphaMode::mask);
  EXPECT_TRUE(test::has_note(no_colours, "none.png is not there; its plain colour is used"));
}

// A grey image is a picture of numbers; one in colours is no mask, and its material stays opaque.
TEST_F(ObjAlpha, GreyStandsForAlpha) {
  const Scene grey = load("map_Kd grey.png\nmap_d grey.png\n");
  EXPECT_EQ(grey.materials.front().alpha_mode, AlphaMode::mask);
  ASSERT_EQ(grey.textures.size(), 1u);
  EXPECT_EQ(grey.textures[0].texels[0], glm::u8vec4(0, 0, 0, 0));
  EXPECT_EQ(grey.textures[0].texels[1], glm::u8vec4(255, 255, 255, 255));
  EXPECT_TRUE(test::has_note(grey, "map_d is the grey of grey.png, which has no alpha channel"));
  const Scene colours = load("map_Kd colours.png\nmap_d colours.png\n");
  EXPECT_EQ(colours.materials.front().alpha_mode, AlphaMode::opaque);
  EXPECT_EQ(colours.textures[0].texels[0], glm::u8vec4(255, 0, 0, 255));
  EXPECT_TRUE(test::has_note(colours, "map_d is not used: colours.png has colours and no alpha channel"));
}

TEST_F(ObjAlpha, GreyIsOfTheMaterialThatAsksForIt) {
  const Scene scene = load(
      "map_Kd grey.png\nmap_d grey.png\nnewmtl plain\nmap_Kd grey.png\nnewmtl clamped\n"
      "map_Kd -clamp on grey.png\n");
  ASSERT_EQ(scene.textures.size(), 3u);
  EXPECT_EQ(scene.textures[scene.materials[0].diffuse_texture].texels[0].a, 0);
  EXPECT_EQ(scene.textures[scene.materials[1].diffuse_texture].texels[0].a, 255);
  EXPECT_EQ(scene.textures[scene.materials[2].diffuse_texture].texels[0].a, 255);
}

TEST_F(ObjAlpha, AnAlphaChannelIsTakenAsItIs) {
  const Scene scene = load("map_Kd rgba.png\nmap_d rgba.png\n");
  EXPECT_EQ(scene.textures[0].texels[0], glm::u8vec4(200, 100, 50, 255));
  EXPECT_EQ(scene.textures[0].texels[1].a, 0);
}

TEST_F(ObjAlpha, PlacesOfTheirOwnAreNoted) {
  const std::string note = "map_d lies as map_Kd does: its own -s, -o and -clamp are not used";
  for (const std::string option : {"-s 2 1 1", "-o 0.5 0 0", "-clamp on"}) {
    const Scene scene = load("map_Kd rgba.png\nmap_d " + option + " rgba.png\n");
    EXPECT_EQ(scene.materials.front().alpha_mode, AlphaMode::mask);
    EXPECT_TRUE(test::has_note(scene, note)) << option;
  }
  EXPECT_TRUE(is_cut_out("map_Kd -s 2 1 1 rgba.png\nmap_d -s 2 1 1 rgba.png\n"));
  EXPECT_TRUE(is_cut_out("map_Kd -s 2 rgba.png\nmap_d -s 2 1 1 rgba.png\n"));
}

TEST_F(ObjAlpha, AHaloKeepsItsDissolve) {
  const Scene scene = load("d -halo 0.25\n");
  EXPECT_EQ(scene.materials.front().transmission, 0.75f);
  EXPECT_TRUE(test::has_note(scene, "The option d -halo is not used"));
}

}  // namespace
}  // namespace gnomon
