// OBJ and MTL: geometry, materials, and every mistake with its line and column.
#include <fmt/format.h>

#include "scene/files/pictures/image_io.h"
#include "scene/files/polygon.h"
#include "scene/load.h"
#include "scene/world.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

constexpr std::string_view quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Expected<Scene> load_text(const TemporaryFolder& folder, std::string_view text) {
  return load_scene(folder.put("m.obj", text));
}

TEST(Obj, GeometryAndTurnedTextureCoordinates) {
  const TemporaryFolder folder;
  const auto scene = load_text(
      folder, std::string(quad) + "vt 0.25 0.125\nvn 0 0 2\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf -4 -3 -2\n");
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(scene->meshes.size(), 1u);
  const Mesh& mesh = scene->meshes[0];
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(mesh.uvs[0], Vec2f(0.25f, 0.875f));
  EXPECT_EQ(mesh.normals[0], Vec3f(0, 0, 2));
  EXPECT_EQ(mesh.positions.size(), 7u);  // a corner without vt and vn is another vertex
}

TEST(Obj, NumbersKeepTheirDigits) {
  const TemporaryFolder folder;
  const auto scene = load_text(folder, "v 148376.000000125 .5 -1.25e-3\nv +1 0 0\nv 0 1. 0\nf 1 2 3\n");
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->meshes[0].positions[0].x, 148376.000000125);
  EXPECT_EQ(scene->meshes[0].positions[0].y, 0.5);
  EXPECT_EQ(scene->meshes[0].positions[0].z, -1.25e-3);
}

TEST(Obj, ContinuedLinesAndComments) {
  const TemporaryFolder folder;
  const auto scene = load_text(folder, std::string(quad) + "# c\nf 1 2 \\\n 3 # end\nf 1 \\\r\n3 4\n");
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(make_world(*scene).triangle_count(), 2u);
}

struct ObjMistake {
  std::string text;
  std::string_view message;  // after the file's path
};

TEST(Obj, MistakesHaveTheirPlace) {
  const TemporaryFolder folder;
  const std::string q(quad);
  const ObjMistake mistakes[] = {
      {q + "f 0 1 2\n", ":5:3: f: vertex index out of range (got 0, allowed 1 to 4 or -4 to -1)"},
      {q + "f 1 2 5\n", ":5:7: f: vertex index out of range (got 5, allowed 1 to 4 or -4 to -1)"},
      {q + "f 1 \\\r\n2 \\\n 5\n", ":7:2: f: vertex index out of range (got 5, allowed 1 to 4 or -4 to -1)"},
      {q + "f -5 1 2\n", ":5:3: f: vertex index out of range (got -5, allowed 1 to 4 or -4 to -1)"},
      {q + "vt 0 0\nf 1/2 2/1 3/1\n",
       ":6:5: f: texture coordinate index out of range (got 2, allowed 1 to 1 or -1 to -1)"},
      {q + "vn 0 0 1\nf 1//3 2 3\n", ":6:6: f: normal index out of range (got 3, allowed 1 to 1"},
      {q + "f /1 2 3\n", ":5:3: f: not an index (got /1, allowed a whole number)"},
      {q + "f 1 2 x\n", ":5:7: f: not an index (got x, allowed a whole number)"},
      {q + "f 1/1/1/1 2 3\n", ":5:3: f: too many slashes (got 1/1/1/1, allowed v/vt/vn)"},
      {"v 1,5 0 0\n", ":1:3: not a finite number (got 1,5, allowed for example -1.5e2)"},
      {"v 0 nan 0\n", ":1:5: not a finite number (got nan, allowed for example -1.5e2)"},
      {"v +-1 0 0\n", ":1:3: not a finite number (got +-1"},
      {"v 0 0 inf\n", ":1:7: not a finite number (got inf"},
      {"v 0 0 1e400\n", ":1:7: not a finite number (got 1e400"},
      {"v 0 0 1e30\n", ":1:7: coordinate (got 1e30, allowed up to 1e+15 in magnitude)"},
      {"v 0 0\n", ":1:1: too few coordinates (got 2, allowed 3 or more)"},
      {std::string("v 0 0 0\nv\0", 10), ":2:2: byte 0 in a text file (allowed: UTF-8 text)"},
      {q, ": the file has no triangles"},
      {"", ": the file has no triangles"},
      {q + "l 1 2\np 1\n", ": the file has no triangles"},
  };
  for (const ObjMistake& m : mistakes) {
    const std::string path = folder.put("m.obj", m.text);
    const auto scene = load_scene(path);
    ASSERT_FALSE(scene) << m.message;
    EXPECT_EQ(scene.error().kind, ErrorKind::bad_input);
    const std::string expected = path + std::string(m.message);
    EXPECT_EQ(scene.error().message().substr(0, expected.size()), expected);
  }
}

