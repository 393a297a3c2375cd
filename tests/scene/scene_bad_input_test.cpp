// Input that asks for more than it brings, and input that is unusual but allowed.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>

#include "scene/files/obj/mtl.h"
#include "scene/files/pictures/image_io.h"
#include "scene/load.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

/// 8-bit RGBA with this stream as its data.
std::string png(std::uint32_t width, std::uint32_t height, const std::string& stream) {
  return "\x89PNG\r\n\x1a\n" +
         test::png_chunk(
             "IHDR", test::big_endian(width) + test::big_endian(height) + std::string("\x08\x06\0\0\0", 5)) +
         test::png_chunk("IDAT", stream) + test::png_chunk("IEND", "");
}

long peak_kilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

// Four letters of a WebP file, and no more.
TEST(BadInput, AnImageMayEndAfterItsFirstLetters) {
  const auto texture = read_texture_bytes("t.png", "RIFF", true);
  ASSERT_FALSE(texture);
  EXPECT_EQ(texture.error().kind, ErrorKind::bad_input);
}

// A gigabyte of pixels in a file of 75 bytes: refused for its size alone.
TEST(BadInput, AnImageNeedsBytesForItsPixels) {
  const long before = peak_kilobytes();
  ::testing::internal::CaptureStderr();
  const auto texture = read_texture_bytes("bomb", png(16384, 16384, "\x78\x9c\x03\0\0\0\0\x01"), true);
  ASSERT_FALSE(texture);
  EXPECT_EQ(texture.error().kind, ErrorKind::bad_input);
  EXPECT_NE(texture.error().message().find("cannot hold 16384 x 16384 pixels"), std::string::npos)
      << texture.error().message();
  EXPECT_LT(peak_kilobytes() - before, 200'000);
  // Data that unpacks to less than the picture: our words alone.
  const auto damaged = read_texture_bytes("short", png(8, 8, "\x78\x9c\x03\0\0\0\0\x01"), true);
  ASSERT_FALSE(damaged);
  EXPECT_NE(damaged.error().message().find("the PNG file is damaged: Not enough image data"),
            std::string::npos);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(BadInput, AnExrHasNoDateOfItsMaking) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  const std::vector<Channel> channels{{"R", {1.0f, 2.0f}}};
  ASSERT_TRUE(write_exr(path, {2, 1}, channels));
  EXPECT_EQ(test::bytes_of(path).find("capDate"), std::string::npos);
  EXPECT_TRUE(read_channels(path));
}

/// What is wrong with the library.
std::string mtl_error(const std::string& text) {
  const auto library = parse_mtl(text, "m.mtl");
  return library ? "nothing" : library.error().message();
}

TEST(BadInput, OptionsOfTexturesMayBeShort) {
  const auto library = parse_mtl(
      "newmtl a\nmap_Kd -s 2 my tex.png\r\nnewmtl b\n map_Kd -blendu on -o 0.5 0.25 -clamp on t.png \n"
      "map_d -clamp off -mm 0 1 m.png\nmap_Bump -bm 1 n.png\nKd 1 1 1",
      "m.mtl");
  ASSERT_TRUE(library);
  ASSERT_EQ(library->materials.size(), 2u);
  const MtlTexture& a = library->materials[0].colours;
  EXPECT_EQ(a.file, "my tex.png");
  EXPECT_EQ(a.scale, Vec2(2.0, 1.0));
  EXPECT_FALSE(a.clamped);
  const MtlMaterial& b = library->materials[1];
  EXPECT_EQ(b.colours.file, "t.png");
  EXPECT_EQ(b.colours.offset, Vec2(0.5, 0.25));
  EXPECT_TRUE(b.colours.clamped);
  EXPECT_EQ(b.mask.file, "m.png");
  EXPECT_FALSE(b.mask.clamped);
  EXPECT_EQ(b.other_maps, std::set<std::string>{"bump"});
  EXPECT_EQ(b.diffuse, Vec3(1.0));
  EXPECT_EQ(library->notes, std::vector<std::string>{"The option map_d -mm of textures is not used."});
}

TEST(BadInput, TheDissolveOfAMaterial) {
  const auto library = parse_mtl(
      "d 0.1\nnewmtl a\n  d -halo 0.5\r\nnewmtl b c \nd 0.25\nTr 0.5\nnewmtl d\nTr .75\nnewmtl\nTr 1\n",
      "m.mtl");
  ASSERT_TRUE(library);
  ASSERT_EQ(library->materials.size(), 3u);  // what has no name is none
  EXPECT_EQ(library->materials[0].dissolve, 0.5);
  EXPECT_EQ(library->materials[1].name, "b c");
  EXPECT_EQ(library->materials[1].dissolve, 0.25);
  EXPECT_EQ(library->materials[2].dissolve, 0.25);
  EXPECT_TRUE(library->materials[2].has_full_transparency);
  EXPECT_EQ(library->notes, std::vector<std::string>{
                                "The option d -halo is not used: as much is let through at every angle."});
  EXPECT_EQ(library->warnings,
            std::set<std::string>{"Material 'b c': Tr is not used, since d is given, too."});
}

// Wavefront's format: one number is a grey.
TEST(BadInput, NumbersOfMaterialsAreNumbers) {
  const auto library = parse_mtl(
      "newmtl a\rKd 0.8\rKs .5 5e-1 1 # light\rNs 96\rnewmtl b\nKd 0.1 \\\n 0.2 0.3\nillum 7 x\nTf 0.3\n"
      "newmtl c\nKd spectral red.rfl 1\n",
      "m.mtl");
  ASSERT_TRUE(library);
  ASSERT_EQ(library->materials.size(), 3u);
  const MtlMaterial &a = library->materials[0], &b = library->materials[1];
  EXPECT_EQ(a.diffuse, Vec3(0.8));
  EXPECT_EQ(a.specular, Vec3(0.5, 0.5, 1.0));
  EXPECT_EQ(a.shininess, 96.0);
  EXPECT_EQ(b.diffuse, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(b.illum, 7);
  EXPECT_EQ(b.transmittance, Vec3(0.3));
  EXPECT_EQ(library->materials[2].diffuse, std::nullopt);
  EXPECT_EQ(library->notes, std::vector<std::string>{"The option Kd spectral is not used."});
  EXPECT_EQ(mtl_error("newmtl a\nKd 0,8 0,1 0,1\n"),
            "m.mtl:2:4: Kd: not a finite number (got 0,8, allowed for example 0.8)");
  EXPECT_EQ(mtl_error("Ns nan\n"), "m.mtl:1:4: Ns: not a finite number (got nan, allowed for example 0.8)");
  EXPECT_EQ(mtl_error("Kd 1 1\n"), "m.mtl:1:7: Kd: too few numbers (got 2, allowed 1 or 3)");
  EXPECT_EQ(mtl_error("Kd 0.1 \\\n x\n"),
            "m.mtl:2:2: Kd: not a finite number (got x, allowed for example 0.8)");
  EXPECT_EQ(mtl_error("newmtl a\nTr\n"), "m.mtl:2:3: Tr: too few numbers (got 0, allowed 1)");
}

const std::string triangle =
    R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
       "bufferViews":[{"buffer":0,"byteLength":36}],"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}])";
const std::string code = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";

std::string gltf(const std::string& more, const std::string& primitive = "",
                 const std::string& padding = "") {
  return std::string("{") + triangle +
         R"(,"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)" + code + padding +
         R"("}],"meshes":[{"primitives":[{"attributes":{"POSITION":0})" + primitive + "}]}]" + more + "}";
}

