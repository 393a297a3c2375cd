// glTF's materials, their textures and the vertices' colours.
#include "scene/files/pictures/image_io.h"
#include "scene/world.h"
#include "tests/support/gltf_support.h"

namespace gnomon::gltf_test {
namespace {

Material material_of(const Scene& s) {
  EXPECT_TRUE(s.meshes[0].triangle_materials.empty());
  return s.materials[s.instances[0].material];
}

// Of primitives without triangles nothing is seen, so that their materials do not count.
TEST_F(Gltf, OnlyMeshesOfSeveralMaterialsListThem) {
  Builder b;
  const int positions = b.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const auto primitive = [&](int material, int mode = 4) {
    return Json{{"attributes", {{"POSITION", positions}}}, {"material", material}, {"mode", mode}};
  };
  b.json["materials"] = Json::array({{{"name", "a"}}, {{"name", "b"}}, {{"name", "c"}}});
  b.json["meshes"] =
      Json::array({{{"primitives", Json::array({primitive(2, 0), primitive(1), primitive(1)})}},
                   {{"primitives", Json::array({primitive(1), primitive(1), primitive(0), primitive(1)})}}});
  b.json["nodes"] = Json::array({{{"mesh", 0}}, {{"mesh", 1}}, {{"mesh", 0}, {"scale", {1, 1, 0}}}});
  const Scene scene = loaded(b);
  ASSERT_EQ(scene.instances.size(), 3u);
  EXPECT_TRUE(scene.meshes[scene.instances[0].mesh].triangle_materials.empty());
  EXPECT_EQ(scene.instances[0].material, 1u);
  EXPECT_EQ(scene.meshes[scene.instances[1].mesh].triangle_materials,
            (std::vector<std::uint32_t>{1, 1, 0, 1}));
  EXPECT_TRUE(scene.meshes[scene.instances[2].mesh].triangle_materials.empty());  // flattened to a sheet
  EXPECT_EQ(scene.instances[2].material, 1u);
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
  EXPECT_FALSE(has_note(blended, "no inside to refract in"));
}

// A mask at one half would leave nothing of either: the first has no texel above it, the second none times its factor.
TEST_F(Gltf, BlendingThatNoMaskShowsIsAThinSheet) {
  const auto blended = [&](float factor, std::uint8_t alpha) {
    Texture texture;
    texture.size = {2, 1};
    texture.texels = {{255, 255, 255, alpha}, {255, 255, 255, 0}};
    const auto png = encode_png(texture);
    EXPECT_TRUE(png);
    Builder b = simple();
    b.json["images"] = Json::array({{{"uri", "data:image/png;base64," + base64(*png)}}});
    b.json["textures"] = Json::array({{{"source", 0}}});
    b.json["materials"] = Json::array({{{"alphaMode", "BLEND"},
                                        {"pbrMetallicRoughness",
                                         {{"baseColorTexture", {{"index", 0}}},
                                          {"baseColorFactor", {1, 1, 1, factor}},
                                          {"metallicFactor", 0}}}}});
    b.json["meshes"][0]["primitives"][0]["material"] = 0;
    return material_of(loaded(b));
  };
  EXPECT_EQ(blended(1.0f, 255).alpha_mode, AlphaMode::mask);
  for (const Material& sheet : {blended(1.0f, 51), blended(0.2f, 255)}) {
    EXPECT_EQ(sheet.alpha_mode, AlphaMode::opaque);
    EXPECT_NEAR(sheet.transmission, 0.8f, 1e-6f);
  }
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

TEST_F(Gltf, UnlitMaterialsShowTheirColour) {
  Builder b = simple();
  b.json["materials"] = Json::array({{{"extensions", {{"KHR_materials_unlit", Json::object()}}},
                                      {"emissiveFactor", {1, 1, 1}},
                                      {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 1, 1}}}}}});
  b.json["meshes"][0]["primitives"][0]["material"] = 0;
  b.json["extensionsRequired"] = {"KHR_materials_unlit"};
  const Material m = material_of(loaded(b));
  EXPECT_TRUE(m.unlit);
  EXPECT_EQ(m.diffuse, Vec3f(0.5f, 0.25f, 1.0f));
  EXPECT_EQ(m.emission, Vec3f(0.0f));
  EXPECT_EQ(m.specular, Vec3f(0.0f));
}

