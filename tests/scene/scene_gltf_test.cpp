// glTF and GLB: accessors of every kind, nodes, lights and cameras.
#include "scene/files/pictures/image_io.h"
#include "scene/world.h"
#include "tests/support/gltf_support.h"

namespace gnomon::gltf_test {
namespace {

TEST_F(Gltf, PrimitiveModes) {
  EXPECT_EQ(loaded(simple(4)).meshes[0].triangles,
            (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {2, 1, 3}}));
  EXPECT_EQ(loaded(simple(5, false)).meshes[0].triangles,
            (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_EQ(loaded(simple(6, false)).meshes[0].triangles,
            (std::vector<std::array<std::uint32_t, 3>>{{1, 2, 0}, {2, 3, 0}}));
  const Scene points = loaded(simple(0));
  EXPECT_TRUE(points.instances.empty());
  EXPECT_TRUE(has_note(points, "1 primitive(s) of points or lines were skipped"));
}

TEST_F(Gltf, BinaryAndTextAgree) {
  const auto binary = load(simple().glb(), "m.glb");
  ASSERT_TRUE(binary) << binary.error().message();
  EXPECT_EQ(binary->meshes[0].positions, loaded(simple()).meshes[0].positions);
}

// JSON does not tell 3.0 from 3.
TEST_F(Gltf, WholeNumbersMayHaveAPoint) {
  Builder b = simple();
  b.json["nodes"][0] = {{"mesh", 0.0}, {"scale", {1.0, 2.5, 1.0}}};
  b.json["scenes"][0]["nodes"] = {0.0};
  b.json["accessors"][0]["count"] = 4.0;
  b.json["accessors"][0]["componentType"] = 5126.0;
  const Scene scene = loaded(b);
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.meshes[0].triangles.size(), 2u);
  EXPECT_EQ(scene.instances[0].world_from_object[1][1], 2.5);
}

// Of data that an extension brings, or that nothing reads.
TEST_F(Gltf, BuffersWithoutUriAreNoErrorWhereNothingReadsThem) {
  Builder b = simple();
  b.text();
  b.json["buffers"].push_back({{"byteLength", 64}});
  EXPECT_TRUE(load(b.json.dump()));
  b.json["bufferViews"][0]["buffer"] = 1;
  EXPECT_EQ(error(b.json.dump()), "bufferViews[0]: its buffer has no data");
}

TEST_F(Gltf, ExternalBufferWithEscapedName) {
  Builder b = simple();
  folder_.put("my data.bin", b.buffer);
  b.text();
  b.json["buffers"][0]["uri"] = "my%20data.bin";
  const auto scene = load(b.json.dump());
  EXPECT_TRUE(scene) << scene.error().message();
  b.json["buffers"][0]["uri"] = "none.bin";
  EXPECT_NE(error(b.json.dump()).find("none.bin"), std::string::npos);
}

TEST_F(Gltf, InterleavedNormalizedAndSparse) {
  Builder b = simple();
  // Interleaved: position, two shorts of texture coordinates, stride 16.
  std::vector<float> mixed;
  for (std::size_t i = 0; i < 4; ++i) {
    mixed.insert(mixed.end(), {four[3 * i], four[3 * i + 1], four[3 * i + 2]});
    const std::uint16_t uv[2] = {static_cast<std::uint16_t>(13107 * i), 65535};
    float raw;
    std::memcpy(&raw, uv, 4);
    mixed.push_back(raw);
  }
  const int view = b.view(mixed);
  b.json["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 16;
  b.json["accessors"].push_back(
      {{"bufferView", view}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
  b.json["accessors"].push_back({{"bufferView", view},
                                 {"byteOffset", 12},
                                 {"componentType", 5123},
                                 {"count", 4},
                                 {"type", "VEC2"},
                                 {"normalized", true}});
  const int indices = b.view(std::vector<std::uint8_t>{1, 3});
  const int values = b.view(std::vector<float>{7, 8, 9, 10, 11, 12});
  b.json["accessors"][2]["sparse"] = {{"count", 2},
                                      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                      {"values", {{"bufferView", values}}}};
  b.json["meshes"][0]["primitives"][0]["attributes"] = {{"POSITION", 2}, {"TEXCOORD_0", 3}};
  const Scene scene = loaded(b);
  const Mesh& mesh = scene.meshes[0];
  EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {7, 8, 9}, {0, 1, 0}, {10, 11, 12}}));
  EXPECT_NEAR(mesh.uvs[3].x, 0.6f, 1e-6f);
  EXPECT_EQ(mesh.uvs[3].y, 1.0f);
}

TEST_F(Gltf, NodesPlaceTheirMeshes) {
  Builder b = simple();
  b.json["nodes"] =
      Json::array({{{"translation", {1, 2, 3}},
                    {"rotation", {0, 0, 0.7071067811865476, 0.7071067811865476}},
                    {"scale", {2, 2, 2}},
                    {"children", {1, 2}}},
                   {{"mesh", 0}, {"name", "child"}},
                   {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}}}});
  const Scene scene = loaded(b);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].name, "child");
  EXPECT_EQ(scene.meshes.size(), 1u);
  const Vec3 p = Vec3(scene.instances[0].world_from_object * Vec4(1, 0, 0, 1));
  EXPECT_NEAR(glm::length(p - Vec3(1, 4, 3)), 0.0, 1e-12);
  const Vec3 q = Vec3(scene.instances[1].world_from_object * Vec4(0, 0, 0, 1));
  EXPECT_NEAR(glm::length(q - Vec3(1, 12, 3)), 0.0, 1e-12);
}

