// What capture.json may say, to the published schema and to its reader: each takes what the other takes, and what is refused is
// named with its line, its column and the key that says it.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "judge/capture.h"
#include "scene/files/write_file.h"
#include "tests/support/json_schema_check.h"
#include "tests/support/places.h"

namespace gnomon::test {
namespace {

using judge::Capture;

std::string schema_folder() {
  const std::string path = testing::TempDir() + "/gnomon-capture-schema";
  std::filesystem::create_directories(path);
  return path;
}

/// What the published schema and the reader say of a capture's text: whether each takes it.
std::pair<bool, bool> taken(const nlohmann::json& capture) {
  const std::string file = schema_folder() + "/schema.json";
  EXPECT_TRUE(write_file(file, capture.dump()));
  const auto read = judge::read_capture(file);
  std::ifstream schema(source_dir() + "/judge/capture.schema.json");
  return {SchemaCheck(nlohmann::json::parse(schema)).violations(capture).empty(),
          read && judge::check_capture(*read)};
}

TEST(CaptureSchema, TakesWhatTheReaderTakes) {
  using Json = nlohmann::json;
  const Json plain =
      Json::parse(R"({"schema": "gnomon/capture/1", "renderer": {"name": "x", "settings": {"soft": true,
    "bias": 0.5}}, "scene": "fence", "light": 0, "size": [64, 36], "visibility": "v.exr"})");
  Json whole = plain;
  whole["map"] = Json::array({{{"depth", "z.exr"},
                               {"convention", "reversed"},
                               {"rows", "top_down"},
                               {"clip_from_world", std::vector<double>(16, 1.0)}}});
  whole["bias"] = {{"constant_depth", 0.1}, {"slope", 1}, {"normal_offset_world", 0}};
  whole["filter"] = {{"kind", "pcf"}, {"radius_texels", 2}};
  whole["depth"] = {{"file", "d.exr"}, {"convention", "reversed"}, {"near", 0.1}};
  EXPECT_EQ(taken(plain), std::pair(true, true));
  EXPECT_EQ(taken(whole), std::pair(true, true));
  whole["schema"] = "gnomon/capture/2";
  whole["strength"] = 0.8;
  whole["map"][0]["caster_bias"] = {
      {"constant", 0.001}, {"constant_world", -0.1},      {"slope", 2},
      {"clamp", 0.01},     {"normal_offset_world", 0.02}, {"normal_offset_angle", "sine"}};
  whole["map"][0]["rect"] = {0, 4, 8, 8};
  whole["map"][0]["select"] = {{"near", 1}, {"far", 5.5}, {"by", "distance"}};
  whole["map"][0]["bias"] = {{"constant_depth", 0.1}, {"normal_offset_world", 1}};
  whole["map"][0]["select"]["blend"] = 0;
  whole["map"][0]["bias"].update(
      {{"angle", "tangent"}, {"min", 0}, {"max", 0.5}, {"normal_offset_angle", "sine"}});
  whole["filter"] = {{"kind", "none"}, {"read", "linear_depths"}};
  whole["fade"] = {{"from", 5}, {"to", 6}, {"by", "distance"}};
  whole["also"] = "contact.exr";
  EXPECT_EQ(taken(whole), std::pair(true, true));
  Json linear = whole;
  linear["map"][0].erase("caster_bias");
  linear["map"][0]["convention"] = "linear_z", linear["map"][0]["range"] = {20, 0.1};
  EXPECT_EQ(taken(linear), std::pair(true, true));
  Json moments = whole;
  moments["map"][0]["convention"] = "zero_to_one";
  moments["filter"] = {{"kind", "evsm"},
                       {"read", "moments"},
                       {"exponents", {40, 5}},
                       {"light_bleeding_reduction", 0.2},
                       {"minimum_variance", 0}};
  EXPECT_EQ(taken(moments), std::pair(true, true));
  for (const auto& [kind, key] : {std::pair("vsm", "moment_bias"),
                                  {"evsm", "moment_bias"},
                                  {"esm", "moment_bias"},
                                  {"esm", "minimum_variance"},
                                  {"esm", "light_bleeding_reduction"},
                                  {"msm", "minimum_variance"}}) {
    Json capture = moments;
    capture["filter"] = {{"kind", kind}, {"read", "moments"}, {key, 0.1}};
    if (std::string_view(kind).starts_with("e")) capture["filter"]["exponents"] = {40};
    EXPECT_EQ(taken(capture), std::pair(false, false)) << kind << " " << key;
    capture["filter"].erase(key);
    EXPECT_EQ(taken(capture), std::pair(true, true)) << kind;
  }
  for (const auto& [path, value] : {std::pair<std::string, Json>{"/filter/kind", "pcf"},
                                    {"/filter/read", "nearest"},
                                    {"/filter/exponents", {1, 2, 3}},
                                    {"/filter/exponents/0", 0},
                                    {"/filter/light_bleeding_reduction", 1},
                                    {"/filter/minimum_variance", -1},
                                    {"/filter/moment_bias", 0}}) {
    Json capture = moments;
    capture[Json::json_pointer(path)] = value;
    EXPECT_EQ(taken(capture), std::pair(false, false)) << path << " " << value;
  }
  const std::vector<std::pair<std::string, Json>> wrong{{"/schema", "gnomon/capture/3"},
                                                        {"/renderer/name", ""},
                                                        {"/renderer/settings/soft", Json::array()},
                                                        {"/light", -1},
                                                        {"/size", {64}},
                                                        {"/size/0", 0},
                                                        {"/size/0", 1.5},
                                                        {"/visibility", ""},
                                                        {"/visibility", 1},
                                                        {"/shadowed", "s.exr"},
                                                        {"/position", "p.exr"},
                                                        {"/depth/convention", "linear"},
                                                        {"/depth/near", 0},
                                                        {"/map", Json::array()},
                                                        {"/map/0/rows", "left"},
                                                        {"/map/0/convention", "metres"},
                                                        {"/map/0/face", 1},
                                                        {"/map/0/clip_from_world", {1, 2, 3}},
                                                        {"/bias/normal_offset_world", -1},
                                                        {"/bias/constant", 1},
                                                        {"/filter/kind", "soft"},
                                                        {"/filter/radius_texels", 0},
                                                        {"/filter/radius_texels", 65},
                                                        {"/strength", 0},
                                                        {"/map/0/rect", {0, 0, 8}},
                                                        {"/map/0/rect/0", -1},
                                                        {"/map/0/select/by", "slice"},
                                                        {"/map/0/select/near", -1},
                                                        {"/map/0/bias/constant", 1},
                                                        {"/map/0/select/blend", -1},
                                                        {"/map/0/range", {1}},
                                                        {"/map/0/bias/angle", "cosine"},
                                                        {"/map/0/bias/normal_offset_angle", "tangent"},
                                                        {"/fade/from", -1},
                                                        {"/fade/start", 1},
                                                        {"/also", ""},
                                                        {"/lights", Json::array()},
                                                        {"/filter/read", "cubic"},
                                                        {"/filter/radius_texels", 2},
                                                        {"/strength", 1.5},
                                                        {"/map/0/caster_bias/factor", 1},
                                                        {"/map/0/caster_bias/slope", "steep"},
                                                        {"/colour", 1}};
  for (const auto& [path, value] : wrong) {
    Json capture = whole;
    capture[Json::json_pointer(path)] = value;
    EXPECT_EQ(taken(capture), std::pair(false, false)) << path << " " << value;
  }
  for (const char* path :
       {"/schema", "/renderer", "/scene", "/size", "/visibility", "/map", "/map/0/depth", "/map/0/rows",
        "/map/0/convention", "/map/0/clip_from_world", "/depth/file", "/depth/convention", "/filter/kind"}) {
    const Json capture = whole.patch({{{"op", "remove"}, {"path", path}}});
    EXPECT_EQ(taken(capture), std::pair(false, false)) << path;
  }
}