// Bytes of three components and floats of four, a primitive without any, a value that is not finite.
TEST_F(Gltf, VertexColours) {
  Builder b = simple();
  Json& primitives = b.json["meshes"][0]["primitives"];
  const int bytes =
      b.accessor(std::vector<std::uint8_t>{255, 51, 0, 0, 0, 0, 255, 255, 255, 102, 0, 255}, 5121, "VEC3", 3);
  b.json["accessors"][static_cast<std::size_t>(bytes)]["normalized"] = true;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const int floats = b.accessor(
      std::vector<float>{0.5f, 2.0f, 0.0f, 0.25f, nan, 0, 0, 1, 1, 1, 1, 1, 0, 0, 0, 0}, 5126, "VEC4", 4);
  const Json plain = primitives[0];
  primitives.push_back(plain), primitives.push_back(plain);
  primitives[0]["attributes"]["COLOR_0"] = bytes;
  primitives[1]["attributes"]["COLOR_0"] = floats;
  const Scene s = loaded(b);
  const std::vector<Vec4f>& colors = s.meshes[0].colors;
  ASSERT_EQ(colors.size(), 12u);
  EXPECT_EQ(colors[0], Vec4f(1.0f, 0.2f, 0.0f, 1.0f));
  EXPECT_EQ(colors[3], Vec4f(0.4f, 0.0f, 1.0f, 1.0f));
  EXPECT_EQ(colors[4], Vec4f(0.5f, 1.0f, 0.0f, 0.25f)) << "kept within [0, 1]";
  EXPECT_EQ(colors[5], Vec4f(1.0f)) << "not finite";
  EXPECT_EQ(colors[8], Vec4f(1.0f)) << "a primitive without colours";
  EXPECT_TRUE(has_note(s, "1 normals, texture coordinates or colours are not finite"));
  const World world = make_world(s);
  ASSERT_EQ(world.vertex_count(), colors.size());
  for (std::uint32_t v = 0; v < world.vertex_count(); ++v) EXPECT_EQ(world.color(v), colors[v]);
  EXPECT_FALSE(make_world(loaded(simple())).has_colors());
  primitives[0]["attributes"]["COLOR_0"] = 0;
  EXPECT_EQ(loaded(b).meshes[0].colors.size(), 12u) << "positions serve as colours: VEC3 of floats";
}

TEST_F(Gltf, EmissiveTextures) {
  const auto png = encode_png(Rgb8Image({2, 2}));
  ASSERT_TRUE(png);
  Builder b = simple();
  b.json["images"] = Json::array({{{"uri", "data:image/png;base64," + base64(*png)}}});
  b.json["textures"] = Json::array({{{"source", 0}}, {{"source", 0}}});
  const Json transform{{"KHR_texture_transform", {{"offset", {0.5, 0.25}}}}};
  b.json["materials"] =
      Json::array({{{"name", "screen"},
                    {"emissiveFactor", {1, 0.5, 0}},
                    {"emissiveTexture", {{"index", 1}, {"texCoord", 1}, {"extensions", transform}}},
                    {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}}});
  b.json["meshes"][0]["primitives"][0]["material"] = 0;
  const int uvs = b.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 1, 1}, 5126, "VEC2", 2);
  b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = uvs;
  const Scene s = loaded(b);
  const Material m = material_of(s);
  EXPECT_EQ(m.emission, Vec3f(4, 2, 0));
  ASSERT_LT(m.emission_texture, s.textures.size());
  EXPECT_EQ(m.emission_transform.offset, Vec2(0.5, 0.25));
  EXPECT_EQ(s.meshes[0].uvs[3], Vec2f(1.0f)) << "the second set is the only one in use";
  b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  const Scene two_sets = loaded(b);
  EXPECT_EQ(material_of(two_sets).emission, Vec3f(0.0f));
  EXPECT_TRUE(has_note(two_sets, "Emissive textures with other texture coordinates than the base colour's"));
  b.json["materials"][0]["emissiveTexture"].erase("texCoord");
  EXPECT_EQ(material_of(loaded(b)).emission, Vec3f(4, 2, 0));
}

