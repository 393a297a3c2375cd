// What a JSON scene means: every part read back as the scene model.
#include <glm/gtc/matrix_access.hpp>

#include "scene/files/encodings.h"
#include "scene/files/formats.h"
#include "scene/files/pictures/image_io.h"
#include "scene/world.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

constexpr std::string_view whole_scene = R"({
  // a comment
  "schema": "gnomon/scene/1", /* another */
  "name": "everything",
  "camera": { "eye": [0, 2, 9], "target": [0, 1, 0], "up": [0, 1, 0.5], "vertical_fov_degrees": 60 },
  "ambient": 0.1, "background": "#ff8000", "exposure": 2.5, "max_depth": 3,
  "lights": [
    { "name": "sun", "type": "directional", "elevation_degrees": 30, "azimuth_degrees": 90, "intensity": [1, 0.5, 0.25] },
    { "type": "point", "position": [1, 2, 3], "intensity": 40 },
    { "name": "spot", "type": "spot", "position": [0, 4, 0], "target": [0, 0, 0], "inner_angle_degrees": 10, "outer_angle_degrees": 30 }
  ],
  "materials": [
    { "name": "red", "diffuse": [0.8, 0.1, 0.1], "specular": 0.5, "shininess": 64, "emission": 0.25, "alpha": 0.75, "alpha_mode": "mask", "alpha_cutoff": 0.25, "double_sided": false },
    { "name": "glass", "transmission": 0.7, "mirror": 0.3, "ior": 1.33, "absorption": [0.1, 0.2, 0.3], "roughness": 0.125 }
  ],
  "meshes": [
    { "name": "quad", "vertices": [[0,0,0], [1,0,0], [1,1,0], [0,1,0]], "triangles": [[0,1,2], [0,2,3]],
      "normals": [[0,0,1],[0,0,1],[0,0,1],[0,0,1]], "uvs": [[0,1],[1,1],[1,0],[0,0]],
      "colors": ["#ff0000", [0, 0.5, 1], 0, 1] }
  ],
  "instances": [
    { "name": "moved", "mesh": "quad", "material": "red", "translate": [10, 0, 0], "rotate": { "axis": [0, 0, 2], "degrees": 90 }, "scale": [2, 3, 4] },
    { "mesh": "quad", "materials": { "quad": "glass" }, "matrix": [[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]] },
    { "mesh": "quad", "material": "red", "rotate": [{ "axis": [1, 0, 0], "degrees": 90 }, { "axis": [0, 1, 0], "degrees": 90 }] }
  ],
  "shapes": [
    { "name": "ball", "sphere": { "center": [1, 1, 1], "radius": 0.5 }, "material": "glass" },
    { "plane": { "point": [0, -1, 0], "normal": [0, 4, 0] }, "material": "red" }
  ]
})";

Scene load(std::string_view text, const std::string& folder = ".") {
  auto scene = load_json_scene(text, "s.json", folder, {});
  if (scene) return std::move(*scene);
  ADD_FAILURE() << scene.error().message();
  return {};
}

constexpr double tolerance = 1e-12;  // a few roundings of values of order 10

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(JsonScene, Settings) {
  const Scene s = load(whole_scene);
  EXPECT_EQ(s.name, "everything");
  EXPECT_EQ(s.path, "s.json");
  EXPECT_EQ(s.sha256, sha256_hex(whole_scene));
  EXPECT_EQ(s.camera.eye, Vec3(0, 2, 9));
  EXPECT_EQ(s.camera.up, Vec3(0, 1, 0.5));
  EXPECT_NEAR(s.camera.vertical_fov, pi / 3.0, tolerance);
  EXPECT_EQ(s.ambient, Vec3f(0.1f));
  EXPECT_NEAR(s.background.g, linear_from_srgb(128.0f / 255.0f), 1e-6f);
  EXPECT_EQ(s.exposure, 2.5);
  EXPECT_EQ(s.max_depth, 3);
  ASSERT_EQ(s.notes.size(), 2u);  // glass without an inside: the quad has four open edges; what glows
  EXPECT_NE(s.notes[0].find("not closed"), std::string::npos) << s.notes[0];
  EXPECT_NE(s.notes[1].find("Emission is seen and casts no shadows"), std::string::npos) << s.notes[1];
}

