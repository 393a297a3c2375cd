// Formats that are read by way of glTF, by assimp in a process of its own; a skip where that program is not there.
#include <sys/stat.h>

#include <cstdlib>
#include <thread>

#include "scene/base/confine.h"
#include "scene/base/run_program.h"
#include "scene/load.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

constexpr const char* stl_square = R"(solid square
facet normal 0 1 0
outer loop
vertex 0 2 0
vertex 0 2 1
vertex 1 2 0
endloop
endfacet
facet normal 0 1 0
outer loop
vertex 1 2 0
vertex 0 2 1
vertex 1 2 1
endloop
endfacet
endsolid square
)";

constexpr const char* x3d_square = R"(<?xml version="1.0" encoding="UTF-8"?>
<X3D profile="Interchange" version="3.0"><Scene><Shape>
<IndexedFaceSet coordIndex="0 1 2 -1 1 3 2 -1"><Coordinate point="0 2 0  0 2 1  1 2 0  1 2 1"/></IndexedFaceSet>
</Shape></Scene></X3D>
)";

constexpr const char* collada_square = R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1" name="meter"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 2 0 0 2 1 1 2 0 1 2 1</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="2"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2 1 3 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";

bool has_assimp() {
  const auto code = run_program({"sh", "-c", "command -v assimp >/dev/null"});
  return code && *code == 0;
}

/// Returns the area of all instances, in the world.
double area_of(const Scene& scene) {
  double area = 0.0;
  for (const MeshInstance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (const auto& t : mesh.triangles) {
      const auto place = [&](int corner) {
        return Vec3(instance.world_from_object * Vec4(Vec3(mesh.positions[t[corner]]), 1.0));
      };
      area += 0.5 * glm::length(glm::cross(place(1) - place(0), place(2) - place(0)));
    }
  }
  return area;
}

TEST(Foreign, ModelsAreReadByWayOfGltf) {
  if (!has_assimp()) GTEST_SKIP() << "assimp is not there (Debian: assimp-utils)";
  const TemporaryFolder folder;
  for (const auto& [name, text] :
       {std::pair("-square.stl", stl_square), {"square.x3d", x3d_square}, {"square.dae", collada_square}}) {
    const auto scene = load_scene(folder.put(name, text), {});
    ASSERT_TRUE(scene) << name << ": " << scene.error().message();
    EXPECT_NEAR(area_of(*scene), 1.0, 1e-6) << name;
    EXPECT_EQ(std::ranges::count_if(
                  scene->notes,
                  [](const std::string& note) { return note.find("by way of glTF") != std::string::npos; }),
              1)
        << name;
    EXPECT_EQ(scene->name, std::filesystem::path(name).stem().string());
  }
}

TEST(Foreign, WhatCannotBeReadIsSaidInAssimpsWords) {
  if (!has_assimp()) GTEST_SKIP() << "assimp is not there (Debian: assimp-utils)";
  const TemporaryFolder folder;
  const auto scene = load_scene(folder.put("broken.fbx", "no model at all\n"), {});
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().kind, ErrorKind::bad_input);
  EXPECT_NE(scene.error().reason.find("assimp: "), std::string::npos) << scene.error().message();
  EXPECT_NE(scene.error().file.find("broken.fbx"), std::string::npos);
}

TEST(Foreign, WithoutAssimpTheMessageNamesItsPackage) {
  const TemporaryFolder folder;
  const std::string path = folder.put("square.stl", stl_square),
                    before = std::getenv("PATH") != nullptr ? std::getenv("PATH") : "";
  const TemporaryFolder programs;
  std::filesystem::create_symlink("/usr/bin/prlimit", programs.file("prlimit"));
  setenv("PATH", programs.path().c_str(), 1);
  const auto scene = load_scene(path, {});
  setenv("PATH", before.c_str(), 1);
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().reason.find("assimp-utils"), std::string::npos) << scene.error().message();
}

/// An X3D file with a square of its own.
std::string x3d_with(const std::string& element) {
  std::string text = x3d_square;
  return text.insert(text.find("<Shape>"), element);
}