TEST_F(Gltf, SpecularGlossiness) {
  Builder b = simple();
  b.json["materials"] = Json::array({{{"extensions",
                                       {{"KHR_materials_pbrSpecularGlossiness",
                                         {{"diffuseFactor", {0.5, 0.25, 1, 1}},
                                          {"specularFactor", {0.1, 0.2, 0.3}},
                                          {"glossinessFactor", 0.5}}}}}}});
  b.json["meshes"][0]["primitives"][0]["material"] = 0;
  const Material m = material_of(loaded(b));
  EXPECT_EQ(m.diffuse, Vec3f(0.5f, 0.25f, 1.0f));
  EXPECT_EQ(m.specular, Vec3f(0.1f, 0.2f, 0.3f));
  EXPECT_NEAR(m.shininess, 30.0f, 1e-4f);  // 2 / 0.25^2 - 2
}

// They are times the diffuse colour, and a metal's is black.
TEST_F(Gltf, VertexColoursOfMetalsAreSaidToBeUnused) {
  Builder b = simple();
  const int colours = b.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, 5126, "VEC3", 3);
  Json& primitive = b.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["COLOR_0"] = colours;
  primitive["material"] = 0;
  b.json["materials"] =
      Json::array({{{"name", "brass"}, {"pbrMetallicRoughness", {{"metallicFactor", 1.0}}}}});
  EXPECT_TRUE(has_note(loaded(b), "The vertices' colours of metals are not used (material brass)."));
  b.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 0.0;
  EXPECT_FALSE(has_note(loaded(b), "metals"));
}

TEST_F(Gltf, SingleSidedMaterialsAreSaid) {
  Builder b = simple();
  b.json["materials"] =
      Json::array({{{"name", "a"}}, {{"name", "b"}, {"doubleSided", true}}, {{"name", "c"}}});
  const Scene s = loaded(b);
  EXPECT_TRUE(has_note(s,
                       "Single-sided materials (2 of 3): the eye looks through their backs; both sides cast "
                       "shadows."));
  EXPECT_FALSE(shows_back(s.materials[0]));
  EXPECT_TRUE(shows_back(s.materials[1]));
  EXPECT_FALSE(shows_back(s.materials[3])) << "nor has what has no material (glTF 2.0, section 3.9.6)";
  for (Json& material : b.json["materials"]) material["doubleSided"] = true;
  EXPECT_FALSE(has_note(loaded(b), "Single-sided"));
}

// As for OBJ: said, and the plain factors take its place.
TEST_F(Gltf, Ktx2IsNoted) {
  Builder b = simple();
  folder_.put("wall.ktx2", "\xabKTX 20\xbb\r\n\x1a\n" + std::string(80, '\0'));
  b.json["images"] = Json::array({{{"uri", "wall.ktx2"}}});
  b.json["textures"] = Json::array({{{"source", 0}}});
  b.json["materials"] =
      Json::array({{{"name", "wall"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
  b.json["meshes"][0]["primitives"][0]["material"] = 0;
  EXPECT_TRUE(
      has_note(loaded(b),
               "Material 'wall': the texture is in KTX 2, which is not decoded; its plain colour is used."));
}

TEST_F(Gltf, MissingImageFilesAreNoted) {
  Builder b = simple();
  b.json["images"] = Json::array({{{"uri", "nowhere.png"}}});
  b.json["textures"] = Json::array({{{"source", 0}}});
  b.json["materials"] = Json::array({{{"name", "wall"},
                                      {"pbrMetallicRoughness",
                                       {{"baseColorFactor", {0.5, 0.25, 0.125, 1}},
                                        {"metallicFactor", 0.0},
                                        {"baseColorTexture", {{"index", 0}}},
                                        {"metallicRoughnessTexture", {{"index", 0}}}}}}});
  b.json["meshes"][0]["primitives"][0]["material"] = 0;
  const Scene s = loaded(b);
  EXPECT_TRUE(
      has_note(s, "Material 'wall': the texture nowhere.png is not there; its plain colour is used."));
  EXPECT_EQ(std::count_if(s.notes.begin(), s.notes.end(),
                          [](const std::string& n) { return n.find("nowhere.png") != n.npos; }),
            1);
  EXPECT_TRUE(s.textures.empty());
  EXPECT_EQ(s.materials[0].diffuse, Vec3f(0.5f, 0.25f, 0.125f));
}

}  // namespace
}  // namespace gnomon::gltf_test