TEST(JsonScene, Lights) {
  const Scene s = load(whole_scene);
  ASSERT_EQ(s.lights.size(), 3u);
  expect_near(s.lights[0].direction, -Vec3(std::cos(pi / 6.0), 0.5, 0.0));
  EXPECT_EQ(s.lights[0].intensity, Vec3f(1.0f, 0.5f, 0.25f));
  EXPECT_EQ(s.lights[1].name, "point-2");
  EXPECT_EQ(s.lights[1].position, Vec3(1, 2, 3));
  expect_near(s.lights[2].direction, Vec3(0, -1, 0));
  EXPECT_NEAR(s.lights[2].inner_angle, pi / 18.0, tolerance);
  EXPECT_NEAR(s.lights[2].outer_angle, pi / 6.0, tolerance);
}

TEST(JsonScene, Materials) {
  const Scene s = load(whole_scene);
  ASSERT_EQ(s.materials.size(), 2u);
  const Material& red = s.materials[0];
  EXPECT_EQ(red.diffuse, Vec3f(0.8f, 0.1f, 0.1f));
  EXPECT_EQ(red.specular, Vec3f(0.5f));
  EXPECT_EQ(red.shininess, 64.0f);
  EXPECT_EQ(red.emission, Vec3f(0.25f));
  EXPECT_FALSE(red.double_sided || red.unlit);
  EXPECT_EQ(s.meshes[0].colors,
            (std::vector<Vec4f>{{1, 0, 0, 1}, {0, 0.5f, 1, 1}, {0, 0, 0, 1}, Vec4f(1.0f)}));
  EXPECT_EQ(red.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(red.alpha, 0.75f);
  EXPECT_EQ(red.alpha_cutoff, 0.25f);
  const Material& glass = s.materials[1];
  EXPECT_EQ(glass.diffuse, Vec3f(0.8f));
  EXPECT_EQ(glass.transmission, 0.7f);
  EXPECT_EQ(glass.mirror, 0.3f);
  EXPECT_EQ(glass.ior, 1.33f);
  EXPECT_EQ(glass.absorption, Vec3f(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(glass.roughness, 0.125f);
}

TEST(JsonScene, Transforms) {
  const Scene s = load(whole_scene);
  ASSERT_EQ(s.instances.size(), 3u);
  const auto moved = [&](std::size_t i, const Vec3& p) {
    return Vec3(s.instances[i].world_from_object * Vec4(p, 1.0));
  };
  EXPECT_EQ(s.instances[0].name, "moved");
  expect_near(moved(0, {1, 0, 0}), {10, 2, 0});  // scaled by 2, turned to +y, moved by 10
  expect_near(moved(0, {0, 1, 0}), {7, 0, 0});
  EXPECT_EQ(s.instances[1].name, "quad");
  EXPECT_EQ(s.instances[1].material, 1u);
  expect_near(moved(1, {1, 0, 0}), {5, 7, 7});
  expect_near(moved(2, {0, 1, 0}), {1, 0, 0});  // about x first: +y to +z; then about y: +z to +x
  EXPECT_EQ(make_world(s).triangle_count(), 6u);
}

TEST(JsonScene, RepeatedInstances) {
  const auto repeated = [](const std::string& more) {
    return load(R"({"schema": "gnomon/scene/1", "materials": [{"name": "m"}],
      "meshes": [{"name": "t", "vertices": [[0,0,0], [1,0,0], [0,1,0]], "triangles": [[0,1,2]]}],
      "instances": [{"mesh": "t", "material": "m", "translate": [0, 5, 0], "rotate": {"axis": [0, 1, 0], "degrees": 90},
        "repeat": {"count": [3, 2], "spacing": [2, 4])" +
                more + "}}]}");
  };
  const Scene plain = repeated("");
  ASSERT_EQ(plain.instances.size(), 6u);
  EXPECT_EQ(plain.instances[0].name, "t-1");
  EXPECT_EQ(plain.instances[5].name, "t-6");
  const auto place = [](const MeshInstance& i, const Vec3& p) {
    return Vec3(i.world_from_object * Vec4(p, 1.0));
  };
  expect_near(place(plain.instances[0], Vec3(0.0)), {-2, 5, -2});
  expect_near(place(plain.instances[5], Vec3(0.0)), {2, 5, 2});
  expect_near(place(plain.instances[4], {1, 0, 0}), {0, 5, 1});  // turned by the instance, then moved
  const Scene strewn = repeated(R"(, "jitter": 0.5, "turn": true, "scale": [2, 3], "seed": 5)");
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(strewn.instances[i].mesh, 0u);
    const Vec3 middle = place(plain.instances[i], Vec3(0.0)), at = place(strewn.instances[i], Vec3(0.0));
    EXPECT_LE(std::abs(at.x - middle.x), 0.5);
    EXPECT_LE(std::abs(at.z - middle.z), 1.0);
    EXPECT_NE(at.x, middle.x);
    const double size = glm::length(place(strewn.instances[i], {1, 0, 0}) - at);
    EXPECT_GE(size, 2.0);
    EXPECT_LE(size, 3.0);
  }
  EXPECT_EQ(place(repeated(R"(, "jitter": 0.5, "seed": 5)").instances[3], Vec3(0.0)),
            place(strewn.instances[3], Vec3(0.0)));  // the same seed, the same places
}

TEST(JsonScene, Shapes) {
  const Scene s = load(whole_scene);
  ASSERT_EQ(s.shapes.size(), 2u);
  EXPECT_EQ(std::get<Sphere>(s.shapes[0].geometry).radius, 0.5);
  EXPECT_EQ(s.shapes[0].material, 1u);
  EXPECT_EQ(s.shapes[1].name, "plane-2");
  EXPECT_EQ(std::get<Plane>(s.shapes[1].geometry).normal, Vec3(0, 1, 0));
}

TEST(JsonScene, MissingCameraAndLightAreMadeAndNoted) {
  const Scene s = load(R"({"schema": "gnomon/scene/1", "materials": [{"name": "m"}],
    "shapes": [{"sphere": {"center": [100, 0, 0], "radius": 2}, "material": "m"}]})");
  ASSERT_EQ(s.lights.size(), 1u);
  EXPECT_EQ(s.lights[0].type, LightType::directional);
  EXPECT_LT(s.lights[0].direction.y, 0.0);
  EXPECT_EQ(s.camera.target, Vec3(100, 0, 0));
  ASSERT_EQ(s.notes.size(), 1u);
  EXPECT_EQ(s.notes[0].find("Made, as the file has none: a camera at ["), 0u);
  EXPECT_NE(s.notes[0].find(", a directional light 'sun' along ["), std::string::npos);
  EXPECT_EQ(s.shapes.size(), 1u);  // a scene says itself whether it has a ground
}

TEST(JsonScene, UnusedMeshesAreNoted) {
  const Scene s = load(R"({"schema": "gnomon/scene/1", "materials": [{"name": "m"}],
    "lights": [{"type": "point", "position": [0,9,0]}], "camera": {"eye": [0,0,9], "target": [0,0,0]},
    "meshes": [{"name": "lost", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,2]]}],
    "shapes": [{"sphere": {"center": [0,0,0], "radius": 2}, "material": "m"}]})");
  ASSERT_EQ(s.notes.size(), 1u);
  EXPECT_EQ(s.notes[0], "The mesh 'lost' is not used by any instance.");
}

