// PLY: the three encodings give the same mesh, and hostile headers and data give one line.
#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "scene/load.h"
#include "scene/world.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

template <class T>
void append_binary(std::string& out, T value, bool big) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big) std::reverse(raw, raw + sizeof(T));
  out.append(raw, sizeof(T));
}

std::string header(const std::string& format, const std::string& vertices = "4",
                   const std::string& faces = "2") {
  return "ply\nformat " + format + " 1.0\ncomment made by hand\nelement vertex " + vertices +
         "\nproperty double x\nproperty float y\nproperty float z\nproperty float nx\nproperty float "
         "ny\nproperty float nz\n"
         "property float s\nproperty float t\nproperty uchar red\nelement face " +
         faces + "\nproperty uchar flags\nproperty list uchar int vertex_indices\nend_header\n";
}

const double xs[4] = {0.1, 1.0, 1.0, 0.0};
const float ys[4] = {0, 0, 1, 1};

std::string binary_quad(bool big) {
  std::string out = header(big ? "binary_big_endian" : "binary_little_endian");
  for (int i = 0; i < 4; ++i) {
    append_binary(out, xs[i], big);
    for (const float v : {ys[i], 0.0f, 0.0f, 0.0f, 1.0f, 0.25f, 0.75f}) append_binary(out, v, big);
    out += '\x80';
  }
  for (const std::array<int, 4>& face : {std::array{4, 0, 1, 2}, std::array{3, 0, 1, 2}}) {
    out += '\0';
    out += static_cast<char>(face[0]);
    for (std::size_t i = 1; i <= 3; ++i) append_binary(out, static_cast<std::int32_t>(face[i]), big);
    if (face[0] == 4) append_binary(out, std::int32_t{3}, big);
  }
  return out;
}

std::string text_quad() {
  return header("ascii") +
         "0.1 0 0 0 0 1 0.25 0.75 128\n1 0 0 0 0 1 0.25 0.75 128\n1 1 0 0 0 1 0.25 0.75 128\n0 1 0 0 0 1 "
         "0.25 0.75 128\n"
         "0 4 0 1 2 3\n0 3 0 1 2\n";
}

TEST(Ply, TheThreeEncodingsAgree) {
  const TemporaryFolder folder;
  for (const std::string& bytes :
       {text_quad(), "\xef\xbb\xbf" + text_quad(), binary_quad(false), binary_quad(true)}) {
    const auto scene = load_scene(folder.put("m.ply", bytes));
    ASSERT_TRUE(scene) << scene.error().message();
    const Mesh& mesh = scene->meshes[0];
    EXPECT_EQ(mesh.positions[0], Vec3(0.1, 0.0, 0.0));
    EXPECT_EQ(mesh.positions[2], Vec3(1.0, 1.0, 0.0));
    EXPECT_EQ(mesh.normals[3], Vec3f(0, 0, 1));
    EXPECT_EQ(mesh.uvs[1], Vec2f(0.25f, 0.25f));
    EXPECT_EQ(mesh.triangles.size(), 3u);
    EXPECT_TRUE(mesh.colors.empty()) << "red alone is no colour";
  }
}

// sRGB-encoded bytes, 16 bits or floats from 0 to 1; alpha as it is.
TEST(Ply, VertexColours) {
  const TemporaryFolder folder;
  const auto load = [&](const std::string& type, const std::string& full, const std::string& half) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    for (const char* name : {"red", "green", "blue", "alpha"}) text += "property " + type + " " + name + "\n";
    text += "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    for (const char* place : {"0 0 0 ", "1 0 0 ", "0 1 0 "})
      text += fmt::format("{}{} 0 {} {}\n", place, full, half, half);
    return load_scene(folder.put("c.ply", text + "3 0 1 2\n"));
  };
  for (const auto& scene :
       {load("uchar", "255", "51"), load("ushort", "65535", "13107"), load("float", "1", "0.2")}) {
    ASSERT_TRUE(scene) << scene.error().message();
    ASSERT_EQ(scene->meshes[0].colors.size(), 3u);
    const Vec4f c = scene->meshes[0].colors[2];
    EXPECT_EQ(Vec2f(c), Vec2f(1.0f, 0.0f));
    EXPECT_NEAR(c.b, 0.033105f, 1e-6f);  // ((0.2 + 0.055) / 1.055)^2.4
    EXPECT_NEAR(c.a, 0.2f, 1e-7f);
    EXPECT_EQ(scene->materials[0].diffuse, Vec3f(1.0f));
  }
}

