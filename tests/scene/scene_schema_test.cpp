// The published schema and the loader agree: an unknown key's error lists exactly the keys that the schema
// has.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "scene/files/formats.h"
#include "tests/support/places.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

nlohmann::json schema() {
  return nlohmann::json::parse(test::bytes_of(gnomon::test::source_dir() + "/scene/files/scene.schema.json"));
}

std::vector<std::string> schema_keys(const nlohmann::json& object) {
  std::vector<std::string> keys;
  for (const auto& entry : object.at("properties").items()) keys.push_back(entry.key());
  std::sort(keys.begin(), keys.end());
  return keys;
}

// The keys of "unknown key (got "zzz", allowed a, b, c)".
std::vector<std::string> loader_keys(const std::string& scene) {
  const auto loaded = load_json_scene(scene, "s.json", ".", {});
  if (loaded) return {"it loaded"};
  const std::string& reason = loaded.error().reason;
  const std::size_t begin = reason.find(", allowed ");
  const std::size_t end = reason.rfind(')');
  if (reason.find("unknown key") != 0 || begin == std::string::npos) return {reason};
  std::istringstream list(reason.substr(begin + 10, end - begin - 10));
  std::vector<std::string> keys;
  for (std::string key; std::getline(list, key, ',');) keys.push_back(key.substr(key.find_first_not_of(' ')));
  std::sort(keys.begin(), keys.end());
  return keys;
}

std::string scene_with_part(const std::string& part) {
  return R"({"schema": "gnomon/scene/1", )" + part + "}";
}

TEST(Schema, ListsTheLoadersKeys) {
  const nlohmann::json all = schema();
  const nlohmann::json& defs = all.at("$defs");
  EXPECT_EQ(loader_keys(scene_with_part(R"("zzz": 1)")), schema_keys(all));
  EXPECT_EQ(loader_keys(scene_with_part(R"("camera": {"zzz": 1}, "materials": [{"name": "m"}],
    "shapes": [{"sphere": {"center": [0,0,0], "radius": 1}, "material": "m"}])")),
            schema_keys(defs.at("camera")));
  EXPECT_EQ(loader_keys(scene_with_part(R"("lights": [{"zzz": 1}])")), schema_keys(defs.at("light")));
  EXPECT_EQ(loader_keys(scene_with_part(R"("materials": [{"zzz": 1}])")), schema_keys(defs.at("material")));
  EXPECT_EQ(loader_keys(scene_with_part(R"("materials": [{"name": "m", "texture": {"zzz": 1}}])")),
            schema_keys(defs.at("texture")));
  EXPECT_EQ(loader_keys(scene_with_part(R"("meshes": [{"zzz": 1}])")), schema_keys(defs.at("mesh")));
  EXPECT_EQ(loader_keys(scene_with_part(R"("instances": [{"zzz": 1}])")), schema_keys(defs.at("instance")));
  EXPECT_EQ(loader_keys(scene_with_part(R"("materials": [{"name": "m"}],
    "meshes": [{"name": "t", "vertices": [[0,0,0], [1,0,0], [0,1,0]], "triangles": [[0,1,2]]}],
    "instances": [{"mesh": "t", "material": "m", "repeat": {"zzz": 1}}])")),
            schema_keys(defs.at("instance").at("properties").at("repeat")));
  EXPECT_EQ(loader_keys(scene_with_part(R"("shapes": [{"zzz": 1}])")), schema_keys(defs.at("shape")));
  const nlohmann::json& shapes = defs.at("shape").at("properties");
  EXPECT_EQ(loader_keys(scene_with_part(R"("shapes": [{"sphere": {"zzz": 1}}])")),
            schema_keys(shapes.at("sphere")));
  EXPECT_EQ(loader_keys(scene_with_part(R"("shapes": [{"plane": {"zzz": 1}}])")),
            schema_keys(shapes.at("plane")));
  for (const std::string kind :
       {"ellipsoid", "cylinder", "cone", "paraboloid", "hyperboloid", "torus", "implicit"})
    EXPECT_EQ(loader_keys(scene_with_part(R"("shapes": [{")" + kind + R"(": {"zzz": 1}}])")),
              schema_keys(shapes.at(kind)))
        << kind;
  EXPECT_EQ(loader_keys(scene_with_part(
                R"("meshes": [{"name": "t", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,2]]}],
    "instances": [{"mesh": "t", "rotate": {"zzz": 1}}])")),
            schema_keys(defs.at("rotation")));
}

// Ranges too: just outside what the schema says of a material's number is an error, the limit itself is not.
TEST(Schema, NumbersHaveTheLoadersRanges) {
  const nlohmann::json materials = schema().at("$defs").at("material").at("properties");
  int checked = 0;
  for (const auto& [key, rule] : materials.items()) {
    if (rule.value("type", "") != "number") continue;
    const auto loads = [name = key](double value) {
      const nlohmann::json scene{
          {"schema", "gnomon/scene/1"},
          {"materials", {{{"name", "m"}, {name, value}}}},
          {"shapes", {{{"sphere", {{"center", {0, 0, 0}}, {"radius", 1}}}, {"material", "m"}}}}};
      return load_json_scene(scene.dump(), "s.json", ".", {}).has_value();
    };
    const double low = rule.at("minimum").get<double>();
    const double high = rule.at("maximum").get<double>();
    EXPECT_TRUE(loads(low)) << key;
    EXPECT_TRUE(loads(high)) << key;
    EXPECT_FALSE(loads(low - 1e-6)) << key;
    EXPECT_FALSE(loads(high + 1e-6)) << key;
    ++checked;
  }
  EXPECT_EQ(checked, 7);
}

}  // namespace
}  // namespace gnomon
