// Scenes written as glTF and read again: the same positions, cameras, lights, materials and truth.
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

#include "raytrace/frame.h"
#include "scene/files/gltf/gltf_data.h"
#include "scene/files/gltf/gltf_writer.h"
#include "scene/shapes/tessellate.h"
#include "scene/world.h"
#include "tests/support/gltf_support.h"

namespace gnomon::gltf_test {
namespace {

Scene without_shapes(Scene scene) {
  return cut_planes(tessellate_shapes(std::move(scene), 24));
}

Scene reread(const Scene& scene, bool binary) {
  const TemporaryFolder folder;
  const auto file = write_gltf(scene, binary);
  EXPECT_TRUE(file) << file.error().message();
  auto again = load_scene(folder.put(binary ? "s.glb" : "s.gltf", file->bytes));
  if (again) return std::move(*again);
  ADD_FAILURE() << scene.name << ": " << again.error().message();
  return {};
}

/// Triangles object by object, and in these by material: the order in which a file keeps them.
std::vector<std::uint32_t> in_file_order(const World& world) {
  std::vector<std::uint32_t> out(world.triangle_count());
  std::iota(out.begin(), out.end(), 0u);
  std::stable_sort(out.begin(), out.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(world.object_of(a), world.material_of(a)) <
           std::pair(world.object_of(b), world.material_of(b));
  });
  return out;
}

/// All positions are floats, and can be equal to the last bit.
bool holds_floats(const Scene& scene) {
  for (const Mesh& mesh : scene.meshes)
    for (const Vec3& p : mesh.positions)
      if (Vec3(Vec3f(p)) != p) return false;
  return true;
}

void expect_same_triangles(const Scene& before, const World& a, const World& b) {
  const std::vector<std::uint32_t> x = in_file_order(a), y = in_file_order(b);
  ASSERT_EQ(x.size(), y.size());
  double farthest = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    ASSERT_EQ(a.material_of(x[i]), b.material_of(y[i]));
    const auto p = a.corners(x[i]), q = b.corners(y[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      farthest = std::max(farthest, glm::distance(p[k], q[k]));
      largest = std::max(largest, glm::length(p[k]));
    }
  }
  // Rounding to a float moves a coordinate by at most 2^-24 of the largest, a point by the root of three times.
  EXPECT_LE(farthest, holds_floats(before) ? 0.0 : largest * std::ldexp(std::sqrt(3.0), -24));
}

void expect_same_material(const Material& a, const Material& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.diffuse, b.diffuse) << a.name;
  EXPECT_EQ(a.specular, b.specular) << a.name;
  EXPECT_EQ(a.shininess, b.shininess) << a.name;
  EXPECT_EQ(a.emission, b.emission) << a.name;
  EXPECT_EQ(a.mirror, b.mirror) << a.name;
  EXPECT_EQ(a.transmission, b.transmission) << a.name;
  EXPECT_EQ(a.ior, b.ior) << a.name;
  EXPECT_EQ(a.absorption, b.absorption) << a.name;
  EXPECT_EQ(a.roughness, b.roughness) << a.name;
  EXPECT_EQ(a.priority, b.priority) << a.name;
  EXPECT_EQ(a.thin, b.thin) << a.name;
  EXPECT_EQ(a.diffuse_texture == no_id, b.diffuse_texture == no_id) << a.name;
  EXPECT_EQ(a.texture_transform.offset, b.texture_transform.offset) << a.name;
  EXPECT_EQ(a.texture_transform.scale, b.texture_transform.scale) << a.name;
  EXPECT_EQ(a.texture_transform.rotation, b.texture_transform.rotation) << a.name;
  EXPECT_EQ(a.emission_texture == no_id, b.emission_texture == no_id) << a.name;
  EXPECT_EQ(a.emission_transform.offset, b.emission_transform.offset) << a.name;
  EXPECT_EQ(a.unlit, b.unlit) << a.name;
  EXPECT_EQ(a.double_sided, b.double_sided) << a.name;
  EXPECT_EQ(a.alpha_mode, b.alpha_mode) << a.name;
  EXPECT_EQ(a.alpha, b.alpha) << a.name;
  EXPECT_EQ(a.alpha_cutoff, b.alpha_cutoff) << a.name;
}

