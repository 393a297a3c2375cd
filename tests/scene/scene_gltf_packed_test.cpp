// glTF files whose geometry or pictures are packed: what comes out is what was packed.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <cmath>

#include "scene/files/pictures/image_io.h"
#include "tests/support/gltf_support.h"

namespace gnomon::gltf_test {
namespace {

std::string as_text(const std::vector<unsigned char>& bytes) {
  return {bytes.begin(), bytes.end()};
}

// Whole numbers: 16 bits and floats hold them alike.
std::vector<float> hilly(int side) {
  std::vector<float> out;
  for (int y = 0; y <= side; ++y)
    for (int x = 0; x <= side; ++x)
      out.insert(out.end(), {static_cast<float>(x), static_cast<float>((x * y) % 5), static_cast<float>(y)});
  return out;
}

std::vector<std::uint32_t> grid_indices(int side) {
  std::vector<std::uint32_t> out;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const auto at = static_cast<std::uint32_t>(y * (side + 1) + x),
                 below = at + static_cast<std::uint32_t>(side) + 1;
      for (const std::uint32_t i : {at, below, at + 1, at + 1, below, below + 1}) out.push_back(i);
    }
  return out;
}

constexpr int side = 12;

Builder plain_hills() {
  Builder b;
  const auto positions = hilly(side);
  const auto indices = grid_indices(side);
  const int at = b.positions(positions);
  const int by = b.accessor(indices, 5125, "SCALAR", 1);
  b.json["meshes"] =
      Json::array({{{"primitives", Json::array({{{"attributes", {{"POSITION", at}}}, {"indices", by}}})}}});
  b.json["nodes"] = Json::array({{{"mesh", 0}}});
  b.json["scenes"] = Json::array({{{"nodes", {0}}}});
  return b;
}

// A view of the packed bytes in buffer 1, over a fallback buffer 0 without data.
void pack_view(Builder& b, std::size_t view, const std::vector<unsigned char>& packed, std::string& buffer,
               const Json& how) {
  Json& extension = b.json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"];
  extension = how;
  extension["buffer"] = 1;
  extension["byteOffset"] = buffer.size();
  extension["byteLength"] = packed.size();
  buffer += as_text(packed);
  while (buffer.size() % 4 != 0) buffer += '\0';
}

Json two_buffers(std::size_t fallback, const std::string& packed) {
  return Json::array(
      {{{"byteLength", fallback}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}},
       {{"byteLength", packed.size()}, {"uri", "data:application/octet-stream;base64," + base64(packed)}}});
}

Builder meshopt_hills(std::string& packed) {
  Builder b = plain_hills();
  const auto positions = hilly(side);
  const auto indices = grid_indices(side);
  const std::size_t vertices = positions.size() / 3;
  std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(vertices, 12));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), positions.data(), vertices, 12));
  pack_view(b, 0, out, packed,
            {{"byteStride", 12}, {"count", vertices}, {"mode", "ATTRIBUTES"}, {"filter", "NONE"}});
  meshopt_encodeIndexVersion(1);
  out.assign(meshopt_encodeIndexBufferBound(indices.size(), vertices), 0);
  out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), indices.size()));
  pack_view(b, 1, out, packed, {{"byteStride", 4}, {"count", indices.size()}, {"mode", "TRIANGLES"}});
  b.json["extensionsUsed"] = {"EXT_meshopt_compression"};
  b.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  return b;
}

std::string with_buffers(Builder& b, const std::string& packed) {
  b.text();
  b.json["buffers"] = two_buffers(b.buffer.size(), packed);
  return b.json.dump();
}

// Triangles by their corners' positions, each begun at its least corner: packing may turn them and sort them.
std::vector<std::array<std::array<double, 3>, 3>> corner_list(const Mesh& mesh) {
  std::vector<std::array<std::array<double, 3>, 3>> out;
  for (const auto& t : mesh.triangles) {
    std::array<std::array<double, 3>, 3> corners{};
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& p = mesh.positions[t[c]];
      corners[c] = {p.x, p.y, p.z};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    out.push_back(corners);
  }
  std::sort(out.begin(), out.end());
  return out;
}

TEST_F(Gltf, MeshoptIsUnpacked) {
  const Scene plain = loaded(plain_hills());
  std::string packed;
  Builder b = meshopt_hills(packed);
  const auto scene = load(with_buffers(b, packed));
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->meshes[0].positions, plain.meshes[0].positions);
  EXPECT_EQ(corner_list(scene->meshes[0]), corner_list(plain.meshes[0]));
  EXPECT_EQ(scene->meshes[0].triangles.size(), std::size_t{2} * side * side);
}

