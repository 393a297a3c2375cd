// Real models of other people: what is well formed loads, and what is broken gives one line or loads with
// what is wrong noted. The table is the expectation; a file that is not in it must load.
#include <fmt/format.h>

#include <map>

#include "scene/files/encodings.h"
#include "scene/load.h"
#include "scene/world.h"
#include "tests/support/places.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

struct Outcome {
  bool loads;
  std::string_view text;  // of the error after the path, or a note that must be there
};

// Everything in folders named malformed_*, by its path below the data folder.
const std::map<std::string_view, Outcome> expected_outcomes{
    {"malformed_assimp/OBJ/box_UTF16BE.obj", {false, ":1:3: byte 0 in a text file"}},
    {"malformed_assimp/OBJ/box_longline.obj", {true, ""}},
    {"malformed_assimp/OBJ/concave_polygon.obj", {true, ""}},
    {"malformed_assimp/OBJ/number_formats.obj", {false, ":11:14: not a finite number (got 3.1+e2"}},
    {"malformed_assimp/OBJ/point_cloud.obj", {false, ": the file has no triangles"}},
    {"malformed_assimp/OFF/invalid.off",
     {false,
      ": unknown extension (got \".off\", allowed .json .gltf .glb .obj .ply .stl .fbx .dae .3ds .x3d "
      ".3mf)"}},
    {"malformed_assimp/glTF2/BoxBadNormals-glTF-Binary/BoxBadNormals.glb", {true, ""}},
    {"malformed_assimp/glTF2/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb",
     {false, ": meshes[0].primitives[0].attributes.POSITION[0]: position (got [-inf"}},
    {"malformed_assimp/glTF2/IncorrectVertexArrays/Cube.gltf",
     {false, ":129:7: bufferViews[2]: reaches past its buffer"}},
    {"malformed_assimp/glTF2/IndexOutOfRange/AllIndicesOutOfRange.gltf",
     {false, ": meshes[0].primitives[0].indices[0]: vertex index out of range (got 65535"}},
    {"malformed_assimp/glTF2/IndexOutOfRange/IndexOutOfRange.gltf",
     {false, ": meshes[0].primitives[0].indices[0]: vertex index out of range (got 255"}},
    {"malformed_assimp/glTF2/MissingBin/BoxTextured.gltf",
     {false, ": buffers[0].uri: no such file (got \"BoxTextured0.bin\")"}},
    {"malformed_assimp/glTF2/RecursiveNodes/RecursiveNodes.gltf",
     {false, ":14:9: nodes[0]: the node is its own ancestor"}},
    {"malformed_assimp/glTF2/SchemaFailures/sceneWrongType.gltf",
     {false, ":6:14: scene: wrong type (got \"hello\""}},
    {"malformed_assimp/glTF2/TestNoRootNode/NoScene.gltf",
     {false, ":5:14: scene: refers to a list that is empty or missing"}},
    {"malformed_assimp/glTF2/TestNoRootNode/SceneWithoutNodes.gltf", {false, ": the file has no triangles"}},
    {"malformed_assimp/glTF2/issue_3269/texcoord_crash.gltf", {true, ""}},
    {"malformed_assimp/glTF2/wrongTypes/badArray.gltf", {false, ":44:27: meshes[0].primitives: wrong type"}},
    {"malformed_assimp/glTF2/wrongTypes/badExtension.gltf", {true, ""}},
    {"malformed_assimp/glTF2/wrongTypes/badNumber.gltf",
     {false, ":131:21: materials[0].normalTexture: index is missing"}},
    {"malformed_assimp/glTF2/wrongTypes/badObject.gltf",
     {false, ":125:37: materials[0].pbrMetallicRoughness: wrong type"}},
    {"malformed_assimp/glTF2/wrongTypes/badString.gltf", {true, ""}},
    {"malformed_assimp/glTF2/wrongTypes/badUint.gltf",
     {false, ":128:30: materials[0].pbrMetallicRoughness.baseColorTexture.index: out of range (got -1"}},
    {"malformed_assimp/invalid/OutOfMemory.off", {false, ": unknown extension (got \".off\""}},
    {"malformed_assimp/invalid/crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply",
     {false, ":7:1: unknown property type"}},
    {"malformed_assimp/invalid/empty.obj", {false, ": the file has no triangles"}},
    {"malformed_assimp/invalid/empty.off", {false, ": unknown extension (got \".off\""}},
    {"malformed_assimp/invalid/empty.ply", {false, ":1:1: not a PLY file"}},
    {"malformed_assimp/invalid/malformed.obj",
     {false, ":23:5: f: vertex index out of range (got 12, allowed 1 to 8"}},
    {"malformed_assimp/invalid/malformed2.obj",
     {true, "1 face(s) with fewer than three corners were skipped (the first in line 23)"}},
    {"malformed_tinygltf/models/BoundsChecking/integer-out-of-bounds.gltf",
     {false, ":34:21: bufferViews[0].byteLength: out of range (got 1e300"}},
    {"malformed_tinygltf/models/BoundsChecking/invalid-buffer-index.gltf",
     {false, ":28:17: bufferViews[1].buffer: out of range (got 1"}},
    {"malformed_tinygltf/models/BoundsChecking/invalid-buffer-view-index.gltf",
     {false, ":17:17: bufferViews[0].buffer: refers to a list"}},
    {"malformed_tinygltf/models/BoundsChecking/invalid-primitive-indices.gltf",
     {false, ":17:17: bufferViews[0].buffer: refers to a list"}},
    {"malformed_tinygltf/models/regression/unassigned-skeleton.gltf", {true, "Animations are not played"}},
    {"malformed_tinygltf/models/regression/zero-sized-bin-chunk-issue-440.glb", {true, ""}},
    {"malformed_tinygltf/tests/issue-416.gltf", {false, ":1:54: asset.version: unknown version (got \"\""}},
    {"malformed_tinygltf/tests/issue-492.glb", {false, ": the file has no triangles"}},
    {"malformed_tinyobj/catmark_torus_creases0.obj",
     {true, "Faces name normals, of which the file has none"}},
    {"malformed_tinyobj/cornell_box.obj", {true, ""}},
    {"malformed_tinyobj/invalid-face-definition.obj", {false, ": the file has no triangles"}},
    {"malformed_tinyobj/invalid-relative-texture-index.obj",
     {false, ":2:3: f: vertex index out of range (got 1, allowed none"}},
    {"malformed_tinyobj/invalid-relative-vertex-index.obj",
     {false, ":1:3: f: vertex index out of range (got -4, allowed none"}},
    {"malformed_tinyobj/issue-138.obj", {true, ""}},
    {"malformed_tinyobj/issue-140-zero-face-idx.obj", {false, ":16:3: f: vertex index out of range (got 0"}},
    {"malformed_tinyobj/issue-161-inconsistent-f.obj", {true, "cube.mtl cannot be used (no such file)"}},
    {"malformed_tinyobj/issue-162-smoothing-group.obj", {true, ""}},
    {"malformed_tinyobj/issue-235-usemtl-then-o.obj", {true, ""}},
    {"malformed_tinyobj/issue-244-mtl-searchpaths.obj",
     {true, "issue-244.mtl cannot be used (no such file)"}},
    {"malformed_tinyobj/issue-246-usemtl-whitespace.obj", {true, ""}},
    {"malformed_tinyobj/issue-248-texres-texopt.obj", {true, "input.jpg is not there"}},
    {"malformed_tinyobj/issue-295-trianguation-failure.obj", {true, ""}},
    {"malformed_tinyobj/issue-319-002.obj", {true, ""}},
    {"malformed_tinyobj/issue-319-003.obj", {true, ""}},
    {"malformed_tinyobj/issue-330.obj", {true, ""}},
    {"malformed_tinyobj/issue-356-leading-spaces-newmtl.obj", {false, ": the file has no triangles"}},
    {"malformed_tinyobj/issue-92.obj", {true, "tmp.png is not there"}},
    {"malformed_tinyobj/issue-95-2.obj", {true, ""}},
    {"malformed_tinyobj/issue-95.obj", {true, ""}},
    {"malformed_tinyobj/leading-decimal-dot-issue-201.obj", {true, ""}},
    {"malformed_tinyobj/leading-zero-in-exponent-notation-issue-210.obj", {true, ""}},
    {"malformed_tinyobj/line-prim.obj", {false, ": the file has no triangles"}},
    {"malformed_tinyobj/missing_material_file.obj",
     {true, "The material 'white' is named, and no material library was read"}},
    {"malformed_tinyobj/no_material.obj", {true, ""}},
    {"malformed_tinyobj/points-prim.obj", {false, ": the file has no triangles"}},
    {"malformed_tinyobj/test-nan.obj", {false, ":12:3: not a finite number (got nan"}},
};