void expect_same_but_geometry(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.camera, b.camera);
  EXPECT_EQ(a.lights, b.lights);
  EXPECT_EQ(a.ambient, b.ambient);
  EXPECT_EQ(a.background, b.background);
  EXPECT_EQ(a.exposure, b.exposure);
  EXPECT_EQ(a.max_depth, b.max_depth);
  EXPECT_EQ(a.glossy_samples, b.glossy_samples);
  EXPECT_EQ(a.indirect_samples, b.indirect_samples);
  ASSERT_LE(a.materials.size(), b.materials.size());  // the reader adds one for meshes without
  for (std::size_t i = 0; i < a.materials.size(); ++i) expect_same_material(a.materials[i], b.materials[i]);
  for (std::size_t i = 0; i < a.materials.size(); ++i) {
    if (a.materials[i].diffuse_texture == no_id || b.materials[i].diffuse_texture == no_id) continue;
    const Texture &x = a.textures[a.materials[i].diffuse_texture],
                  &y = b.textures[b.materials[i].diffuse_texture];
    EXPECT_EQ(x.texels, y.texels) << x.name;
    EXPECT_TRUE(x.nearest == y.nearest && x.repeat_s == y.repeat_s && x.repeat_t == y.repeat_t) << x.name;
  }
}

raytrace::RayTracedFrame traced(const Scene& scene, const World& world) {
  const raytrace::Tracer tracer(world, raytrace::Accel::bvh, raytrace::Precision::robust);
  std::vector<std::uint32_t> lights(scene.lights.size());
  for (std::uint32_t i = 0; i < lights.size(); ++i) lights[i] = i;
  raytrace::RaytraceOptions options;
  options.size = {160, 90};
  options.picture = false;
  options.shadow_samples = 4;
  return trace_frame(tracer, plan_effects(scene), scene.camera, lights, options);
}

class EveryBuiltinScene : public testing::TestWithParam<std::string> {};

TEST_P(EveryBuiltinScene, ComesBackAsItWas) {
  const Scene before = without_shapes(*load_scene(GetParam()));
  const Scene after = reread(before, true);
  expect_same_but_geometry(before, after);
  EXPECT_EQ(before.instances.size(), after.instances.size());
  const World world = make_world(before), again = make_world(after);
  expect_same_triangles(before, world, again);
  const auto truth = traced(before, world), truth_again = traced(after, again);
  ASSERT_EQ(truth.lights.size(), truth_again.lights.size());
  for (std::size_t l = 0; l < truth.lights.size(); ++l) {
    EXPECT_EQ(truth.lights[l].centre.data, truth_again.lights[l].centre.data);
    EXPECT_EQ(truth.lights[l].visibility.data, truth_again.lights[l].visibility.data);
  }
}

