// glTF and GLB: accessors of every kind, nodes, lights, materials, and hostile files.
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>

#include "scene/files/image_io.h"
#include "scene/load.h"
#include "scene/world.h"
#include "scene_files_support.h"

namespace gnomon {
namespace {

using Json = nlohmann::json;

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t block = 0;
    for (std::size_t k = 0; k < 3; ++k)
      block = block << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? digits[block >> (18 - 6 * k) & 63u] : '=';
  }
  return out;
}

// A glTF under construction: every accessor gets a bufferView of its own.
struct Builder {
  std::string buffer;
  Json json{{"asset", {{"version", "2.0"}}}};

  template <class T>
  int view(const std::vector<T>& values) {
    while (buffer.size() % 4) buffer += '\0';
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", values.size() * sizeof(T)}});
    buffer.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }
  template <class T>
  int accessor(const std::vector<T>& values, int component_type, const std::string& type,
               std::size_t components) {
    const int index = view(values);
    json["accessors"].push_back({{"bufferView", index},
                                 {"componentType", component_type},
                                 {"count", values.size() / components},
                                 {"type", type}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  int positions(const std::vector<float>& values) { return accessor(values, 5126, "VEC3", 3); }

  std::string text() {
    json["buffers"] = Json::array(
        {{{"byteLength", buffer.size()}, {"uri", "data:application/octet-stream;base64," + base64(buffer)}}});
    return json.dump(1);
  }
  std::string glb() {
    json["buffers"] = Json::array({{{"byteLength", buffer.size()}}});
    std::string text = json.dump(), bytes = buffer;
    while (text.size() % 4) text += ' ';
    while (bytes.size() % 4) bytes += '\0';
    std::string out = "glTF";
    const auto word = [&](std::size_t v) {
      const auto w = static_cast<std::uint32_t>(v);
      out.append(reinterpret_cast<const char*>(&w), 4);
    };
    word(2), word(28 + text.size() + bytes.size());
    word(text.size()), word(0x4e4f534a);
    out += text;
    word(bytes.size()), word(0x004e4942);
    return out + bytes;
  }
};

const std::vector<float> four{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

// One node with one mesh of one primitive.
Builder simple(int mode = 4, bool indexed = true) {
  Builder b;
  const int positions = b.positions(four);
  Json primitive{{"attributes", {{"POSITION", positions}}}, {"mode", mode}};
  if (indexed)
    primitive["indices"] = b.accessor(std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3}, 5123, "SCALAR", 1);
  b.json["meshes"] = Json::array({{{"primitives", Json::array({primitive})}}});
  b.json["nodes"] = Json::array({{{"mesh", 0}}});
  b.json["scenes"] = Json::array({{{"nodes", {0}}}});
  b.json["scene"] = 0;
  return b;
}

class Gltf : public testing::Test {
 protected:
  Expected<Scene> load(const std::string& text, const std::string& name = "m.gltf") {
    return load_scene(path_ = folder_.put(name, text));
  }
  Scene loaded(Builder b) {
    auto scene = load(b.text());
    if (scene) return std::move(*scene);
    ADD_FAILURE() << scene.error().message();
    return {};
  }
  std::string error(const std::string& text, const std::string& name = "m.gltf") {
    const auto scene = load(text, name);
    if (scene) return "loaded";
    EXPECT_EQ(scene.error().kind, ErrorKind::bad_input);
    EXPECT_EQ(scene.error().message().find('\n'), std::string::npos);
    EXPECT_EQ(scene.error().file, path_);
    return scene.error().field + ": " + scene.error().reason;
  }
  TemporaryFolder folder_;
  std::string path_;
};

bool has_note(const Scene& scene, std::string_view part) {
  return std::any_of(scene.notes.begin(), scene.notes.end(),
                     [&](const std::string& n) { return n.find(part) != std::string::npos; });
}

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

Material material_of(const Scene& s) {
  return s.materials[s.meshes[0].triangle_materials[0]];
}

TEST_F(Gltf, MaterialsAreMappedAsDocumented) {
  const auto with = [&](const Json& material) {
    Builder b = simple();
    b.json["materials"] = Json::array({material});
    b.json["meshes"][0]["primitives"][0]["material"] = 0;
    return loaded(b);
  };
  const Material plastic = material_of(
      with({{"pbrMetallicRoughness",
             {{"baseColorFactor", {0.5, 0.25, 1, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}}}}));
  EXPECT_EQ(plastic.diffuse, Vec3f(0.5f, 0.25f, 1.0f));
  EXPECT_EQ(plastic.specular, Vec3f(0.04f));
  EXPECT_NEAR(plastic.shininess, 30.0f, 1e-4f);  // 2 / 0.25^2 - 2
  EXPECT_EQ(plastic.mirror, 0.0f);
  const Material metal = material_of(
      with({{"pbrMetallicRoughness", {{"baseColorFactor", {0.9, 0.6, 0.3, 1}}, {"roughnessFactor", 0.0}}}}));
  EXPECT_EQ(metal.diffuse, Vec3f(0.0f));
  EXPECT_NEAR(metal.mirror, 0.6f, 1e-6f);
  const Json solid{
      {"KHR_materials_transmission", {{"transmissionFactor", 0.75}}},
      {"KHR_materials_ior", {{"ior", 1.25}}},
      {"KHR_materials_volume",
       {{"thicknessFactor", 1}, {"attenuationDistance", 2}, {"attenuationColor", {1, 0.5, 0.25}}}}};
  const Material glass = material_of(with(
      {{"extensions", solid}, {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}}}));
  EXPECT_EQ(glass.transmission, 0.75f);
  EXPECT_EQ(glass.ior, 1.25f);
  EXPECT_NEAR(glass.absorption.g, std::log(2.0f) / 2.0f, 1e-6f);
  EXPECT_NEAR(glass.absorption.b, std::log(4.0f) / 2.0f, 1e-6f);
  const Material pane =
      material_of(with({{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}},
                        {"pbrMetallicRoughness", {{"metallicFactor", 0}}}}));
  EXPECT_EQ(pane.ior, 1.0f);
  EXPECT_NEAR(pane.mirror, 0.04f, 1e-6f);
  EXPECT_NEAR(pane.transmission, 0.96f, 1e-6f);
  const Material lamp =
      material_of(with({{"emissiveFactor", {1, 0.5, 0}},
                        {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}}));
  EXPECT_EQ(lamp.emission, Vec3f(8, 4, 0));
  const Material masked =
      material_of(with({{"alphaMode", "MASK"},
                        {"alphaCutoff", 0.25},
                        {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}}}}));
  EXPECT_EQ(masked.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(masked.alpha_cutoff, 0.25f);
  EXPECT_EQ(masked.alpha, 0.5f);
  const Scene blended =
      with({{"alphaMode", "BLEND"},
            {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.25}}, {"metallicFactor", 0}}}});
  EXPECT_EQ(material_of(blended).transmission, 0.75f);
  EXPECT_TRUE(has_note(blended, "became a thin sheet with transmission 0.75"));
}