TEST_F(Gltf, MeshoptHasAKhronosNameToo) {
  std::string packed;
  Builder b = meshopt_hills(packed);
  std::string text = with_buffers(b, packed);
  for (std::size_t at = text.find("EXT_meshopt"); at != std::string::npos; at = text.find("EXT_meshopt", at))
    text.replace(at, 3, "KHR");
  const auto scene = load(text);
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->meshes[0].triangles.size(), std::size_t{2} * side * side);
}

TEST_F(Gltf, MeshoptFiltersAreUndone) {
  Builder b = simple();
  const std::vector<float> normals{0, 0, 1, 0, 0.6f, 0, 0.8f, 0, 0, 1, 0, 0, -0.6f, 0, -0.8f, 0};
  std::vector<std::int8_t> octahedral(16);
  meshopt_encodeFilterOct(octahedral.data(), 4, 4, 8, normals.data());
  const int accessor = b.accessor(std::vector<std::int8_t>(16), 5120, "VEC3", 4);
  b.json["accessors"][static_cast<std::size_t>(accessor)]["normalized"] = true;
  const auto view = b.json["accessors"][static_cast<std::size_t>(accessor)]["bufferView"].get<std::size_t>();
  b.json["bufferViews"][view]["byteStride"] = 4;
  b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = accessor;
  std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(4, 4));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), octahedral.data(), 4, 4));
  std::string packed;
  pack_view(b, view, out, packed,
            {{"byteStride", 4}, {"count", 4}, {"mode", "ATTRIBUTES"}, {"filter", "OCTAHEDRAL"}});
  b.text();
  b.json["buffers"].push_back(
      {{"byteLength", packed.size()}, {"uri", "data:application/octet-stream;base64," + base64(packed)}});
  const auto scene = load(b.json.dump());
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(scene->meshes[0].normals.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    for (int c = 0; c < 3; ++c)  // 8 bits on the octahedron: half a step of 1/127, and as much in rounding
      EXPECT_NEAR(scene->meshes[0].normals[i][c], normals[4 * i + static_cast<std::size_t>(c)], 0.01f) << i;
}

TEST_F(Gltf, DamagedMeshoptHasItsPath) {
  const auto message = [&](auto&& change) {
    std::string packed;
    Builder b = meshopt_hills(packed);
    change(b.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"], b.json["bufferViews"][0],
           packed);
    return error(with_buffers(b, packed));
  };
  const std::string path = "bufferViews[0].extensions.EXT_meshopt_compression: ";
  EXPECT_EQ(message([](Json&, Json&, std::string& bytes) { bytes[0] = 0; }),
            path + "the packed data is damaged");
  EXPECT_EQ(message([](Json& e, Json&, std::string&) { e["mode"] = "ALL"; }),
            path + "mode is missing or unknown (allowed ATTRIBUTES, TRIANGLES, INDICES)");
  EXPECT_EQ(message([](Json& e, Json&, std::string&) { e["byteStride"] = 6; }),
            path + "byteStride (got 6, allowed multiples of 4 from 4 to 256)");
  EXPECT_EQ(
      message([](Json& e, Json&, std::string&) { e["byteLength"] = 1000000; }).substr(0, path.size() + 23),
      path + "reaches past its buffer");
  EXPECT_EQ(message([](Json& e, Json&, std::string&) { e["buffer"] = 7; }),
            path + "there is no such buffer (allowed 0 to 2)");
  EXPECT_EQ(message([](Json& e, Json&, std::string&) { e["count"] = 5; }),
            path + "count times byteStride is not the view's byteLength (got 60, allowed 2028)");
}

// What would not fit in memory is refused for what it claims.
TEST_F(Gltf, ClaimsOfPackedDataAreBounded) {
  std::string packed;
  Builder b = meshopt_hills(packed);
  Json& view = b.json["bufferViews"][0];
  b.text();
  b.json["buffers"] = two_buffers(std::size_t{12} << 32, packed);
  view["byteLength"] = std::size_t{12} << 32;
  view["extensions"]["EXT_meshopt_compression"]["count"] = std::size_t{1} << 32;
  EXPECT_NE(error(b.json.dump()).find("bytes cannot hold 51539607552"), std::string::npos);
}

draco::EncoderBuffer encoded(const std::vector<float>& positions, const std::vector<std::uint32_t>& indices,
                             int speed) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(indices.size() / 3));
  const int attribute = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const auto corner = [&](std::size_t i) { return &positions[std::size_t{3} * indices[i]]; };
  for (std::size_t f = 0; f < indices.size() / 3; ++f)
    builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(static_cast<std::uint32_t>(f)),
                                      corner(3 * f), corner(3 * f + 1), corner(3 * f + 2));
  draco::Encoder encoder;
  encoder.SetSpeedOptions(speed, speed);  // 10: triangles one after the other; less: edge breaker
  draco::EncoderBuffer out;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*builder.Finalize(), &out).ok());
  return out;
}