// A closed box of which a scale of 0 leaves the top and the bottom, at one height; and one of which it leaves a line.
TEST_F(Gltf, AScaleOfZeroLeavesASheet) {
  Builder b;
  const int positions = b.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1});
  const int indices =
      b.accessor(std::vector<std::uint16_t>{0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                            2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5},
                 5123, "SCALAR", 1);
  b.json["meshes"] = Json::array(
      {{{"primitives", Json::array({{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}})}}});
  b.json["nodes"] =
      Json::array({{{"mesh", 0}, {"name", "sheet"}, {"scale", {2, 0, 3}}, {"translation", {0, 5, 0}}},
                   {{"mesh", 0}, {"scale", {2, 0, 0}}},
                   {{"mesh", 0}, {"scale", {0, 0, 0}}},
                   {{"mesh", 0}, {"name", "box"}}});
  const Scene scene = loaded(b);
  EXPECT_TRUE(
      has_note(scene, "2 node(s) that leave a line or a point of their mesh (scales of 0) were skipped."));
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].name, "sheet");
  const Mesh& sheet = scene.meshes[scene.instances[0].mesh];
  EXPECT_EQ(sheet.triangles.size(), 4u);
  EXPECT_TRUE(sheet.triangle_materials.empty());  // of one material
  for (const auto& triangle : sheet.triangles)
    for (const std::uint32_t v : triangle) EXPECT_EQ(sheet.positions[v].y, 5.0);
  EXPECT_EQ(sheet.positions[7], Vec3(2, 5, 3));
  EXPECT_EQ(scene.instances[0].world_from_object, Mat4(1.0));
  EXPECT_EQ(scene.meshes[scene.instances[1].mesh].triangles.size(), 12u);
}

TEST_F(Gltf, ALongChainOfNodesIsNoProblem) {
  Builder b = simple();
  Json nodes = Json::array();
  for (int i = 0; i < 20000; ++i) nodes.push_back({{"children", {i + 1}}, {"translation", {0.001, 0, 0}}});
  nodes.push_back({{"mesh", 0}});
  b.json["nodes"] = nodes;
  const Scene scene = loaded(b);
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_NEAR(scene.instances[0].world_from_object[3].x, 20.0, 1e-9);
}