// By its path, beside the file, above it, a pipe that nobody writes to, a device that never ends, an address.
TEST(Foreign, AFileThatShowsAnotherIsRefusedAndTheOtherNamed) {
  const TemporaryFolder folder;
  const std::string other = folder.put("secret/other.x3d", x3d_square);
  ASSERT_EQ(mkfifo(folder.file("pipe.x3d").c_str(), 0600), 0);
  for (const std::string& url :
       {other, std::string("secret/other.x3d"), std::string("../secret/other.x3d"), std::string("pipe.x3d"),
        std::string("/dev/zero"), std::string("/dev/stdin"), std::string("http://127.0.0.1:9/a.x3d")})
    for (const std::string& element :
         {"<Inline url=\"" + url + "\"/>", "<Inline DEF='a' load=\"true\"\n url='\"" + url + "\"'></Inline>",
          "<Transform><Inline\turl='" + url + "'/></Transform>",
          "<!-- " + std::string("<Inline url='") + url + "'/> -->"}) {
      const auto scene = load_scene(folder.put("a.x3d", x3d_with(element)), {});
      ASSERT_FALSE(scene) << element;
      EXPECT_EQ(scene.error().kind, ErrorKind::bad_input);
      EXPECT_NE(scene.error().reason.find(url), std::string::npos) << scene.error().message();
      EXPECT_NE(scene.error().reason.find("no file but itself is read"), std::string::npos);
    }
}

TEST(Foreign, TextThatCannotBeLookedThroughIsRefused) {
  const TemporaryFolder folder;
  std::string wide("\xff\xfe");
  for (const char c : x3d_with("<Inline url='other.x3d'/>")) wide.append({c, '\0'});
  const auto scene = load_scene(folder.put("wide.x3d", wide), {});
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().reason.find("UTF-8"), std::string::npos) << scene.error().message();
}

TEST(Foreign, ANameThatOnlyBeginsAlikeIsNone) {
  const TemporaryFolder folder;
  const auto scene = load_scene(folder.put("a.x3d", x3d_with("<InlineOfMine url='other.x3d'/>")), {});
  ASSERT_FALSE(scene);  // assimp does not know it either
  EXPECT_EQ(scene.error().reason.find("no file but itself"), std::string::npos) << scene.error().message();
}

// A reader that was taken over through the file: a program in assimp's place.
TEST(Foreign, WhateverReadsItSeesNothingElse) {
  bool can = false;
  std::thread([&] { can = give_up_rights({}); }).join();
  if (!can) GTEST_SKIP() << "this kernel has no Landlock";
  const TemporaryFolder folder, programs;
  const std::string secret = folder.put("secret.txt", "precious"),
                    path = folder.put("square.stl", stl_square),
                    before = std::getenv("PATH") != nullptr ? std::getenv("PATH") : "";
  const std::string program =
      programs.put("assimp", "#!/bin/sh\necho \"ERROR: read $(wc -c <\"$2\") bytes, $(cat " + secret +
                                 ") $(ls " + folder.path() + ")\"; exit 1\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  setenv("PATH", (programs.path() + ":" + before).c_str(), 1);
  const auto scene = load_scene(path, {});
  setenv("PATH", before.c_str(), 1);
  ASSERT_FALSE(scene);
  EXPECT_NE(
      scene.error().reason.find("read " + std::to_string(std::string_view(stl_square).size()) + " bytes"),
      std::string::npos)
      << scene.error().message();
  EXPECT_EQ(scene.error().reason.find("precious"), std::string::npos) << scene.error().message();
  EXPECT_EQ(scene.error().reason.find("square"), std::string::npos) << scene.error().message();
}

TEST(Foreign, OtherFormatsHaveAHint) {
  const TemporaryFolder folder;
  for (const auto& [name, hint] : {std::pair("a.blend", "Blender exports it"),
                                   {"b.ifc", "IfcConvert"},
                                   {"c.usdz", "Blender imports it"},
                                   {"d.b3dm", "3d-tiles-tools"}}) {
    const auto scene = load_scene(folder.put(name, "x"), {});
    ASSERT_FALSE(scene);
    EXPECT_NE(scene.error().reason.find(hint), std::string::npos) << scene.error().message();
  }
}

}  // namespace
}  // namespace gnomon