Builder draco_hills(int speed) {
  Builder b = plain_hills();
  const draco::EncoderBuffer packed = encoded(hilly(side), grid_indices(side), speed);
  b.buffer.clear();
  b.json.erase("bufferViews");
  const int view = b.view(std::vector<char>(packed.data(), packed.data() + packed.size()));
  for (Json& accessor : b.json["accessors"]) accessor.erase("bufferView");
  b.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view}, {"attributes", {{"POSITION", 0}}}};
  b.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  b.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return b;
}

TEST_F(Gltf, DracoIsUnpacked) {
  const Scene plain = loaded(plain_hills());
  for (const int speed : {0, 5, 10}) {
    const Scene scene = loaded(draco_hills(speed));
    ASSERT_EQ(scene.meshes.size(), 1u) << speed;
    EXPECT_EQ(corner_list(scene.meshes[0]), corner_list(plain.meshes[0])) << speed;
  }
}

// Without a need for the extension, what lies there unpacked is taken, and the packed data is not looked at.
TEST_F(Gltf, DracosFallbackIsTaken) {
  Builder b = plain_hills();
  b.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  b.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
  EXPECT_EQ(corner_list(loaded(b).meshes[0]), corner_list(loaded(plain_hills()).meshes[0]));
  b.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  EXPECT_EQ(error(b.text()),
            "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression: the Draco header is damaged");
}

TEST_F(Gltf, DamagedDracoIsAnErrorOrAScene) {
  for (const int speed : {5, 10}) {
    const Builder whole = draco_hills(speed);
    for (std::size_t i = 0; i < whole.buffer.size(); i += 3) {
      Builder b = whole;
      b.buffer[i] = static_cast<char>(b.buffer[i] ^ 0x55);
      load(b.text());
    }
    Builder b = whole;
    // Flags of no metadata, the edge breaker's kind, then the number of triangles or vertices: 2^31 and more.
    b.buffer.replace(speed == 10 ? 11 : 12, 5, "\xff\xff\xff\xff\x0f");
    EXPECT_NE(error(b.text()).find("bytes of Draco data cannot hold"), std::string::npos) << speed;
  }
}

// 4 x 4 pixels of (255, 128, 0), 76 bytes.
constexpr const char* orange_webp =
    "UklGRkQAAABXRUJQVlA4IDgAAABQAgCdASoEAAQAAAAAJaACdLoB+AH6AfwAB5AA/vunq//vEagO3qN/+8Rv/9GfOG0SI//"
    "0XYAAAA==";

Builder textured(const Json& texture, const std::string& uri) {
  Builder b = simple();
  b.json["images"] = Json::array({{{"uri", uri}}});
  b.json["textures"] = Json::array({texture});
  b.json["materials"] =
      Json::array({{{"name", "m"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
  b.json["meshes"][0]["primitives"][0]["material"] = 0;
  return b;
}

TEST_F(Gltf, WebpTexturesAreRead) {
  Builder b = textured({{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}},
                       std::string("data:image/webp;base64,") + orange_webp);
  b.json["extensionsRequired"] = {"EXT_texture_webp"};
  const Scene scene = loaded(b);
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.textures[0].texels[5], glm::u8vec4(255, 128, 0, 255));
  // The plain image comes first; where its file is not there, the other is taken.
  b.json["images"].push_back({{"uri", "nowhere.png"}});
  b.json["textures"][0]["source"] = 1;
  EXPECT_EQ(loaded(b).textures.size(), 1u);
}

TEST_F(Gltf, BasisIsSaidNotToBeRead) {
  Builder b = textured({{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}, "a.ktx2");
  b.json["extensionsRequired"] = {"KHR_texture_basisu"};
  const Scene scene = loaded(b);
  EXPECT_TRUE(scene.textures.empty());
  EXPECT_TRUE(
      has_note(scene,
               "Material 'm': the texture is in Basis Universal alone, which is not decoded; its plain "
               "colour is used."));
  // The image for those who do not know the extension.
  b.json["images"].push_back({{"uri", std::string("data:image/webp;base64,") + orange_webp}});
  b.json["textures"][0]["source"] = 1;
  EXPECT_EQ(loaded(b).textures.size(), 1u);
}

}  // namespace
}  // namespace gnomon::gltf_test