constexpr std::string_view two_part_obj =
    "mtllib m.mtl\no left\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl blue\nf 1 2 3\no right\nv 5 0 0\nf 2 4 3\n";

TEST(JsonScene, ModelFilesAreMeshesWithParts) {
  const TemporaryFolder folder;
  folder.put("models/two.obj", two_part_obj);
  folder.put("models/m.mtl", "newmtl blue\nKd 0 0 1\n");
  const std::string path = folder.put(
      "s.json", R"({"schema": "gnomon/scene/1", "materials": [{"name": "green", "diffuse": [0,1,0]}],
    "meshes": [{"name": "two", "file": "models/two.obj"}],
    "instances": [{"mesh": "two"}, {"name": "again", "mesh": "two", "materials": {"right": "green"}, "scale": 2}]})");
  const auto scene = load_scene(path);
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(scene->instances.size(), 4u);
  EXPECT_EQ(scene->instances[0].name, "two/left");
  EXPECT_EQ(scene->instances[3].name, "again/right");
  const World world = make_world(*scene);
  ASSERT_EQ(world.triangle_count(), 4u);
  const auto color = [&](std::uint32_t t) { return scene->materials[world.material_of(t)].diffuse; };
  EXPECT_EQ(color(0), Vec3f(0, 0, 1));
  EXPECT_EQ(color(1), Vec3f(0, 0, 1));
  EXPECT_EQ(color(2), Vec3f(0, 0, 1));
  EXPECT_EQ(color(3), Vec3f(0, 1, 0));
}