struct PlyMistake {
  std::string bytes;
  std::string_view message;  // after the file's path
};

TEST(Ply, MistakesHaveTheirPlace) {
  const TemporaryFolder folder;
  const std::string body = "0 0 0 0 0 1 0 0 1\n1 0 0 0 0 1 0 0 1\n0 1 0 0 0 1 0 0 1\n";
  const std::string ascii3 = header("ascii", "3", "1") + body;
  const std::string binary = binary_quad(false);
  const PlyMistake mistakes[] = {
      {"", ":1:1: not a PLY file"},
      {"plx\n", ":1:1: not a PLY file"},
      {"ply\n", ":1:1: the header does not end"},
      {"ply\nend_header\n", ":2:1: the header has no format line"},
      {"ply\nformat ascii 2.0\n", ":2:1: format: unknown version (got \"2.0\", allowed 1.0)"},
      {"ply\nformat text 1.0\n", ":2:1: format: unknown (got \"text\", allowed ascii"},
      {"ply\nformat ascii 1.0\nelement vertex -1\n",
       ":3:1: vertex: element count (got \"-1\", allowed a whole number from 0)"},
      {"ply\nformat ascii 1.0\nproperty float x\n", ":3:1: a property before any element"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty vec3 x\n",
       ":4:1: unknown property type (got \"vec3\""},
      {"ply\nformat ascii 1.0\nelement face 1\nproperty list float int vertex_indices\n",
       ":4:1: type of a list's length (got \"float\""},
      {"ply\nformat ascii 1.0\nelemnt vertex 1\n", ":3:1: unknown header line (got \"elemnt\""},
      {header("ascii", "1000000000000", "1") + body,
       ":4:1: vertex: more elements than the file has data for (got 1000000000000, allowed at most 3)"},
      {header("binary_little_endian", "1000000000000", "1") + body, ":4:1: vertex: more elements"},
      {header("ascii", "99999999999999999999", "1"),
       ":4:1: vertex: element count (got \"99999999999999999999\""},
      {ascii3 + "0 -1 0 1 2\n", ":21:3: face[0].vertex_indices: list length (got -1, allowed 0 to"},
      {ascii3 + "0 3 0 1 3\n", ": face[0]: vertex index out of range (got 3, allowed 0 to 2)"},
      {ascii3 + "0 3 0 1 -2\n",
       ":21:9: face[0].vertex_indices: vertex index (got -2, allowed a whole number from 0)"},
      {ascii3 + "0 3 0 1 0.5\n", ":21:9: face[0].vertex_indices: vertex index (got 0.5"},
      {ascii3 + "0 3 0 x 1\n", ":21:7: face[0].vertex_indices: not a finite number (got x)"},
      {ascii3 + "0 3 0 1\n", ":22:1: face[0].vertex_indices: the data ends in the middle"},
      {ascii3 + "0 0\n", ": the file has no triangles"},
      {header("ascii", "3", "1") + "nan" + body.substr(1) + "0 3 0 1 2\n",
       ":18:1: vertex[0].x: not a finite number (got nan)"},
      {header("ascii", "3", "1") + "1e30" + body.substr(1) + "0 3 0 1 2\n",
       ":18:1: vertex[0].x: coordinate (got 1e+30"},
      {binary.substr(0, binary.size() - 1), ": face[1].vertex_indices: the data ends in the middle"},
      {binary.substr(0, header("binary_little_endian").size() + 10),
       ":4:1: vertex: more elements than the file has data for"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nelement face 0\nproperty list uchar int "
       "vertex_indices\nend_header\n1\n",
       ":3:1: vertex: vertices need the properties x, y and z"},
      {"ply\nformat ascii 1.0\nelement face 1\nproperty int a\nend_header\n1\n",
       ":3:1: face: faces need the list vertex_indices"},
  };
  for (const PlyMistake& m : mistakes) {
    const std::string path = folder.put("m.ply", m.bytes);
    const auto scene = load_scene(path);
    ASSERT_FALSE(scene) << m.message;
    EXPECT_EQ(scene.error().kind, ErrorKind::bad_input);
    const std::string expected = path + std::string(m.message);
    EXPECT_EQ(scene.error().message().substr(0, expected.size()), expected);
    EXPECT_EQ(scene.error().message().find('\n'), std::string::npos);
  }
}