TEST(CaptureSchema, TakesSeveralLightsThatShareTheRest) {
  using Json = nlohmann::json;
  Json several = Json::parse(R"({"schema": "gnomon/capture/2", "renderer": {"name": "x"}, "scene": "fence",
    "size": [64, 36], "position": "p.exr", "lights": [{"light": "sun", "visibility": "s.exr"},
    {"light": 1, "visibility": "l.exr", "strength": 0.5}, {"light": "lamp", "shadowed": "a.exr", "unshadowed": "b.exr"}]})");
  const std::string file = schema_folder() + "/schema.json";
  std::ifstream schema(source_dir() + "/judge/capture.schema.json");
  SchemaCheck check(Json::parse(schema));
  const auto read_of = [&](const Json& capture) {
    EXPECT_TRUE(write_file(file, capture.dump()));
    return judge::read_captures(file);
  };
  const auto read = read_of(several);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_TRUE(check.violations(several).empty());
  ASSERT_EQ(read->size(), 3U);
  EXPECT_EQ((*read)[1].strength, 0.5);
  EXPECT_FALSE((*read)[2].strength);
  for (const Capture& light : *read) EXPECT_EQ(light.position, schema_folder() + "/p.exr");
  // By name; then by place in the list.
  for (const auto& [said, light] : {std::pair{"lamp", "lamp"}, {"1", "1"}, {"0", "sun"}, {"2", "lamp"}})
    EXPECT_EQ(judge::read_capture(file, said)->light, light) << said;
  EXPECT_NE(judge::read_capture(file).error().message().find(
                "lights: has 3 lights, and one is wanted (allowed sun, 1, lamp)"),
            std::string::npos);
  EXPECT_NE(judge::read_capture(file, "moon").error().message().find("has no such light (got moon"),
            std::string::npos);
  several["lights"][1].erase("visibility");
  const auto lacks = read_of(several);
  ASSERT_TRUE(lacks);
  EXPECT_NE(judge::check_capture((*lacks)[1]).error().message().find("lights[1].visibility: is missing"),
            std::string::npos);
  several["lights"][1]["visibility"] = "l.exr";
  for (const auto& [path, value] :
       std::vector<std::pair<std::string, Json>>{{"/visibility", "v.exr"},
                                                 {"/strength", 0.5},
                                                 {"/light", 0},
                                                 {"/lights/0/position", "p.exr"},
                                                 {"/lights/0/lights", Json::array()}}) {
    Json wrong = several;
    wrong[Json::json_pointer(path)] = value;
    EXPECT_FALSE(read_of(wrong)) << path;
    EXPECT_FALSE(check.violations(wrong).empty()) << path;
  }
  several["lights"][1]["light"] = "sun";
  EXPECT_NE(read_of(several).error().message().find("is of a light that stands before"), std::string::npos);
}