TEST(JsonScene, IncludesMerge) {
  const TemporaryFolder folder;
  folder.put("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.put("lib.json",
             R"({"schema": "gnomon/scene/1", "materials": [{"name": "a"}, {"name": "b", "diffuse": 0.25}],
    "camera": {"eye": [0,0,9], "target": [0,0,0]}, "lights": [{"name": "lamp", "type": "point", "position": [0,9,0]}],
    "shapes": [{"sphere": {"center": [0,0,0], "radius": 2}, "material": "b"}]})");
  const std::string path = folder.put(
      "s.json",
      R"({"schema": "gnomon/scene/1", "include": ["lib.json", "two.obj"], "materials": [{"name": "c"}],
    "shapes": [{"sphere": {"center": [5,0,0], "radius": 1}, "material": "b"}, {"sphere": {"center": [9,0,0], "radius": 1}, "material": "c"}]})");
  const auto scene = load_scene(path);
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->shapes.size(), 3u);
  EXPECT_EQ(scene->instances.size(), 1u);
  EXPECT_EQ(scene->lights.size(), 1u);
  EXPECT_EQ(scene->materials[scene->shapes[1].material].name, "b");
  EXPECT_EQ(scene->materials[scene->shapes[2].material].name, "c");
  EXPECT_EQ(scene->notes[0], "The camera of the included file " + folder.file("lib.json") + " is not used.");
}

// Both models call their material by the same name, which is their own affair, also where their scene is included; a mesh
// that the scene gives a name to can be placed under it, part by part.
TEST(JsonScene, AnIncludedSceneMayPlaceModels) {
  const TemporaryFolder folder;
  folder.put("m.mtl", "newmtl same\nKd 0 1 0\n");
  for (const char* name : {"one.obj", "two.obj"})
    folder.put(name, "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl same\nf 1 2 3\n");
  folder.put(
      "inner.json",
      R"({"schema": "gnomon/scene/1", "meshes": [{"name": "one", "file": "one.obj"}, {"name": "two", "file": "two.obj"}],
    "instances": [{"mesh": "one"}, {"mesh": "two"}]})");
  const std::string path = folder.put(
      "outer.json",
      R"({"schema": "gnomon/scene/1", "include": ["inner.json"], "instances": [{"mesh": "two", "translate": [3, 0, 0]}]})");
  const auto scene = load_scene(path);
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->instances.size(), 3u);
  EXPECT_EQ(scene->instances[2].mesh, scene->instances[1].mesh);
  const World world = make_world(*scene);
  EXPECT_EQ(scene->materials[world.material_of(2)].diffuse, Vec3f(0, 1, 0));
}

TEST(JsonScene, IncludedPictureSettingsAreToldOf) {
  const TemporaryFolder folder;
  folder.put("lib.json",
             R"({"schema": "gnomon/scene/1", "ambient": 0.5, "background": [0, 0, 1], "exposure": 2,
    "max_depth": 3, "glossy": {"samples": 4}, "indirect": {"samples": 4}, "materials": [{"name": "a"}],
    "shapes": [{"sphere": {"center": [0,0,0], "radius": 2}, "material": "a"}]})");
  const std::string path =
      folder.put("s.json", R"({"schema": "gnomon/scene/1", "ambient": 0.1, "include": ["lib.json"]})");
  const auto scene = load_scene(path);
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->ambient, Vec3f(0.1f));
  EXPECT_EQ(scene->max_depth, Scene{}.max_depth);
  const auto noted = [&](const std::string& note) {
    return std::find(scene->notes.begin(), scene->notes.end(), note) != scene->notes.end();
  };
  const std::string of_file = " of the included file " + folder.file("lib.json");
  for (const char* name : {"ambient light", "background", "exposure", "recursion limit"})
    EXPECT_TRUE(noted("The " + std::string(name) + of_file + " is not used.")) << name;
  for (const char* name : {"glossy samples", "indirect samples"})
    EXPECT_TRUE(noted("The " + std::string(name) + of_file + " are not used.")) << name;
}