TEST_F(Gltf, TexturesComeThroughOpenImageIO) {
  Rgb8Image image({2, 1});
  image.at(1, 0) = {255, 128, 0};
  const auto png = encode_png(image);
  ASSERT_TRUE(png);
  Builder b = simple();
  b.json["images"] = Json::array({{{"uri", "data:image/png;base64," + base64(*png)}}});
  b.json["samplers"] = Json::array({{{"magFilter", 9728}, {"wrapS", 33071}}});
  b.json["textures"] = Json::array({{{"source", 0}, {"sampler", 0}}});
  const Json transform{
      {"KHR_texture_transform", {{"offset", {0.5, 0.25}}, {"scale", {2, 3}}, {"rotation", 0.125}}}};
  b.json["materials"] = Json::array(
      {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"extensions", transform}}}}}}});
  b.json["meshes"][0]["primitives"][0]["material"] = 0;
  b.json["extensionsRequired"] = {"KHR_texture_transform"};
  const Scene s = loaded(b);
  ASSERT_EQ(s.textures.size(), 1u);
  EXPECT_EQ(s.textures[0].texels[1], glm::u8vec4(255, 128, 0, 255));
  EXPECT_TRUE(s.textures[0].nearest && !s.textures[0].repeat_s && s.textures[0].repeat_t &&
              s.textures[0].srgb);
  const TextureTransform& t = s.materials[0].texture_transform;
  EXPECT_EQ(t.offset, Vec2(0.5, 0.25));
  EXPECT_EQ(t.scale, Vec2(2, 3));
  EXPECT_EQ(t.rotation, 0.125);
  b.json["images"][0]["uri"] = "data:image/png;base64," + base64(png->substr(0, png->size() / 2));
  EXPECT_EQ(error(b.text()).substr(0, 34), "images[0]: the PNG file is cut off");
}

TEST_F(Gltf, Extensions) {
  Builder b = simple();
  b.json["extensionsUsed"] = {"ACME_sparkle"};
  EXPECT_TRUE(has_note(loaded(b), "The extension ACME_sparkle is not supported and was not used."));
  b.json["extensionsRequired"] = {"ACME_sparkle"};
  EXPECT_EQ(error(b.text()).substr(0, 89),
            "extensionsRequired[0]: the file needs an extension that is not supported (got \"ACME_spark");
}