std::vector<std::string> builtin_names() {
  std::vector<std::string> out;
  for (const BuiltinScene& scene : builtin_scenes())
    if (!scene.large) out.emplace_back(scene.name);
  return out;
}
std::string test_name(const testing::TestParamInfo<std::string>& scene) {
  std::string name = scene.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(GltfWriter, EveryBuiltinScene, testing::ValuesIn(builtin_names()), test_name);

/// A triangle, a material, a sun and a camera.
Scene small() {
  Scene scene;
  scene.name = "small";
  scene.materials.resize(1);
  scene.materials[0].name = "grey";
  Mesh mesh;
  mesh.name = "triangle";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  scene.meshes = {mesh};
  scene.instances = {{"one", 0, Mat4(1.0), 0}};
  scene.lights.resize(1);
  scene.lights[0].name = "sun";
  return scene;
}

Json json_of(const Scene& scene) {
  const auto file = write_gltf(scene, false);
  EXPECT_TRUE(file);
  return Json::parse(file->bytes);
}

TEST(GltfWriter, TheSameSceneGivesTheSameBytes) {
  const Scene scene = *load_scene("floating-box");
  for (const bool binary : {false, true})
    EXPECT_EQ(write_gltf(scene, binary)->bytes, write_gltf(scene, binary)->bytes);
  const std::string bytes = write_gltf(scene, true)->bytes;
  const auto chunks = read_glb(bytes, "s.glb");
  ASSERT_TRUE(chunks) << chunks.error().message();
  EXPECT_EQ(bytes.size() % 4, 0u);
}

TEST(GltfWriter, WhatCastsOrReceivesNoShadowComesBack) {
  Scene scene = small();
  scene.materials[0].casts_shadow = false;
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].casts_shadow = true, scene.materials[1].receives_shadow = false;
  scene.instances.push_back({"two", 0, Mat4(1.0), 1});
  Json json = json_of(scene);
  const Scene again = reread(scene, false);
  for (std::size_t i = 0; i < 2; ++i) {
    const Material& m = again.materials[again.instances[i].material];
    EXPECT_EQ(m.casts_shadow, i == 1);
    EXPECT_EQ(m.receives_shadow, i == 0);
  }
  // Of other programs' files too: a node's own extras, as a truth value or as 0.
  json["asset"]["generator"] = "another";
  for (Json& material : json["materials"]) material.erase("extras");
  for (Json& node : json["nodes"])
    if (node.contains("mesh")) node["extras"] = {{"casts_shadow", 0}, {"receives_shadow", false}};
  const TemporaryFolder folder;
  const auto other = load_scene(folder.put("other.gltf", json.dump()));
  ASSERT_TRUE(other);
  for (const MeshInstance& instance : other->instances)
    EXPECT_FALSE(other->materials[instance.material].casts_shadow ||
                 other->materials[instance.material].receives_shadow);
}

TEST(GltfWriter, AnOrthographicCameraComesBack) {
  for (const Vec3& eye : {Vec3(1, 2, 5), Vec3(1, 2, 500), Vec3(0.1, 0.1, 0.3)}) {
    Scene scene = small();
    scene.camera = {.eye = eye, .target = {0, 0.5, 0}, .orthographic_height = 3.5};
    EXPECT_EQ(reread(scene, true).camera, scene.camera);
    const Json json = json_of(scene)["cameras"][0];
    EXPECT_EQ(json["type"], "orthographic");
    EXPECT_FALSE(json.contains("perspective"));
    EXPECT_EQ(json["orthographic"]["ymag"], 1.75);
    EXPECT_GE(double(json["orthographic"]["znear"]), 0.0);
    EXPECT_GT(double(json["orthographic"]["zfar"]), double(json["orthographic"]["znear"]));
  }
}

TEST(GltfWriter, InstancesShareTheirMesh) {
  Scene scene = small();
  scene.instances.push_back({"two", 0, glm::translate(Mat4(1.0), Vec3(0.1, 0.2, 0.3)), 0});
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].name = "other";
  scene.instances.push_back({"three", 0, glm::scale(Mat4(1.0), Vec3(-1.0, 1.0, 1.0)), 1});
  const Json json = json_of(scene);
  EXPECT_EQ(json["meshes"].size(), 2u);  // one for each material, of the same buffers
  EXPECT_EQ(json["bufferViews"].size(), 2u);
  const Scene again = reread(scene, true);
  ASSERT_EQ(again.instances.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(again.instances[i].name, scene.instances[i].name);
    EXPECT_EQ(again.instances[i].world_from_object, scene.instances[i].world_from_object);
  }
}

TEST(GltfWriter, MeshesFarFromTheirOriginKeepTheirDigits) {
  Scene scene = small();
  for (Vec3& p : scene.meshes[0].positions) p = 0.3 * p + Vec3(1e6, 0.0, -2e6);
  const Scene read = reread(scene, true);
  const World before = make_world(scene), after = make_world(read);
  for (std::size_t i = 0; i < 3;
       ++i)  // floats at 2e6 are 0.25 apart; those around the triangle's middle 1.2e-8
    EXPECT_LT(glm::distance(before.position(i), after.position(i)), 3e-8);
}