TEST(JsonScene, TexturesOfFilesAndGenerators) {
  const TemporaryFolder folder;
  Rgb8Image image({2, 1});
  image.at(0, 0) = {255, 0, 0};
  ASSERT_TRUE(write_png(folder.file("t.png"), image));
  const std::string path =
      folder.put("s.json", R"({"schema": "gnomon/scene/1", "materials": [{"name": "m", "texture":
    {"file": "t.png", "filter": "nearest", "wrap": "clamp", "offset": [0.5, 0.25], "scale": 2, "rotation_degrees": 90, "srgb": false}},
    {"name": "g", "unlit": true, "emission_texture": {"generate": {"kind": "checker"}, "scale": 3}}],
    "shapes": [{"sphere": {"center": [0,0,0], "radius": 2}, "material": "m"}, {"sphere": {"center": [5,0,0], "radius": 2}, "material": "g"}]})");
  const auto scene = load_scene(path);
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(scene->textures.size(), 2u);
  const Texture& t = scene->textures[0];
  EXPECT_TRUE(t.nearest);
  EXPECT_FALSE(t.repeat_s || t.repeat_t || t.srgb);
  EXPECT_EQ(t.texels[0], glm::u8vec4(255, 0, 0, 255));
  const TextureTransform& transform = scene->materials[0].texture_transform;
  EXPECT_EQ(transform.offset, Vec2(0.5, 0.25));
  EXPECT_EQ(transform.scale, Vec2(2.0));
  EXPECT_NEAR(transform.rotation, 0.5 * pi, tolerance);
  EXPECT_EQ(scene->materials[1].emission_texture, 1u);
  EXPECT_EQ(scene->materials[1].emission_transform.scale, Vec2(3.0));
  EXPECT_TRUE(scene->materials[1].unlit);
}

TEST(JsonScene, EveryBuiltinSceneLoads) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const auto scene = load_scene(std::string(builtin.name));
    ASSERT_TRUE(scene) << scene.error().message();
    EXPECT_EQ(scene->name, builtin.name);
  }
}

TEST(JsonScene, EmissionThatLightsNothingIsSaid) {
  const auto notes = [](const std::string& more, const char* material) {
    const std::string text =
        R"({"schema": "gnomon/scene/1", "materials": [{"name": "lamp", "emission": [1, 2, 3]}, {"name": "grey"}],
      "shapes": [{"name": "ball", "sphere": {"center": [0, 0, 0], "radius": 1}, "material": ")" +
        std::string(material) + R"("}],
      "camera": {"eye": [0, 0, 9], "target": [0, 0, 0]},
      "lights": [{"type": "directional", "elevation_degrees": 40, "azimuth_degrees": 20}])" +
        more + "}";
    return load_json_scene(text, "test.json", "", {})->notes;
  };
  const std::vector<std::string> said{
      "Emission is seen and casts no shadows: nothing is lit by it (material lamp)."};
  EXPECT_EQ(notes("", "lamp"), said);
  EXPECT_TRUE(notes("", "grey").empty());
  EXPECT_NE(notes(R"(, "indirect": {"samples": 4})", "lamp").front().find("only the indirect light"),
            std::string::npos);
}

TEST(JsonScene, LightsWithoutIntensityAreSaid) {
  const auto scene = load_json_scene(
      R"({"schema": "gnomon/scene/1", "camera": {"eye": [0, 0, 9], "target": [0, 0, 0]},
      "materials": [{"name": "grey"}],
      "shapes": [{"name": "ball", "sphere": {"center": [0, 0, 0], "radius": 1}, "material": "grey"}], "lights": [
      {"name": "off", "type": "point", "position": [0, 4, 0], "intensity": [0, 0, 0]},
      {"name": "red", "type": "point", "position": [0, 4, 0], "intensity": [1, 0, 0]}]})",
      "test.json", "", {});
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(scene->notes.size(), 1u);
  EXPECT_EQ(scene->notes[0], "A light has no intensity: shadows are compared that no picture shows (off).");
}