struct GltfMistake {
  std::string_view what;
  std::function<void(Builder&)> break_it;
  std::string_view start;
};

TEST_F(Gltf, MistakesHaveTheirPath) {
  const auto primitive = [](Builder& b) -> Json& { return b.json["meshes"][0]["primitives"][0]; };
  const GltfMistake mistakes[] = {
      {"no asset", [](Builder& b) { b.json.erase("asset"); }, ": asset is missing"},
      {"version", [](Builder& b) { b.json["asset"]["version"] = "1.0"; },
       "asset.version: unknown version (got \"1.0\", allowed 2.x)"},
      {"count 2^62", [](Builder& b) { b.json["accessors"][0]["count"] = 4611686018427387904; },
       "accessors[0].count: out of range (got 4611686018427387904"},
      {"count beyond", [](Builder& b) { b.json["accessors"][0]["count"] = 5; },
       "accessors[0]: reaches past its bufferView (got bytes up to 60, allowed up to 48)"},
      {"negative count", [](Builder& b) { b.json["accessors"][0]["count"] = -1; },
       "accessors[0].count: out of range (got -1"},
      {"count without data",
       [](Builder& b) {
         b.json["accessors"][0].erase("bufferView"), b.json["accessors"][0]["count"] = 4000000000;
       },
       "accessors[0].count: no data stands behind these elements"},
      {"offset", [](Builder& b) { b.json["accessors"][0]["byteOffset"] = 4; },
       "accessors[0]: reaches past its bufferView"},
      {"huge offset", [](Builder& b) { b.json["accessors"][0]["byteOffset"] = 9007199254740992; },
       "accessors[0]: reaches past its bufferView"},
      {"view", [](Builder& b) { b.json["bufferViews"][0]["byteLength"] = 1000; },
       "bufferViews[0]: reaches past its buffer"},
      {"view index", [](Builder& b) { b.json["accessors"][0]["bufferView"] = 7; },
       "accessors[0].bufferView: out of range (got 7, allowed a whole number in [0, 1])"},
      {"component type", [](Builder& b) { b.json["accessors"][0]["componentType"] = 5124; },
       "accessors[0].componentType: unknown component type"},
      {"type", [](Builder& b) { b.json["accessors"][0]["type"] = "VEC5"; },
       "accessors[0].type: unknown type"},
      {"position type", [](Builder& b) { b.json["accessors"][0]["type"] = "VEC2"; },
       "meshes[0].primitives[0].attributes.POSITION: the accessor's type does not fit (got VEC2, allowed "
       "VEC3)"},
      {"vertex index", [](Builder& b) { b.buffer[48] = 4; },
       "meshes[0].primitives[0].indices[0]: vertex index out of range (got 4, allowed 0 to 3)"},
      {"accessor index", [&](Builder& b) { primitive(b)["indices"] = 9; },
       "meshes[0].primitives[0].indices: out of range"},
      {"material index", [&](Builder& b) { primitive(b)["material"] = 0; },
       "meshes[0].primitives[0].material: refers to a list that is empty or missing"},
      {"mode", [&](Builder& b) { primitive(b)["mode"] = 7; }, "meshes[0].primitives[0].mode: out of range"},
      {"no attributes", [&](Builder& b) { primitive(b).erase("attributes"); },
       "meshes[0].primitives[0]: attributes is missing"},
      {"no POSITION",
       [&](Builder& b) {
         primitive(b)["attributes"] = {{"NORMAL", 0}};
       },
       ": the file has no triangles"},
      {"NaN", [](Builder& b) { b.buffer.replace(0, 4, "\xff\xff\xff\x7f"); },
       "meshes[0].primitives[0].attributes.POSITION[0]: position (got [nan, 0, 0], allowed up to 1e+15 in "
       "magnitude)"},
      {"own child", [](Builder& b) { b.json["nodes"][0]["children"] = {0}; },
       "nodes[0]: the node is its own ancestor"},
      {"cycle",
       [](Builder& b) {
         b.json["nodes"] = Json::array({{{"children", {1}}}, {{"children", {0}}}});
       },
       "nodes[0]: the node is its own ancestor"},
      {"two parents",
       [](Builder& b) {
         b.json["nodes"] = Json::array({{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}});
       },
       "nodes[1].children[0]: node 2 has two parents (0 and 1)"},
      {"child index", [](Builder& b) { b.json["nodes"][0]["children"] = {-1}; },
       "nodes[0].children[0]: out of range (got -1"},
      {"matrix",
       [](Builder& b) {
         b.json["nodes"][0]["matrix"] = {1, 2, 3};
       },
       "nodes[0].matrix: wrong type (got an array of 3, allowed an array of 16)"},
      {"huge matrix",
       [](Builder& b) {
         b.json["nodes"][0]["translation"] = {1e200, 0, 0};
       },
       "instances[0].matrix: is not finite or above 1e+15 in magnitude"},
      {"scene index", [](Builder& b) { b.json["scene"] = 3; }, "scene: out of range (got 3"},
      {"light index",
       [](Builder& b) { b.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0; },
       "nodes[0].extensions.KHR_lights_punctual.light: refers to a list that is empty or missing"},
      {"sparse count",
       [](Builder& b) {
         b.json["accessors"][0]["sparse"] = {{"count", 5},
                                             {"indices", {{"bufferView", 1}, {"componentType", 5121}}},
                                             {"values", {{"bufferView", 0}}}};
       },
       "accessors[0].sparse.count: out of range (got 5"},
      {"sparse overrun",
       [](Builder& b) {
         b.json["accessors"][0]["sparse"] = {{"count", 4},
                                             {"indices", {{"bufferView", 1}, {"componentType", 5125}}},
                                             {"values", {{"bufferView", 0}}}};
       },
       "accessors[0].sparse.indices: reaches past its bufferView"},
      {"draco",
       [&](Builder& b) { primitive(b)["extensions"]["KHR_draco_mesh_compression"] = Json::object(); },
       "meshes[0].primitives[0]: the geometry is compressed"},
      {"wrong types", [](Builder& b) { b.json["meshes"] = "none"; }, "meshes: wrong type"},
      {"number for object", [](Builder& b) { b.json["nodes"][0] = 5; },
       "nodes[0]: wrong type (got 5, allowed an object)"},
  };
  for (const GltfMistake& m : mistakes) {
    Builder b = simple();
    m.break_it(b);
    const std::string message = error(b.text());
    EXPECT_EQ(message.substr(0, m.start.size()), m.start) << m.what << "\n  " << message;
  }
  const auto scene = load(R"({
  "asset": {"version": "2.0"},
  "scene": 4})");
  EXPECT_EQ(scene.error().message(),
            path_ + ":3:12: scene: refers to a list that is empty or missing (got 4, allowed no index)");
}