TEST(Obj, LongLines) {
  const TemporaryFolder folder;
  const auto comment =
      load_text(folder, "#" + std::string(1000000, 'x') + "\n" + std::string(quad) + "f 1 2 3\n");
  EXPECT_TRUE(comment) << comment.error().message();
  std::string face = std::string(quad) + "f";
  for (int i = 0; i < 250000; ++i) face += " 1 2";
  const auto refused = load_text(folder, face + "\n");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, "too many corners (got 500000, allowed 3 to 4096)");
  EXPECT_EQ(refused.error().line, 5);
}

// As some programs write faces: with slashes and nothing behind them, or with indices of what the file does not have.
TEST(Obj, FacesWithHalfIndicesAreRead) {
  const TemporaryFolder folder;
  for (const char* face : {"f 1/ 2/ 3/\n", "f 1// 2// 3//\n", "vt 0 0\nf 1/1/ 2/1/ 3/1/\n"}) {
    const auto scene = load_text(folder, std::string(quad) + face);
    ASSERT_TRUE(scene) << face << scene.error().message();
    EXPECT_EQ(make_world(*scene).triangle_count(), 1u);
  }
  const auto scene = load_text(folder, std::string(quad) + "f 1/1/1 2/2/2 3/3/3\n");
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_TRUE(test::has_note(*scene, "Faces name normals, of which the file has none"));
  EXPECT_TRUE(test::has_note(*scene, "Faces name texture coordinates, of which the file has none"));
}

TEST(Obj, PolygonsMayHaveManyCorners) {
  const TemporaryFolder folder;
  std::string disc, face = "f";
  constexpr int corners = 600;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * pi * i / corners;
    disc += "v " + std::to_string(std::cos(angle)) + " 0 " + std::to_string(-std::sin(angle)) + "\n";
    face += " " + std::to_string(i + 1);
  }
  const auto scene = load_text(folder, disc + face + "\n");
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(make_world(*scene).triangle_count(), corners - 2u);
}

TEST(Obj, FullTransparencyIsReadAsOpaque) {
  const TemporaryFolder folder;
  folder.put("m.mtl", "newmtl meshlab\nKd 1 0 0\nTr 1.000000\nnewmtl half\nTr 0.5\nnewmtl none\nd 0\n");
  const auto scene =
      load_text(folder, "mtllib m.mtl\n" + std::string(quad) +
                            "usemtl meshlab\nf 1 2 3\nusemtl half\nf 1 2 4\nusemtl none\nf 1 3 4\n");
  ASSERT_TRUE(scene) << scene.error().message();
  std::map<std::string, float> transmission;
  for (const Material& m : scene->materials) transmission[m.name] = m.transmission;
  EXPECT_EQ(transmission["meshlab"], 0.0f);
  EXPECT_EQ(transmission["half"], 0.5f);
  EXPECT_EQ(transmission["none"], 1.0f);
  EXPECT_TRUE(test::has_note(*scene, "Material 'meshlab': Tr 1 is read as opaque"));
}

TEST(Obj, AMaterialThatIsNowhereIsSoughtInNamedFiles) {
  const TemporaryFolder folder;
  folder.put("a.mtl", "newmtl red\nKd 1 0 0\n");
  const auto scene =
      load_text(folder, "mtllib a.mtl\n" + std::string(quad) + "usemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\n");
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_TRUE(test::has_note(*scene, "The material 'blue' is not in a.mtl; its faces are neutral grey."));
  const auto alone = load_text(folder, std::string(quad) + "usemtl blue\nf 1 2 3\n");
  EXPECT_TRUE(test::has_note(*alone, "The material 'blue' is named, and no material library was read"));
}

TEST(Obj, WhatIsSkippedIsNoted) {
  const TemporaryFolder folder;
  const auto scene = load_text(
      folder, "mtllib none.mtl\n" + std::string(quad) + "v 0 0 0 1 0 0\nf 1 2\nf 1 2 3\nl 1 2\np 1\n");
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_TRUE(test::has_note(*scene, "none.mtl cannot be used (no such file)"));
  EXPECT_TRUE(
      test::has_note(*scene, "1 face(s) with fewer than three corners were skipped (the first in line 7)"));
  EXPECT_TRUE(test::has_note(*scene, "1 point(s) and 1 line(s) were skipped"));
}