TEST(JsonScene, NamedCameras) {
  const auto through = [](const std::string& cameras, const std::string& camera) {
    const std::string text =
        R"({"schema": "gnomon/scene/1", "materials": [{"name": "grey"}], "shapes": [{"name": "ball", "sphere": {"center": [0, 0, 0], "radius": 1}, "material": "grey"}],
      "lights": [{"type": "directional", "elevation_degrees": 40, "azimuth_degrees": 20}], )" +
        cameras + "}";
    return load_json_scene(text, "test.json", "", {.camera = camera});
  };
  const std::string two = R"("camera": {"eye": [0, 0, 9], "target": [0, 0, 0]},
    "cameras": [{"name": "side", "eye": [9, 0, 0], "target": [0, 0, 0], "vertical_fov_degrees": 90}])";
  EXPECT_EQ(through(two, "")->camera.eye, Vec3(0, 0, 9));
  EXPECT_EQ(through(two, "camera")->camera.eye, Vec3(0, 0, 9));
  EXPECT_EQ(through(two, "side")->camera.eye, Vec3(9, 0, 0));
  EXPECT_NEAR(through(two, "1")->camera.vertical_fov, pi / 2.0, 1e-12);
  EXPECT_EQ(through(two, "2").error().kind, ErrorKind::usage);
  EXPECT_EQ(through(R"("ambient": [0, 0, 0])", "side").error().reason,
            "--camera: the scene has no camera of its own (got side)");
  const std::string nameless = R"("cameras": [{"eye": [9, 0, 0], "target": [0, 0, 0]}])";
  EXPECT_EQ(through(nameless, "").error().field, "cameras[0]");
  const std::string twice = R"("cameras": [{"name": "a", "eye": [9, 0, 0], "target": [0, 0, 0]},
    {"name": "a", "eye": [8, 0, 0], "target": [0, 0, 0]}])";
  EXPECT_EQ(through(twice, "").error().reason, "another camera has this name (got \"a\")");
}

TEST(JsonScene, SettingsAreReadWhateverTheCaseOfTheExtension) {
  const TemporaryFolder folder;
  for (const char* name : {"scene.json", "SCENE.JSON"}) {
    const auto settings = scene_settings(folder.put(name, R"({"settings": {"map-size": "64"}})"));
    ASSERT_EQ(settings.size(), 1u) << name;
    EXPECT_EQ(settings[0].value, "64") << name;
  }
}

TEST(JsonScene, ObjectsThatCastOrReceiveNoShadowHaveMaterialsOfTheirOwn) {
  const auto scene = load_json_scene(R"({"schema": "gnomon/scene/1",
    "camera": {"eye": [0, 0, 9], "target": [0, 0, 0]}, "lights": [{"type": "point", "position": [0, 9, 0]}],
    "materials": [{"name": "grey"}, {"name": "sky", "receives_shadow": false}],
    "meshes": [{"name": "tri", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,2]]}],
    "instances": [{"name": "usual", "mesh": "tri", "material": "grey"},
                  {"name": "pane", "mesh": "tri", "material": "grey", "casts_shadow": false},
                  {"name": "rail", "mesh": "tri", "material": "grey", "casts_shadow": false},
                  {"name": "dome", "mesh": "tri", "material": "sky", "casts_shadow": false}],
    "shapes": [{"name": "ball", "sphere": {"center": [0,0,0], "radius": 1}, "material": "grey", "receives_shadow": false}]})",
                                     "s.json", "", {});
  ASSERT_TRUE(scene) << scene.error().message();
  const auto of = [&](std::size_t i) { return scene->materials[scene->instances[i].material]; };
  EXPECT_TRUE(of(0).casts_shadow && of(0).receives_shadow);
  EXPECT_EQ(of(0).name, "grey");
  EXPECT_FALSE(of(1).casts_shadow);
  EXPECT_TRUE(of(1).receives_shadow);
  EXPECT_EQ(of(1).name, "grey (casts no shadow)");
  EXPECT_EQ(scene->instances[1].material, scene->instances[2].material);
  EXPECT_FALSE(of(3).casts_shadow || of(3).receives_shadow);
  const Material& ball = scene->materials[scene->shapes[0].material];
  EXPECT_TRUE(ball.casts_shadow && !ball.receives_shadow);
  EXPECT_TRUE(test::has_note(*scene,
                             "3 objects cast no shadow: they are in no map, and no shadow ray meets them "
                             "(pane, rail, dome)."));
  EXPECT_TRUE(test::has_note(*scene,
                             "2 objects receive no shadow: both renderers light them, and they count as lit "
                             "(dome, ball)."));
}

}  // namespace
}  // namespace gnomon