// A reader that keeps a node's place in floats must draw the mesh where it is: the place is a float's value.
TEST(GltfWriter, MeshesFarFromTheirOriginArePlacedByFloats) {
  Scene scene = small();
  for (Vec3& p : scene.meshes[0].positions) p += Vec3(1000.1, 1000.2, 0.25);
  const Json place = json_of(scene)["nodes"][0]["matrix"];
  for (const std::size_t i : {12u, 13u, 14u}) {
    volatile auto as_float = place[i].get<float>();
    EXPECT_EQ(place[i].get<double>(), static_cast<double>(as_float)) << i;
  }
}

/// By its corners' order.
Vec3 normal_of_first(const World& world) {
  const auto t = world.triangle(0);
  return glm::normalize(
      glm::cross(world.position(t[1]) - world.position(t[0]), world.position(t[2]) - world.position(t[0])));
}

TEST(GltfWriter, ShearIsPutIntoTheMesh) {
  Scene scene = small();
  scene.meshes[0].normals.assign(3, Vec3f(0, 0, 1));
  Mat4 shear(1.0);
  shear[2] = Vec4(0.5, 0.25, 1.0, 0.0);
  shear[3] = Vec4(3.0, 2.0, 1.0, 1.0);
  scene.meshes[0].positions[2] = {0, 1, 2};
  scene.instances[0].world_from_object = shear;
  const Scene read = reread(scene, true);
  const World before = make_world(scene), after = make_world(read);
  EXPECT_EQ(positions_of(before), positions_of(after));  // binary fractions
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_LT(glm::distance(before.normal(i), after.normal(i)), 1e-6f);
  EXPECT_EQ(write_gltf(scene, true)->notes.size(), 1u);
}

// Its triangles face the other way when they are put into the world: so must those that the file has.
TEST(GltfWriter, AShearThatMirrorsTurnsTheTriangles) {
  Scene scene = small();
  scene.meshes[0].positions[2] = {0, 1, 2};
  Mat4 shear(1.0);
  shear[0] = Vec4(-1.0, 0.0, 0.0, 0.0);
  shear[2] = Vec4(0.5, 0.25, 1.0, 0.0);
  scene.instances[0].world_from_object = shear;
  scene.materials[0].double_sided = false;
  const Scene read = reread(scene, true);
  EXPECT_EQ(normal_of_first(make_world(scene)), normal_of_first(make_world(read)));
}

TEST(GltfWriter, TrianglesWithoutNormalsStayFlat) {
  Scene scene = small();
  Mesh& mesh = scene.meshes[0];
  mesh.positions.push_back({1, 1, 0});
  mesh.normals = {{0, 0, 0}, {0, 0, 2}, {0, 0, 1}, {0, 0, 1}};
  mesh.triangles.push_back({1, 3, 2});
  const Scene read = reread(scene, true);
  const World after = make_world(read);
  ASSERT_EQ(after.triangle_count(), 2u);
  EXPECT_EQ(after.normal(after.triangle(0)[0]), Vec3f(0.0f));
  EXPECT_EQ(after.normal(after.triangle(1)[0]), Vec3f(0, 0, 1));
}