// 50,000 layers at one place would be met by every ray and drawn into every texel; one of them is all that can be seen.
TEST_F(Gltf, NodesThatRepeatAnotherAreLeftOutAndSaid) {
  Builder b = simple();
  Json nodes = Json::array({{{"children", Json::array()}}});
  for (int i = 0; i < 50000; ++i) nodes.push_back({{"mesh", 0}, {"name", "copy" + std::to_string(i)}});
  nodes.push_back({{"mesh", 0}, {"name", "elsewhere"}, {"translation", {0, 1e-12, 0}}});
  for (int i = 1; i <= 50001; ++i) nodes[0]["children"].push_back(i);
  b.json["nodes"] = nodes;
  const Scene scene = loaded(b);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].name, "copy0");
  EXPECT_EQ(scene.instances[1].name, "elsewhere");
  EXPECT_EQ(
      std::ranges::count(
          scene.notes, "49999 of 50001 nodes repeat another exactly and are left out (the first is copy1)."),
      1);
}

TEST_F(Gltf, GlassThatIsRepeatedStays) {
  Builder b = simple();
  b.json["materials"] =
      Json::array({{{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}}}}}});
  b.json["extensionsUsed"] = {"KHR_materials_transmission"};
  b.json["meshes"][0]["primitives"][0]["material"] = 0;
  b.json["nodes"] = Json::array({{{"children", {1, 2}}}, {{"mesh", 0}}, {{"mesh", 0}}});
  EXPECT_EQ(loaded(b).instances.size(), 2u);
}

TEST_F(Gltf, LightsAndCameras) {
  Builder b = simple();
  b.json["extensionsUsed"] = {"KHR_lights_punctual"};
  b.json["extensions"]["KHR_lights_punctual"]["lights"] =
      Json::array({{{"type", "spot"},
                    {"color", {1, 0.5, 0.25}},
                    {"intensity", 20},
                    {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}},
                   {{"type", "point"}, {"name", "bulb"}, {"range", 4}},
                   {{"type", "directional"}, {"intensity", 3}}});
  const auto light = [](int i) { return Json{{"KHR_lights_punctual", {{"light", i}}}}; };
  b.json["cameras"] =
      Json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 0.75}, {"znear", 0.1}}}}});
  b.json["nodes"] = Json::array({{{"mesh", 0}},
                                 {{"extensions", light(0)},
                                  {"translation", {0, 5, 0}},
                                  {"rotation", {-0.7071067811865476, 0, 0, 0.7071067811865476}}},
                                 {{"extensions", light(1)}, {"translation", {1, 2, 3}}},
                                 {{"extensions", light(2)}},
                                 {{"camera", 0}, {"translation", {0, 0, 9}}}});
  b.json["scenes"][0]["nodes"] = {0, 1, 2, 3, 4};
  const Scene s = loaded(b);
  ASSERT_EQ(s.lights.size(), 3u);
  EXPECT_EQ(s.lights[0].type, LightType::spot);
  EXPECT_EQ(s.lights[0].intensity, Vec3f(20, 10, 5));
  EXPECT_NEAR(glm::length(s.lights[0].direction - Vec3(0, -1, 0)), 0.0, 1e-12);
  EXPECT_EQ(s.lights[0].position, Vec3(0, 5, 0));
  EXPECT_NEAR(s.lights[0].outer_angle, 0.5, 1e-12);
  EXPECT_EQ(s.lights[1].name, "bulb");
  EXPECT_EQ(s.lights[1].intensity, Vec3f(1.0f));
  EXPECT_EQ(s.lights[2].direction, Vec3(0, 0, -1));
  EXPECT_TRUE(has_note(s, "The range of lights is not used"));
  EXPECT_EQ(s.camera.eye, Vec3(0, 0, 9));
  EXPECT_NEAR(glm::length(s.camera.target - Vec3(0, 0, 0)), 0.0, 1e-12);
  EXPECT_EQ(s.camera.vertical_fov, 0.75);
  EXPECT_TRUE(s.shapes.empty());  // a file with its own lights brings its own world
}