// How many triangles some of the models have, as counted by others.
const std::map<std::string_view, std::uint32_t> known_triangles{
    {"common_organic/stanford-bunny.obj", 69451},
    {"libigl_armadillo/armadillo.obj", 86482},
    {"stanford_dragon/dragon_vrip_res2.ply", 202520},
    {"stanford_dragon/dragon_vrip_res3.ply", 47794},
    {"stanford_dragon/dragon_vrip_res4.ply", 11102},
    {"cornell_obj/cornell_box.obj", 36},
    {"nvpro_cornellbox/cornellBox.gltf", 16732},
    {"3dc_mixer/glTF-Binary/Mixer.glb", 46963},
    {"3dc_tennisracquet/glTF/TennisRacquet.gltf", 17164},
    {"playcanvas_house/house.glb", 10497},
    {"glass_table/glass-table.glb", 592},
    {"attenuation_test/AttenuationTest.glb", 292},
    {"transmission_roughness_test/TransmissionRoughnessTest.glb", 77792},
    {"sunglasses_khronos/SunglassesKhronos.glb", 13396},
};

std::vector<std::string> model_paths() {
  std::vector<std::string> paths;
  const std::filesystem::path root = gnomon::test::shared_data();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    const std::string extension = entry.path().extension().string();
    for (const std::string_view known : {".gltf", ".glb", ".obj", ".ply", ".off"})
      if (extension == known) paths.push_back(entry.path().lexically_relative(root).string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

void check_loaded(const std::string& path, const Scene& scene) {
  const World world = make_world(scene);
  EXPECT_GT(world.primitive_count(), 0u) << path;
  EXPECT_FALSE(scene.lights.empty()) << path;
  EXPECT_EQ(scene.sha256.size(), 64u) << path;
  for (const std::string& note : scene.notes)
    EXPECT_EQ(note.find('\n'), std::string::npos) << path << ": " << note;
  fmt::print("{}: {} triangles, {} shapes, {} lights, {} textures\n", path, world.triangle_count(),
             scene.shapes.size(), scene.lights.size(), scene.textures.size());
  for (const std::string& note : scene.notes)
    if (!note.starts_with("Made, ")) fmt::print("    {}\n", note);
  if (const auto known = known_triangles.find(path); known != known_triangles.end()) {
    EXPECT_EQ(world.triangle_count(), known->second) << path;
  }
}

void check_outcome(const std::string& path, const Outcome& outcome) {
  const std::string file = gnomon::test::shared_data() + "/" + path;
  const auto scene = load_scene(file);
  if (scene) {
    EXPECT_TRUE(outcome.loads) << path << " loaded";
    const auto has_text = [&](const std::string& note) {
      return note.find(outcome.text) != std::string::npos;
    };
    EXPECT_TRUE(!outcome.loads || outcome.text.empty() ||
                std::any_of(scene->notes.begin(), scene->notes.end(), has_text))
        << path;
    return check_loaded(path, *scene);
  }
  const std::string message = scene.error().message();
  fmt::print("{}\n", message.substr(gnomon::test::shared_data().size() + 1));
  EXPECT_FALSE(outcome.loads) << message;
  EXPECT_EQ(scene.error().kind, ErrorKind::bad_input) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  const std::string expected = file + std::string(outcome.text);
  EXPECT_EQ(message.substr(0, expected.size()), expected);
}

TEST(ModelFiles, EveryOneLoadsOrSaysWhyNot) {
  if (!std::filesystem::is_directory(gnomon::test::shared_data()))
    GTEST_SKIP() << "the models are not here: " << gnomon::test::shared_data();
  std::size_t broken = 0;
  for (const std::string& path : model_paths()) {
    const auto found = expected_outcomes.find(path);
    const bool malformed = path.starts_with("malformed_");
    EXPECT_EQ(malformed, found != expected_outcomes.end()) << path << " is not in the table";
    broken += malformed;
    check_outcome(path, found != expected_outcomes.end() ? found->second : Outcome{true, ""});
  }
  EXPECT_EQ(broken, expected_outcomes.size());
}

TEST(ModelFiles, TheDigestIsTheFiles) {
  const std::string path = gnomon::test::shared_data() + "/cornell_obj/cornell_box.obj";
  if (!std::filesystem::exists(path))
    GTEST_SKIP() << "the models are not here: " << gnomon::test::shared_data();
  const auto scene = load_scene(path);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->sha256, sha256_hex(test::bytes_of(path)));
}

}  // namespace
}  // namespace gnomon
