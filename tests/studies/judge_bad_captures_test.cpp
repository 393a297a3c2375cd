// Captures that cannot be judged: one line that names the field, an error of bad input, and no result.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scene/files/pictures/image_io.h"
#include "scene/files/write_file.h"
#include "scene/load.h"
#include "studies/judge/judge.h"
#include "tests/support/json_schema_check.h"
#include "tests/support/places.h"

namespace gnomon::test {
namespace {

using compare::Capture;

constexpr ImageSize picture{64, 36};

std::string folder() {
  const std::string path = testing::TempDir() + "/gnomon-bad-captures";
  std::filesystem::create_directories(path);
  return path;
}

std::string image(const std::string& name, ImageSize size, const std::vector<std::string>& channels,
                  float value = 1.0f) {
  std::vector<Channel> all;
  for (const std::string& channel : channels)
    all.push_back({channel, std::vector<float>(size.pixels(), value)});
  EXPECT_TRUE(write_exr(folder() + "/" + name, size, all));
  return folder() + "/" + name;
}

Capture good() {
  Capture capture;
  capture.renderer = "test";
  capture.scene = "floating-box";
  capture.size = picture;
  capture.visibility = image("good.exr", picture, {"V"});
  return capture;
}

std::string refusal(const Capture& capture) {
  auto scene = load_scene(capture.scene);
  EXPECT_TRUE(scene);
  const World world = make_world(*scene);
  const auto judged = compare::judge_capture(capture, *scene, world, {});
  EXPECT_FALSE(judged);
  if (judged) return "judged";
  EXPECT_EQ(judged.error().kind, ErrorKind::bad_input);
  const std::string message = judged.error().message();
  EXPECT_EQ(message.find('\n'), std::string::npos);
  return message;
}

void expect_named(const Capture& capture, const std::string& words) {
  const std::string message = refusal(capture);
  EXPECT_NE(message.find(words), std::string::npos) << message;
}

compare::CapturedLayer layer(const Mat4& matrix) {
  compare::CapturedLayer out;
  out.depth = image("map.exr", {8, 8}, {"Z"});
  out.convention = compare::StoredDepth::zero_to_one;
  out.rows = compare::RowOrder::top_down;
  out.clip_from_world = matrix;
  return out;
}

/// An EXR with all of its header and none of its pixels.
std::string header_alone(const std::string& name, ImageSize size) {
  const std::string path = image(name, size, {"V"});
  std::filesystem::resize_file(path, 400);
  return path;
}

// What a header says is enough to refuse a picture, and all of them are looked at before any is decoded.
TEST(BadCaptures, AreRefusedByTheirHeaders) {
  Capture capture = good();
  capture.visibility = header_alone("header.exr", {32, 18});
  expect_named(capture, "visibility: is of another size (got 32 x 18, the capture says 64 x 36)");
  capture.visibility = header_alone("fits.exr", picture);
  capture.position = header_alone("position.exr", {16, 9});
  expect_named(capture, "position: is of another size (got 16 x 9, the capture says 64 x 36)");
  capture.position.clear();
  capture.map = {layer(Mat4(1.0))};
  capture.map[0].depth = header_alone("oblong.exr", {8, 4});
  capture.map[0].rect = compare::CapturedRect{4, 0, 4, 5};
  expect_named(capture, "map[0].rect: reaches beyond its picture (got [4, 0, 4, 5], the picture is 8 x 4)");
}

TEST(BadCaptures, OfPicturesNameThePicture) {
  Capture capture = good();
  capture.visibility = folder() + "/none.exr";
  expect_named(capture, "visibility: no such file");
  capture.visibility = image("small.exr", {32, 18}, {"V"});
  expect_named(capture, "visibility: is of another size (got 32 x 18, the capture says 64 x 36)");
  capture.visibility = image("rgb.exr", picture, {"R", "G", "B"});
  expect_named(capture, "visibility: has 3 channels where one is wanted");
  capture.visibility = image("nan.exr", picture, {"V"}, std::numeric_limits<float>::quiet_NaN());
  expect_named(capture, "visibility: 2304 pixels of channel V are not finite");
  capture.visibility = image("wide.exr", picture, {"V"}, 3.0f);
  expect_named(capture, "visibility: values beyond their range");
}

TEST(BadCaptures, OfMapsNameTheField) {
  Capture capture = good();
  capture.map = {layer(Mat4(0.0))};
  expect_named(capture, "map[0].clip_from_world: is singular");
  capture.map = {layer(Mat4(1.0))};
  expect_named(capture, "map[0].clip_from_world: looks along");
  Mat4 sheared(1.0);
  sheared[1][0] = 0.5;
  capture.map = {layer(sheared)};
  expect_named(capture, "map[0].clip_from_world: shears");
  capture.map = {layer(Mat4(1.0))};
  capture.map[0].rows.reset();
  expect_named(capture, "map[0].rows: is missing");
  capture.map.assign(7, layer(Mat4(1.0)));
  expect_named(capture, "map: needs one layer to six");
}

TEST(BadCaptures, ThatContradictNameTheField) {
  Capture capture = good();
  capture.bias = compare::CapturedBias{};
  expect_named(capture, "bias: says nothing without map");
  capture = good();
  capture.shadowed = capture.visibility;
  expect_named(capture, "visibility: cannot stand beside");
  capture = good();
  capture.depth = compare::CapturedDepth{capture.visibility, compare::PixelDepth::zero_to_one, 0.1, {}};
  expect_named(capture, "depth.far: is missing; zero_to_one needs it");
  capture.depth->convention = compare::PixelDepth::view_z;
  expect_named(capture, "depth.near: does not go with view_z");
  capture = good();
  capture.light = "moon";
  expect_named(capture, "light: the scene has no such light (got moon");
}

TEST(BadCaptures, OfAnotherSceneAreRefused) {
  Capture capture = good();
  // Something drawn all over, at one place.
  capture.position = image("elsewhere.exr", picture, {"X", "Y", "Z"}, 123.0f);
  expect_named(capture, "does not show this scene");
}

/// What the published schema and the reader say of a capture's text: whether each takes it.
std::pair<bool, bool> taken(const nlohmann::json& capture) {
  const std::string file = folder() + "/schema.json";
  EXPECT_TRUE(write_file(file, capture.dump()));
  const auto read = compare::read_capture(file);
  std::ifstream schema(source_dir() + "/studies/judge/capture.schema.json");
  return {SchemaCheck(nlohmann::json::parse(schema)).violations(capture).empty(),
          read && compare::check_capture(*read)};
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
      {"constant", 0.001}, {"constant_world", -0.1}, {"slope", 2}, {"clamp", 0.01}};
  whole["map"][0]["rect"] = {0, 4, 8, 8};
  whole["map"][0]["select"] = {{"near", 1}, {"far", 5.5}, {"by", "distance"}};
  whole["map"][0]["bias"] = {{"constant_depth", 0.1}, {"normal_offset_world", 1}};
  whole["filter"] = {{"kind", "none"}, {"read", "linear_depths"}};
  EXPECT_EQ(taken(whole), std::pair(true, true));
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
                                                        {"/filter/read", "cubic"},
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

// What version 1 has not is refused by its name, with the version that has it.
TEST(CaptureSchema, OfVersion1HasNoKeysOfVersion2) {
  const std::string file = folder() + "/old.json";
  const std::string head =
      R"({"schema": "gnomon/capture/1", "renderer": {"name": "x"}, "scene": "fence", "size": [64, 36],
 "visibility": "v.exr", )";
  for (
      const std::string key :
      {R"("strength": 0.5})",
       R"("map": [{"depth": "z.exr", "convention": "reversed", "rows": "top_down", "caster_bias": {"slope": 1},
 "clip_from_world": [1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}]})"}) {
    ASSERT_TRUE(write_file(file, head + key));
    const auto read = compare::read_capture(file);
    ASSERT_FALSE(read) << key;
    EXPECT_NE(read.error().message().find("needs \"schema\": \"gnomon/capture/2\""), std::string::npos)
        << read.error().message();
  }
}

TEST(BadCaptures, WithUnknownKeysAreRefusedWithLineAndColumn) {
  const std::string file = folder() + "/capture.json";
  ASSERT_TRUE(write_file(file,
                         "{\"schema\": \"gnomon/capture/1\", \"renderer\": {\"name\": \"x\"},\n"
                         " \"scene\": \"fence\", \"size\": [64, 36], \"visibilty\": \"v.exr\"}\n"));
  const auto read = compare::read_capture(file);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message().find(":2:38: visibilty: unknown key"), std::string::npos)
      << read.error().message();
  EXPECT_NE(read.error().message().find("did you mean"), std::string::npos);
}

}  // namespace
}  // namespace gnomon::test