TEST_F(Gltf, ConesThatAreChangedAreSaid) {
  const auto notes_of = [this](double inner, double outer) {
    Builder b = simple();
    b.json["extensionsUsed"] = {"KHR_lights_punctual"};
    b.json["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::array({{{"type", "spot"}, {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}}});
    b.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    b.json["scenes"][0]["nodes"].push_back(b.json["nodes"].size() - 1);
    std::string all;
    for (const std::string& note : loaded(b).notes)
      if (note.find("spot light") != std::string::npos) all += note;
    return all;
  };
  EXPECT_EQ(notes_of(0.25, 0.5), "");
  for (const double outer : {0.0, 1e-4})
    EXPECT_EQ(notes_of(0.0, outer),
              "The cone of a spot light was widened to half-angles of 0.000 and 0.057 degrees.");
  EXPECT_EQ(notes_of(0.0, 1.5707963267948966),
            "The cone of a spot light was narrowed to half-angles of 0.000 and 89.943 degrees.");
  EXPECT_EQ(notes_of(0.5, 0.5),
            "The inner cone of a spot light was narrowed to a half-angle of 28.642 degrees, within 28.648.");
}

TEST_F(Gltf, CamerasAreChosenByNameOrNumber) {
  Builder b = simple();
  b.json["cameras"] = Json::array(
      {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}},
       {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 3}, {"zfar", 9}, {"znear", 0.1}}}},
       {{"type", "perspective"}, {"name", "wide"}, {"perspective", {{"yfov", 1.5}, {"znear", 0.1}}}}});
  const auto add = [&](const Json& node) {
    b.json["scenes"][0]["nodes"].push_back(b.json["nodes"].size());
    b.json["nodes"].push_back(node);
  };
  add({{"camera", 0}, {"name", "front"}, {"translation", {0, 0, 5}}});
  add({{"camera", 1}, {"name", "plan"}, {"translation", {0, 0, 6}}});
  add({{"camera", 2}, {"translation", {0, 0, 7}}});
  const auto through = [&](const std::string& camera) {
    loaded(b);  // writes the file
    return load_scene(path_, {.camera = camera});
  };
  const Scene first = *through("");
  EXPECT_EQ(first.camera.eye, Vec3(0, 0, 5));
  EXPECT_TRUE(has_note(first, "The camera front is used; --camera takes front, plan, wide, or 0 to 2."));
  EXPECT_EQ(through("wide")->camera.eye, Vec3(0, 0, 7));
  EXPECT_NEAR(through("2")->camera.vertical_fov, 1.5, 1e-9);
  EXPECT_EQ(first.camera.orthographic_height, 0.0);
  EXPECT_EQ(through("plan")->camera.orthographic_height, 6.0);
  EXPECT_EQ(through("plan")->camera.eye, Vec3(0, 0, 6));
  const auto unknown = through("wied");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().kind, ErrorKind::usage);
  EXPECT_EQ(
      unknown.error().reason,
      "--camera: the scene has no such camera (got wied, allowed front, plan, wide, or 0 to 2); did you mean "
      "\"wide\"?");
}

TEST_F(Gltf, Extensions) {
  Builder b = simple();
  b.json["extensionsUsed"] = {"ACME_sparkle"};
  EXPECT_TRUE(has_note(loaded(b), "The extension ACME_sparkle is not supported and was not used."));
  b.json["extensionsRequired"] = {"ACME_sparkle"};
  EXPECT_EQ(error(b.text()).substr(0, 89),
            "extensionsRequired[0]: the file needs an extension that is not supported (got \"ACME_spark");
}

}  // namespace
}  // namespace gnomon::gltf_test