std::string triangles_header(const std::string& format, std::size_t vertices, std::size_t faces,
                             const std::string& index = "int") {
  return fmt::format(
      "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty "
      "float z\nelement face {}\nproperty list uchar {} vertex_indices\nend_header\n",
      format, vertices, faces, index);
}

/// A fan around the first of many vertices.
std::string fan(bool binary, std::size_t triangles, const std::string& index = "int") {
  std::string out =
      triangles_header(binary ? "binary_little_endian" : "ascii", triangles + 2, triangles, index);
  for (std::size_t i = 0; i < triangles + 2; ++i) {
    const auto x = static_cast<float>(i) * 0.1f, y = x * x;
    if (binary)
      for (const float v : {x, y, 0.5f}) append_binary(out, v, false);
    else
      out += fmt::format("{} {} 0.5\n", static_cast<double>(x), static_cast<double>(y));
  }
  for (std::uint32_t i = 0; i < triangles; ++i) {
    if (!binary) {
      out += fmt::format("3 0 {} {}\n", i + 1, i + 2);
      continue;
    }
    out += '\3';
    for (const std::uint32_t corner : {0u, i + 1, i + 2}) append_binary(out, corner, false);
  }
  return out;
}

// Binary rows that are all alike are read many at a time.
TEST(Ply, RegularBinaryDataIsReadAsTextIs) {
  const TemporaryFolder folder;
  constexpr std::size_t triangles = 20000;
  const auto text = load_scene(folder.put("t.ply", fan(false, triangles)));
  ASSERT_TRUE(text) << text.error().message();
  ASSERT_EQ(text->meshes[0].triangles.size(), triangles);
  for (const std::string index : {"int", "uint"}) {
    const auto binary = load_scene(folder.put("b.ply", fan(true, triangles, index)));
    ASSERT_TRUE(binary) << binary.error().message();
    EXPECT_EQ(binary->meshes[0].positions, text->meshes[0].positions);
    EXPECT_EQ(binary->meshes[0].triangles, text->meshes[0].triangles);
    EXPECT_EQ(binary->notes, text->notes);
  }
}

