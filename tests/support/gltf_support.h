// glTF and GLB files under construction, and the fixture that loads them.
#pragma once

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "scene/load.h"
#include "tests/support/scene_files_support.h"

namespace gnomon::gltf_test {

using Json = nlohmann::json;

inline std::string base64(std::string_view bytes) {
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

inline const std::vector<float> four{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

// One node with one mesh of one primitive.
inline Builder simple(int mode = 4, bool indexed = true) {
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

inline bool has_note(const Scene& scene, std::string_view part) {
  return std::any_of(scene.notes.begin(), scene.notes.end(),
                     [&](const std::string& n) { return n.find(part) != std::string::npos; });
}

}  // namespace gnomon::gltf_test