// As three.js and Blender write them: behind the position, sRGB-encoded; a vertex without is white.
TEST(Obj, VertexColours) {
  const TemporaryFolder folder;
  const auto scene =
      load_text(folder, "v 0 0 0 1 0.5 0\nv 1 0 0\nv 0 1 0 2 0 -1\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
  ASSERT_TRUE(scene) << scene.error().message();
  const Mesh& mesh = scene->meshes[0];
  ASSERT_EQ(mesh.colors.size(), 4u);
  EXPECT_NEAR(mesh.colors[0].g, 0.21404f, 1e-5f);  // IEC 61966-2-1
  EXPECT_EQ(mesh.colors[1], Vec4f(1.0f));
  EXPECT_EQ(mesh.colors[2], Vec4f(1.0f, 0.0f, 0.0f, 1.0f)) << "kept within [0, 1]";
  EXPECT_EQ(mesh.colors[3], Vec4f(1.0f));
  EXPECT_EQ(scene->materials[0].diffuse, Vec3f(1.0f)) << "white: the colours are what is seen";
  const auto plain = load_text(folder, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  ASSERT_TRUE(plain);
  EXPECT_TRUE(plain->meshes[0].colors.empty());
}

TEST(Obj, MaterialsAreMapped) {
  const TemporaryFolder folder;
  Rgb8Image image({2, 2});
  ASSERT_TRUE(write_png(folder.file("t.png"), image));
  folder.put("m.mtl", R"(newmtl plain
Kd 0.1 0.2 0.3
Ks 0.4 0.5 0.6
Ns 50
Ke 1 2 3
newmtl glass
Kd 0 0 0
d 0.25
Ni 1.5
illum 7
Ks 0.3 0.3 0.3
newmtl mirror
Kd 0 0 0
Ks 0.9 0.9 0.9
illum 3
newmtl bare
newmtl textured
map_Kd -s 2 4 1 -o 0.5 0.25 0 -clamp on t.png
newmtl lost
map_Kd missing.png
)");
  std::string text = "mtllib m.mtl\n" + std::string(quad);
  for (const std::string name : {"plain", "glass", "mirror", "bare", "textured", "lost", "undefined"})
    text += "usemtl " + name + "\nf 1 2 3\n";
  const auto scene = load_text(folder, text);
  ASSERT_TRUE(scene) << scene.error().message();
  const World world = make_world(*scene);
  const auto material = [&](std::uint32_t t) -> const Material& {
    return scene->materials[world.material_of(t)];
  };
  EXPECT_EQ(material(0).diffuse, Vec3f(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(material(0).specular, Vec3f(0.4f, 0.5f, 0.6f));
  EXPECT_EQ(material(0).shininess, 50.0f);
  EXPECT_EQ(material(0).emission, Vec3f(1, 2, 3));
  EXPECT_EQ(material(1).transmission, 0.75f);
  EXPECT_EQ(material(1).ior, 1.5f);
  EXPECT_EQ(material(1).mirror, 0.25f);  // Ks is more, but transmission leaves no more
  EXPECT_NEAR(material(2).mirror, 0.9f, 1e-6f);
  EXPECT_EQ(material(3).diffuse, Vec3f(0.7f));
  EXPECT_EQ(material(4).diffuse_texture, 0u);
  EXPECT_FALSE(scene->textures[0].repeat_s);
  EXPECT_EQ(material(4).texture_transform.scale, Vec2(2, 4));
  EXPECT_EQ(material(4).texture_transform.offset, Vec2(0.5, -3.25));  // 1 - 4 - 0.25, for v turned over
  EXPECT_EQ(material(5).diffuse_texture, no_id);
  EXPECT_TRUE(test::has_note(*scene, "missing.png is not there"));
  EXPECT_EQ(material(6).name, "default");
}

// What is said of 21 materials is one note.
TEST(Obj, NotesOfManyMaterialsAreOne) {
  const TemporaryFolder folder;
  std::string library, text = "mtllib m.mtl\n" + std::string(quad);
  for (int i = 0; i < 21; ++i) {
    library += fmt::format("newmtl m{0}\nmap_Bump b{0}.png\nmap_Kd c{0}.png\nKd 2 0 0\n", i);
    text += fmt::format("usemtl m{}\nf 1 2 3\n", i);
  }
  folder.put("m.mtl", library);
  const auto scene = load_text(folder, text);
  ASSERT_TRUE(scene) << scene.error().message();
  const auto count = [&](std::string_view part) {
    return std::count_if(scene->notes.begin(), scene->notes.end(),
                         [&](const std::string& note) { return note.find(part) != note.npos; });
  };
  for (const char* part : {"are not used", "not there", "clipped"}) EXPECT_EQ(count(part), 1) << part;
  EXPECT_EQ(count("Maps that are not used: m0 (bump), m1 (bump), m2 (bump) and 18 more."), 1);
  EXPECT_EQ(count("Colours were clipped to [0, 1]: m0 (Kd), m1 (Kd), m2 (Kd) and 18 more."), 1);
  EXPECT_EQ(count("Textures are not there; plain colours are used: m0 ("), 1);
}

TEST(Obj, CorruptTextureIsAnError) {
  const TemporaryFolder folder;
  folder.put("m.mtl", "newmtl a\nmap_Kd bad.png\n");
  folder.put("bad.png", "\x89PNG\r\n\x1a\n");
  EXPECT_FALSE(load_text(folder, "mtllib m.mtl\nusemtl a\n" + std::string(quad) + "f 1 2 3\n"));
}

// What programs on Windows write: names with blanks, folders divided by backslashes, a mark at the file's start.
TEST(Obj, NamesWithBlanksAndBackslashes) {
  const TemporaryFolder folder;
  const std::string mark = "\xef\xbb\xbf",
                    red = "newmtl dark red\t\r\nKd 1 0 0\r\nnewmtl dark\r\nKd 0 1 0\r\n";
  for (const std::string file : {"my materials.mtl", "tex/my materials.mtl", "plain.mtl"})
    folder.put(file, mark + red);
  for (const std::string library : {"my materials.mtl", "my\\ materials.mtl", "tex\\my materials.mtl",
                                    ".\\plain.mtl", "none.mtl plain.mtl"}) {
    const auto colour = [&](const std::string& material) {
      const auto scene = load_text(
          folder, fmt::format("{}mtllib {}\r\n{}usemtl {}\r\nf 1 2 3\r\n", mark, library, quad, material));
      EXPECT_TRUE(scene) << scene.error().message();
      EXPECT_FALSE(test::has_note(*scene, "mtl")) << library;
      return scene->materials.at(scene->instances.at(0).material).diffuse;
    };
    EXPECT_EQ(colour("dark red "), Vec3f(1, 0, 0)) << library;
    EXPECT_EQ(colour("dark"), Vec3f(0, 1, 0)) << library;
    EXPECT_EQ(colour("dark # and more"), Vec3f(0, 1, 0)) << library;
  }
  folder.put("wide.mtl", std::string("n\0e\0w\0", 6));
  const auto wide = load_text(folder, "mtllib wide.mtl\n" + std::string(quad) + "f 1 2 3\n");
  ASSERT_TRUE(wide);
  EXPECT_TRUE(test::has_note(*wide, "wide.mtl cannot be used (it is not UTF-8 text)"));
}

TEST(Obj, ConfinedLibrary) {
  const TemporaryFolder folder;
  folder.put("m.mtl", "newmtl a\nKd 1 0 0\n");
  const std::string path = folder.put("in/m.obj", "mtllib ../m.mtl\n" + std::string(quad) + "f 1 2 3\n");
  EXPECT_TRUE(load_scene(path));
  LoadOptions confined;
  confined.confine_paths = true;
  const auto refused = load_scene(path, confined);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message().substr(0, path.size() + 10), path + ": mtllib: ");
}

double turned_area(const std::vector<Vec3>& p, const std::array<std::uint32_t, 3>& t) {
  return 0.5 * glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]).z;
}

// Signed areas add up to the polygon's whatever the cuts; none is negative only if no triangle reaches
// outside.
void expect_covered(const std::vector<Vec3>& polygon, double area) {
  double sum = 0.0;
  for (const auto& t : triangulate_polygon(polygon)) {
    EXPECT_GE(turned_area(polygon, t) * area, 0.0);
    sum += turned_area(polygon, t);
  }
  EXPECT_NEAR(sum, area, 1e-9);  // tens of roundings of areas of order 10
}

TEST(Polygon, ConcavePolygonsAreCovered) {
  expect_covered({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}}, 10.0);
  expect_covered({{4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}, {0, 0, 0}}, 10.0);
  expect_covered({{0, 0, 0}, {0, 4, 0}, {2, 1, 0}, {4, 4, 0}, {4, 0, 0}}, -10.0);
  std::vector<Vec3> star, comb{{20, 0, 0}, {20, -1, 0}, {0, -1, 0}};
  for (int i = 0; i < 20; ++i) {
    const double angle = i * pi / 10.0;
    star.emplace_back((i % 2 ? 1.0 : 3.0) * Vec3(std::cos(angle), std::sin(angle), 0.0));
    comb.emplace_back(i, i % 2 ? 5.0 : 0.0, 0.0);
  }
  expect_covered(star, 0.5 * 20 * 3.0 * std::sin(pi / 10.0));
  expect_covered(comb, -(20.0 + 9 * 5.0 + 5.0));
}

TEST(Polygon, DegenerateOnesStillGiveAllTriangles) {
  EXPECT_EQ(triangulate_polygon(std::vector<Vec3>(6, Vec3(1.0))).size(), 4u);
  const std::vector<Vec3> bow{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  EXPECT_EQ(triangulate_polygon(bow).size(), 3u);
}

}  // namespace
}  // namespace gnomon