TEST(Ply, RegularBinaryDataWithAFaultIsToldAsAnyOther) {
  const TemporaryFolder folder;
  const std::string good = fan(true, 3);
  const std::size_t vertices = good.find("end_header\n") + 11, faces = vertices + std::size_t{5} * 12;
  const auto with = [&](std::size_t at, std::string_view bytes) {
    return std::string(good).replace(at, bytes.size(), bytes);
  };
  using namespace std::string_view_literals;
  const PlyMistake mistakes[] = {
      {with(faces + 13 + 1, "\5\0\0\0"sv), ": face[1]: vertex index out of range (got 5, allowed 0 to 4)"},
      {with(faces + 13 + 1, "\xff\xff\xff\xff"sv), ": face[1].vertex_indices: vertex index (got -1, allowed"},
      {with(vertices + 12, "\0\0\xc0\x7f"sv), ": vertex[1].x: coordinate (got nan"},
      {with(vertices + 16, "\xff\xff\x7f\x7f"sv), ": vertex[1].y: coordinate (got 3.40282e+38"},
      {good.substr(0, good.size() - 1), ": face[2].vertex_indices: the data ends in the middle"},
  };
  for (const PlyMistake& m : mistakes) {
    const std::string path = folder.put("m.ply", m.bytes);
    const auto scene = load_scene(path);
    ASSERT_FALSE(scene) << m.message;
    const std::string expected = path + std::string(m.message);
    EXPECT_EQ(scene.error().message().substr(0, expected.size()), expected);
  }
  const auto longer = load_scene(folder.put("l.ply", good + "xy"));
  ASSERT_TRUE(longer);
  EXPECT_EQ(longer->notes[0], "2 byte(s) after the last element were not read.");
  // The second face takes the third's first bytes for its fourth corner; the third has no corners.
  const auto quad = load_scene(folder.put("q.ply", with(faces + 13, "\4"sv)));
  ASSERT_TRUE(quad) << quad.error().message();
  EXPECT_EQ(quad->meshes[0].triangles.size(), 3u);
  EXPECT_EQ(quad->notes[1], "1 face(s) with fewer than three corners were skipped.");
}

// Read with the wrong byte order, the list lengths or the coordinates cannot make sense.
TEST(Ply, WrongByteOrderIsNoticed) {
  const TemporaryFolder folder;
  std::string bytes = binary_quad(true);
  bytes.replace(bytes.find("big_endian"), 10, "little_endian");
  EXPECT_FALSE(load_scene(folder.put("m.ply", bytes)));
}

TEST(Ply, StripsOfTrianglesAreRead) {
  const TemporaryFolder folder;
  const std::string head =
      "ply\nformat ascii 1.0\ncomment TextureFile skin.png\nelement vertex 5\nproperty float x\nproperty "
      "float "
      "y\nproperty float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 2 0\n";
  const auto scene = load_scene(folder.put("m.ply", head + "10 0 1 2 3 3 4 -1 4 3 2\n"));
  ASSERT_TRUE(scene) << scene.error().message();
  // The third, {2, 3, 3}, and the fourth, {3, 3, 4}, have no area; every other one runs the other way round.
  EXPECT_EQ(scene->meshes[0].triangles,
            (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {2, 1, 3}, {4, 3, 2}}));
  EXPECT_TRUE(test::has_note(*scene, "The texture skin.png is not read; the model's plain colour is used."));
  const auto beyond = load_scene(folder.put("m.ply", head + "4 0 1 2 5\n"));
  ASSERT_FALSE(beyond);
  EXPECT_NE(beyond.error().message().find("vertex index out of range (got 5, allowed 0 to 4)"),
            std::string::npos);
  const auto negative = load_scene(folder.put("m.ply", head + "4 0 1 2 -2\n"));
  ASSERT_FALSE(negative);
  EXPECT_NE(negative.error().message().find("vertex index (got -2, allowed a whole number from 0)"),
            std::string::npos);
}

TEST(Ply, OtherElementsAreSkippedWithANote) {
  const TemporaryFolder folder;
  const auto scene = load_scene(folder.put("m.ply",
                                           "ply\nformat ascii 1.0\nelement edge 1\nproperty int a\nproperty "
                                           "list uchar float b\nelement vertex 3\nproperty float x\n"
                                           "property float y\nproperty float z\nelement face 1\nproperty "
                                           "list uchar uint vertex_index\nend_header\n"
                                           "7 2 0.5 0.5\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2"));
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->notes[0], "1 element(s) 'edge' were skipped.");
  EXPECT_EQ(make_world(*scene).triangle_count(), 1u);
}

}  // namespace
}  // namespace gnomon