TEST_F(Gltf, HostileContainers) {
  const std::string glb = simple().glb();
  const auto patched = [&](std::size_t at, char value) {
    std::string bytes = glb;
    bytes[at] = value;
    return bytes;
  };
  EXPECT_EQ(error("", "m.glb"), "magic: not a GLB file (it must start with \"glTF\")");
  EXPECT_EQ(error("glTG", "m.glb"), "magic: not a GLB file (it must start with \"glTF\")");
  EXPECT_EQ(error(glb.substr(0, 12), "m.glb"),
            "header: the file is cut off (got 12 bytes, allowed 20 or more)");
  EXPECT_EQ(error(patched(4, 1), "m.glb"), "version: unknown version (got 1, allowed 2)");
  EXPECT_EQ(error(glb.substr(0, glb.size() - 4), "m.glb").substr(0, 28), "length: not the file's size ");
  EXPECT_EQ(error(patched(14, '\x7f'), "m.glb").substr(0, 32), "chunks[0]: the chunk is cut off ");
  EXPECT_EQ(error(patched(16, 'B'), "m.glb"), "chunks[0]: the first chunk is not JSON");
  for (std::size_t n = 0; n < glb.size(); n += 7) EXPECT_NE(error(glb.substr(0, n), "m.glb"), "loaded") << n;
}

TEST_F(Gltf, ConfinedBuffers) {
  Builder b = simple();
  folder_.put("data.bin", b.buffer);
  b.text();
  b.json["buffers"][0]["uri"] = "../data.bin";
  const std::string path = folder_.put("in/m.gltf", b.json.dump());
  EXPECT_TRUE(load_scene(path));
  LoadOptions confined;
  confined.confine_paths = true;
  const auto refused = load_scene(path, confined);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message().find("outside the scene's folder"), std::string::npos)
      << refused.error().message();
  folder_.put("in/data.bin", b.buffer);
  b.json["buffers"][0]["uri"] = "data.bin";
  const auto inside = load_scene(folder_.put("in/m.gltf", b.json.dump()), confined);
  EXPECT_TRUE(inside) << inside.error().message();
}

// Any one byte of a small file changed: an error or a scene, never more.
TEST_F(Gltf, EveryByteFlipped) {
  const std::string glb = simple().glb();
  int errors = 0;
  for (std::size_t i = 0; i < glb.size(); ++i) {
    std::string bytes = glb;
    bytes[i] = static_cast<char>(bytes[i] ^ 0x15);
    errors += !load(bytes, "m.glb");
  }
  EXPECT_GT(errors, 200);
}

}  // namespace
}  // namespace gnomon