TEST(ValidGltf, IsNotRefused) {
  const std::string node = R"(,"nodes":[{"mesh":0}])";
  const std::vector<std::string> files = {
      gltf(R"(,"nodes":[{"mesh":0,"skin":0},{"name":"j"}],"skins":[{"joints":[1]}])"),
      gltf(node, "", "AAAAAA=="),
      gltf(node + R"(,"extensionsUsed":["KHR_materials_unlit"],"extensionsRequired":["KHR_materials_unlit"],
                     "materials":[{"extensions":{"KHR_materials_unlit":{}}}])",
           R"(,"material":0)"),
      gltf(node + R"(,"extensionsUsed":["KHR_draco_mesh_compression"])",
           R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}})")};
  const TemporaryFolder folder;
  for (const std::string& text : files) {
    const auto scene = load_scene(folder.put("a.gltf", text));
    ASSERT_TRUE(scene) << scene.error().message();
    EXPECT_EQ(scene->meshes.front().triangles.size(), 1u);
  }
  // A file beside it that is longer than the buffer, and one that is shorter.
  for (const std::size_t size : {40u, 32u}) {
    folder.put("a.bin", std::string(size, '\0'));
    const std::string path = folder.put("a.gltf", std::string("{") + triangle +
                                                      R"(,"buffers":[{"byteLength":36,"uri":"a.bin"}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}]})");
    EXPECT_EQ(load_scene(path).has_value(), size == 40u);
  }
}

TEST(ValidGltf, ManyLightsOfOneName) {
  std::string nodes = R"(,"nodes":[{"mesh":0})", roots = "0";
  constexpr int lights = 4000;
  for (int i = 1; i <= lights; ++i) {
    nodes += R"(,{"name":"lamp","extensions":{"KHR_lights_punctual":{"light":0}}})";
    roots.append(1, ',').append(std::to_string(i));
  }
  std::string text = gltf(nodes + R"(],"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}})");
  const std::string all = std::string("\"nodes\":[").append(roots).append("]");
  text.replace(text.find("\"nodes\":[0]"), 11, all);
  const TemporaryFolder folder;
  const auto scene = load_scene(folder.put("lights.gltf", text));
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(scene->lights.size(), static_cast<std::size_t>(lights));
  EXPECT_EQ(scene->lights[0].name, "lamp");
  EXPECT_EQ(scene->lights.back().name, "lamp-4000");
}

}  // namespace
}  // namespace gnomon