// What version 1 has not is refused by its name, with the version that has it.
TEST(CaptureSchema, OfVersion1HasNoKeysOfVersion2) {
  const std::string file = schema_folder() + "/old.json";
  const std::string head =
      R"({"schema": "gnomon/capture/1", "renderer": {"name": "x"}, "scene": "fence", "size": [64, 36],
 "visibility": "v.exr", )";
  for (
      const std::string key :
      {R"("strength": 0.5})",
       R"("map": [{"depth": "z.exr", "convention": "reversed", "rows": "top_down", "caster_bias": {"slope": 1},
 "clip_from_world": [1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}]})"}) {
    ASSERT_TRUE(write_file(file, head + key));
    const auto read = judge::read_capture(file);
    ASSERT_FALSE(read) << key;
    EXPECT_NE(read.error().message().find("needs \"schema\": \"gnomon/capture/2\""), std::string::npos)
        << read.error().message();
  }
}

TEST(CaptureSchema, UnknownKeysAreRefusedWithLineAndColumn) {
  const std::string file = schema_folder() + "/capture.json";
  ASSERT_TRUE(write_file(file,
                         "{\"schema\": \"gnomon/capture/1\", \"renderer\": {\"name\": \"x\"},\n"
                         " \"scene\": \"fence\", \"size\": [64, 36], \"visibilty\": \"v.exr\"}\n"));
  const auto read = judge::read_capture(file);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message().find(":2:38: visibilty: unknown key"), std::string::npos)
      << read.error().message();
  EXPECT_NE(read.error().message().find("did you mean"), std::string::npos);
  // A word that others have for it: where this format says it.
  const std::pair<const char*, const char*> said[] = {{"cascade_splits", "; `map[].select` says it"},
                                                      {"normalBias", "; `bias.normal_offset_world` says it"},
                                                      {"contact-shadows", "; `also` says it"},
                                                      {"exposure", ", also)"}};
  for (const auto& [key, words] : said) {
    ASSERT_TRUE(
        write_file(file, fmt::format("{{\"schema\": \"gnomon/capture/2\", \"renderer\": {{\"name\": \"x\"}}, "
                                     "\"scene\": \"fence\", \"size\": [64, 36], \"visibility\": \"v.exr\", "
                                     "\"{}\": 1}}",
                                     key)));
    const auto refused = judge::read_capture(file);
    ASSERT_FALSE(refused) << key;
    EXPECT_NE(refused.error().message().find(words), std::string::npos) << refused.error().message();
  }
}

}  // namespace
}  // namespace gnomon::test
