// glTF as text with its buffer inside, and as GLB: the first byte says which.
#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const bool container = size > 0 && data[0] == 'g';
  gnomon::fuzz::load_as(container ? ".glb" : ".gltf", data, size);
  return 0;
}

namespace {

// One triangle: three float3 positions and three 16-bit indices, padded to 44 bytes.
constexpr const char* buffer_base64 = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIAAAA=";

std::string scene_text(const std::string& buffer) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],)"
         R"("nodes":[{"mesh":0,"rotation":[0,0,0,1],"scale":[1,2,1],"children":[2]},)"
         R"({"camera":0,"translation":[0,0,5]},{"extensions":{"KHR_lights_punctual":{"light":0}}}],)"
         R"("cameras":[{"type":"perspective","perspective":{"yfov":0.8,"znear":0.1}}],)"
         R"("extensionsUsed":["KHR_lights_punctual"],)"
         R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":3,)"
         R"("spot":{"innerConeAngle":0.1,"outerConeAngle":0.5}}]}},)"
         R"("materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.6,0.7,1],"roughnessFactor":0.4}}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
         R"("min":[0,0,0],"max":[1,1,0]},{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],)"
         R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},)"
         R"({"buffer":0,"byteOffset":36,"byteLength":6}],"buffers":[)" +
         buffer + "]}";
}

void append(std::string& bytes, std::uint32_t word) {
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(word >> 8 * i);
}

std::string container() {
  std::string text = scene_text(R"({"byteLength":44})");
  while (text.size() % 4 != 0) text += ' ';
  std::string data(44, '\0');
  data[14] = '\x80', data[15] = '\x3f', data[26] = '\x80', data[27] = '\x3f', data[38] = 1, data[40] = 2;
  std::string bytes = "glTF";
  append(bytes, 2);
  append(bytes, static_cast<std::uint32_t>(28 + text.size() + data.size()));
  append(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += "JSON" + text;
  append(bytes, static_cast<std::uint32_t>(data.size()));
  return bytes + std::string("BIN\0", 4) + data;
}

}  // namespace

std::vector<std::string> gnomon::fuzz::seeds() {
  const std::string uri = R"({"byteLength":44,"uri":"data:application/octet-stream;base64,)";
  return {scene_text(uri + buffer_base64 + "\"}"), container()};
}