TEST(GltfWriter, LightsOfEverySizeComeBack) {
  Scene scene = small();
  Light spot{.name = "spot", .type = LightType::spot, .position = {0.1, 3.0, 0.7}};
  spot.direction = glm::normalize(Vec3(0.3, -1.0, 0.2));
  spot.intensity = {0.1f, 20.3f, 7.7f};
  spot.inner_angle = 0.49999, spot.outer_angle = 0.5;
  spot.extent = RectangleLight{{0.1, 0.0, 0.0}, {0.0, 0.0, 0.3}};
  Light disc = spot;
  disc.name = "disc";
  disc.extent = DiscLight{0.25, glm::normalize(Vec3(1, -2, 3))};
  disc.shadow_samples = 17;
  Light point{.name = "point", .type = LightType::point, .position = {1e5, 2.0, 3.0}};
  point.extent = SphereLight{0.125};
  point.intensity = Vec3f(0.0f);
  scene.lights[0].extent = SunDisc{0.0093};
  scene.lights.insert(scene.lights.end(), {spot, disc, point});
  const Scene again = reread(scene, true);
  ASSERT_EQ(again.lights.size(), scene.lights.size());
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light &a = again.lights[i], &b = scene.lights[i];
    EXPECT_EQ(a.position, b.position) << b.name;
    EXPECT_EQ(a.direction, b.direction) << b.name;
    EXPECT_EQ(a.intensity, b.intensity) << b.name;
    EXPECT_EQ(a.inner_angle, b.inner_angle) << b.name;
    EXPECT_EQ(a.outer_angle, b.outer_angle) << b.name;
    EXPECT_TRUE(a.extent == b.extent) << b.name;
    EXPECT_TRUE(a == b) << b.name;
  }
  EXPECT_EQ(write_gltf(scene, true)->notes.size(), 4u);
}

TEST(GltfWriter, ExtrasOfOthersAreNotRead) {
  const TemporaryFolder folder;
  Scene scene = small();
  scene.lights[0].extent = SunDisc{0.0093};
  Json json = json_of(scene);
  const auto read = [&] { return *load_scene(folder.put("s.gltf", json.dump())); };
  EXPECT_TRUE(std::holds_alternative<SunDisc>(read().lights[0].extent));
  json["cameras"][0]["extras"]["gnomon"]["target"] = {7, 7, 7};  // no longer where the node looks
  EXPECT_NEAR(glm::distance(glm::normalize(read().camera.target - read().camera.eye),
                            glm::normalize(scene.camera.target - scene.camera.eye)),
              0.0, 1e-12);
  json["materials"][0]["extras"]["gnomon"]["shininess"] = -1;
  const auto wrong = load_scene(folder.put("s.gltf", json.dump()));
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().field, "materials[0].shininess");
  json["asset"]["generator"] = "another program";
  EXPECT_TRUE(std::holds_alternative<PointShape>(read().lights[0].extent));
}

TEST(GltfWriter, SidesColoursAndWhatGlowsComeBack) {
  Scene scene = small();
  scene.meshes[0].uvs = {{0, 0}, {1, 0}, {0, 1}};
  scene.meshes[0].colors = {{1, 0, 0.25f, 1}, {0.5f, 1, 0, 0.5f}, {0, 0, 1, 1}};
  scene.textures.push_back({"lamp", {2, 1}, {{255, 0, 10, 255}, {1, 2, 3, 255}}, true, true, false, true});
  scene.materials[0].double_sided = false;
  scene.materials[0].emission = Vec3f(2.0f, 1.0f, 0.5f);
  scene.materials[0].emission_texture = 0;
  scene.materials[0].emission_transform = {{0.1, 0.2}, {3.0, 0.7}, 0.4};
  Material flat;
  flat.name = "flat", flat.unlit = true;
  flat.diffuse = Vec3f(0.5f);
  scene.materials.push_back(flat);
  for (const bool binary : {false, true}) {
    const Scene again = reread(scene, binary);
    expect_same_but_geometry(scene, again);
    EXPECT_EQ(again.meshes[0].colors, scene.meshes[0].colors);
  }
}

TEST(GltfWriter, ATextureWithAlphaComesBack) {
  Scene scene = small();
  scene.meshes[0].uvs = {{0, 0}, {1, 0}, {0, 1}};
  scene.textures.push_back({"leaf", {2, 1}, {{255, 0, 10, 0}, {1, 2, 3, 200}}, true, true, false, true});
  scene.materials[0].diffuse_texture = 0;
  scene.materials[0].alpha_mode = AlphaMode::mask;
  scene.materials[0].alpha_cutoff = 0.3f;
  scene.materials[0].texture_transform = {{0.1, 0.2}, {3.0, 0.7}, 0.4};
  for (const bool binary : {false, true}) expect_same_but_geometry(scene, reread(scene, binary));
}

}  // namespace
}  // namespace gnomon::gltf_test
