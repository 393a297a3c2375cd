// Input that asks for more than it brings, and input that is unusual but allowed.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>

#include "scene/files/image_io.h"
#include "scene/files/mtl_options.h"
#include "scene/load.h"
#include "tests/scene_files_support.h"

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
  const auto folder = std::filesystem::temp_directory_path() / "gnomon-exr-date";
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "a.exr").string();
  const std::vector<Channel> channels{{"R", {1.0f, 2.0f}}};
  ASSERT_TRUE(write_exr(path, {2, 1}, channels));
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(bytes.find("capDate"), std::string::npos);
  EXPECT_TRUE(read_channels(path));
  std::filesystem::remove_all(folder);
}

/// The library as it is read; an error's message.
std::string read_mtl(const std::string& text, std::vector<std::string>& notes) {
  const auto plain = plain_mtl(text, "m.mtl", notes);
  return plain ? *plain : plain.error().message();
}

TEST(BadInput, OptionsOfTexturesMayBeShort) {
  std::vector<std::string> notes;
  EXPECT_EQ(read_mtl("newmtl a\nmap_Kd -s 2 my tex.png\r\nmap_Kd -blendu on -o 0.5 0.25 -clamp on t.png\n"
                     "map_Kd -mm 0 1 t.png\nKd 1 1 1",
                     notes),
            "newmtl a\nmap_Kd -s 2 1 1 my tex.png\nmap_Kd -o 0.5 0.25 0 -clamp on t.png\n"
            "map_Kd t.png\nKd 1 1 1\n");
  EXPECT_EQ(notes, std::vector<std::string>{"The option map_Kd -mm of textures is not used."});
}

TEST(BadInput, TheHaloOfADissolve) {
  std::vector<std::string> notes;
  EXPECT_EQ(read_mtl("newmtl a\n  d -halo 0.5\r\nnewmtl b\nd 0.25\ndisp -halo.png\n", notes),
            "newmtl a\nd 0.5\nnewmtl b\nd 0.25\ndisp -halo.png\n");
  EXPECT_EQ(notes, std::vector<std::string>{
                       "The option d -halo is not used: as much is let through at every angle."});
}

// Wavefront's format: one number is a grey. tinyobjloader reads a word that is no number as 0.
TEST(BadInput, NumbersOfMaterialsAreNumbers) {
  std::vector<std::string> notes;
  EXPECT_EQ(read_mtl("Kd 0.8\rKs .5 5e-1 1 # light\rNs 96\r", notes),
            "Kd 0.8 0.8 0.8\nKs .5 5e-1 1\nNs 96\n");
  EXPECT_EQ(read_mtl("newmtl a\nKd 0.1 \\\n 0.2 0.3\n", notes), "newmtl a\nKd 0.1 0.2 0.3\n");
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(read_mtl("Kd spectral red.rfl 1\n", notes), "\n");
  EXPECT_EQ(notes, std::vector<std::string>{"The option Kd spectral is not used."});
  EXPECT_EQ(read_mtl("newmtl a\nKd 0,8 0,1 0,1\n", notes),
            "m.mtl:2:4: Kd: not a finite number (got 0,8, allowed for example 0.8)");
  EXPECT_EQ(read_mtl("Ns nan\n", notes),
            "m.mtl:1:4: Ns: not a finite number (got nan, allowed for example 0.8)");
  EXPECT_EQ(read_mtl("Kd 1 1\n", notes), "m.mtl:1:7: Kd: too few numbers (got 2, allowed 1 or 3)");
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
  const auto folder = std::filesystem::temp_directory_path() / "gnomon-valid-gltf";
  std::filesystem::create_directories(folder);
  for (const std::string& text : files) {
    const std::string path = (folder / "a.gltf").string();
    std::ofstream(path) << text;
    const auto scene = load_scene(path);
    ASSERT_TRUE(scene) << scene.error().message();
    EXPECT_EQ(scene->meshes.front().triangles.size(), 1u);
  }
  // A file beside it that is longer than the buffer, and one that is shorter.
  for (const std::size_t size : {40u, 32u}) {
    std::ofstream(folder / "a.bin", std::ios::binary) << std::string(size, '\0');
    std::ofstream(folder / "a.gltf") << std::string("{") + triangle +
                                            R"(,"buffers":[{"byteLength":36,"uri":"a.bin"}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}]})";
    EXPECT_EQ(load_scene((folder / "a.gltf").string()).has_value(), size == 40u);
  }
  std::filesystem::remove_all(folder);
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
  const auto path = (std::filesystem::temp_directory_path() / "gnomon-lights.gltf").string();
  std::ofstream(path) << text;
  const auto scene = load_scene(path);
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(scene->lights.size(), static_cast<std::size_t>(lights));
  EXPECT_EQ(scene->lights[0].name, "lamp");
  EXPECT_EQ(scene->lights.back().name, "lamp-4000");
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace gnomon
