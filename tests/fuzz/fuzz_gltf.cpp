// glTF as text with its buffer inside, and as GLB: the first byte says which.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const bool container = size > 0 && data[0] == 'g';
  gnomon::fuzz::load_as(container ? ".glb" : ".gltf", data, size);
  return 0;
}

namespace {

// One triangle: three float3 positions and three 16-bit indices, padded to 44 bytes.
constexpr const char* buffer_base64 = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIAAAA=";

// A picture of one pixel.
constexpr const char* pixel_base64 =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";

std::string scene_text(const std::string& buffer) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],)"
         R"("nodes":[{"mesh":0,"rotation":[0,0,0,1],"scale":[1,2,1],"children":[2]},)"
         R"({"camera":0,"translation":[0,0,5]},{"extensions":{"KHR_lights_punctual":{"light":0}}}],)"
         R"("cameras":[{"type":"perspective","perspective":{"yfov":0.8,"znear":0.1}}],)"
         R"("extensionsUsed":["KHR_lights_punctual"],)"
         R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":3,)"
         R"("spot":{"innerConeAngle":0.1,"outerConeAngle":0.5}}]}},)"
         R"("materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.6,0.7,1],"roughnessFactor":0.4}},)"
         R"({"doubleSided":true,"emissiveFactor":[1,0.5,0],"emissiveTexture":{"index":0,"texCoord":1,)"
         R"("extensions":{"KHR_texture_transform":{"offset":[0.5,1],"scale":[2,3],"rotation":0.5}}},)"
         R"("extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4}}},)"
         R"({"alphaMode":"MASK","extensions":{"KHR_materials_unlit":{}}}],)"
         R"("textures":[{"source":0}],"images":[{"uri":"data:image/png;base64,)" +
         std::string(pixel_base64) + R"("}],)" +
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0},)"
         R"({"attributes":{"POSITION":0,"COLOR_0":0},"material":1},)"
         R"({"attributes":{"POSITION":0,"COLOR_0":2},"material":2}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
         R"("min":[0,0,0],"max":[1,1,0]},{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},)"
         R"({"bufferView":0,"componentType":5121,"normalized":true,"count":3,"type":"VEC4"}],)"
         R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},)"
         R"({"buffer":0,"byteOffset":36,"byteLength":6}],"buffers":[)" +
         buffer + "]}";
}

void append(std::string& bytes, std::uint32_t word) {
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(word >> 8 * i);
}

std::string container(std::string text, std::string data) {
  while (text.size() % 4 != 0) text += ' ';
  while (data.size() % 4 != 0) data += '\0';
  std::string bytes = "glTF";
  append(bytes, 2);
  append(bytes, static_cast<std::uint32_t>(28 + text.size() + data.size()));
  append(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += "JSON" + text;
  append(bytes, static_cast<std::uint32_t>(data.size()));
  return bytes + std::string("BIN\0", 4) + data;
}

std::string plain_container() {
  std::string data(44, '\0');
  data[14] = '\x80', data[15] = '\x3f', data[26] = '\x80', data[27] = '\x3f', data[38] = 1, data[40] = 2;
  return container(scene_text(R"({"byteLength":44})"), data);
}

constexpr float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5f};
constexpr unsigned int indices[] = {0, 1, 2, 2, 1, 3};

std::string meshopt_positions() {
  std::string out(meshopt_encodeVertexBufferBound(4, 12), '\0');
  auto* bytes = reinterpret_cast<unsigned char*>(out.data());
  out.resize(meshopt_encodeVertexBuffer(bytes, out.size(), corners, 4, 12));
  return out;
}

std::string meshopt_indices() {
  std::string out(meshopt_encodeIndexBufferBound(6, 4), '\0');
  auto* bytes = reinterpret_cast<unsigned char*>(out.data());
  out.resize(meshopt_encodeIndexBuffer(bytes, out.size(), indices, 6));
  return out;
}

std::string draco_mesh(int speed) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const auto corner = [](std::size_t i) { return corners + std::size_t{3} * indices[i]; };
  builder.SetAttributeValuesForFace(position, draco::FaceIndex(0), corner(0), corner(1), corner(2));
  builder.SetAttributeValuesForFace(position, draco::FaceIndex(1), corner(3), corner(4), corner(5));
  draco::Encoder encoder;
  encoder.SetSpeedOptions(speed, speed);
  draco::EncoderBuffer out;
  if (!encoder.EncodeMeshToBuffer(*builder.Finalize(), &out).ok())
    gnomon::fuzz::broken("Draco does not pack");
  return {out.data(), out.size()};
}

// Two meshes, one by meshoptimizer and one by Draco, with a morph target, a skin and instances.
std::string packed_container(int speed) {
  const std::string parts[] = {meshopt_positions(), meshopt_indices(), draco_mesh(speed)};
  std::string data, views;
  for (const std::string& part : parts) {
    const std::string place = "\"buffer\":0,\"byteOffset\":" + std::to_string(data.size()) +
                              ",\"byteLength\":" + std::to_string(part.size());
    if (&part == &parts[0])
      views =
          R"({"buffer":1,"byteLength":48,"extensions":{"EXT_meshopt_compression":{"byteStride":12,"count":4,)"
          R"("mode":"ATTRIBUTES",)" +
          place + "}}},";
    else if (&part == &parts[1])
      views += R"({"buffer":1,"byteOffset":48,"byteLength":24,"extensions":{"EXT_meshopt_compression":)"
               R"({"byteStride":4,"count":6,"mode":"TRIANGLES",)" +
               place + "}}},";
    else
      views += "{" + place + "}";
    data += part;
    while (data.size() % 4 != 0) data += '\0';
  }
  return container(
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1,2]}],"nodes":[{"mesh":0,"skin":0,"weights":[0.5]},)"
      R"({"mesh":1,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}},{}],)"
      R"("skins":[{"joints":[2]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":4,"WEIGHTS_0":4},)"
      R"("indices":1,"targets":[{"POSITION":0}]}]},{"primitives":[{"attributes":{"POSITION":2},"indices":3,)"
      R"("extensions":{"KHR_draco_mesh_compression":{"bufferView":2,"attributes":{"POSITION":0}}}}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
      R"({"bufferView":1,"componentType":5125,"count":6,"type":"SCALAR"},)"
      R"({"componentType":5126,"count":4,"type":"VEC3"},{"componentType":5125,"count":6,"type":"SCALAR"},)"
      R"({"componentType":5126,"count":4,"type":"VEC4","sparse":{"count":1,"indices":{"bufferView":1,)"
      R"("byteOffset":4,"componentType":5125},"values":{"bufferView":0,"byteOffset":8}}}],"bufferViews":[)" +
          views + R"(],"buffers":[{"byteLength":)" + std::to_string(data.size()) +
          R"(},{"byteLength":72,"extensions":{"EXT_meshopt_compression":{"fallback":true}}}]})",
      data);
}

}  // namespace

std::vector<std::string> gnomon::fuzz::seeds() {
  const std::string uri = R"({"byteLength":44,"uri":"data:application/octet-stream;base64,)";
  return {scene_text(uri + buffer_base64 + "\"}"), plain_container(), packed_container(5),
          packed_container(10)};
}
