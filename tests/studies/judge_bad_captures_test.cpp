// Captures that cannot be judged: one line that names the field, an error of bad input, and no result.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "judge/judge.h"
#include "scene/files/pictures/image_io.h"
#include "scene/load.h"

namespace gnomon::test {
namespace {

using judge::Capture;

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
  const auto judged = judge::judge_capture(capture, *scene, world, {});
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

judge::CapturedLayer layer(const Mat4& matrix) {
  judge::CapturedLayer out;
  out.depth = image("map.exr", {8, 8}, {"Z"});
  out.convention = judge::StoredDepth::zero_to_one;
  out.rows = judge::RowOrder::top_down;
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
  capture.map[0].rect = judge::CapturedRect{4, 0, 4, 5};
  expect_named(capture, "map[0].rect: reaches beyond its picture (got [4, 0, 4, 5], the picture is 8 x 4)");
}

TEST(BadCaptures, OfPicturesNameThePicture) {
  Capture capture = good();
  capture.visibility = folder() + "/none.exr";
  expect_named(capture, "visibility: no such file");
  capture.visibility = folder() + "/pipe.exr";
  std::filesystem::remove(capture.visibility);
  ASSERT_EQ(mkfifo(capture.visibility.c_str(), 0600), 0);
  expect_named(capture, "visibility: is a pipe, not a file (got ");
  capture.visibility = "/dev/null";
  expect_named(capture, "visibility: is a device, not a file (got /dev/null)");
  capture.visibility = image("small.exr", {32, 18}, {"V"});
  expect_named(capture, "visibility: is of another size (got 32 x 18, the capture says 64 x 36)");
  capture.visibility = image("rgb.exr", picture, {"R", "G", "B"});
  expect_named(capture, "visibility: has 3 channels where one is wanted");
  capture.visibility = image("nan.exr", picture, {"V"}, std::numeric_limits<float>::quiet_NaN());
  expect_named(capture, "visibility: 2304 pixels of channel V are not finite");
  capture.visibility = image("wide.exr", picture, {"V"}, 3.0f);
  expect_named(capture, "visibility: values beyond their range");
}

TEST(BadCaptures, OfParaboloidsNameTheField) {
  Capture capture = good();
  const auto half = [](double z) {
    Mat4 view(1.0);
    view[2][2] = z;
    judge::CapturedLayer out = layer(view);
    out.convention = judge::StoredDepth::paraboloid;
    return out;
  };
  capture.map = {half(1.0)};
  expect_named(capture, "map: of paraboloids has two layers");
  capture.map = {half(1.0), half(-1.0)};
  capture.map[1].bias = judge::CapturedBias{.constant_depth = 0.1};
  expect_named(capture, "map[1].bias: is not of paraboloids");
  capture.map[1].bias.reset(), capture.map[1].caster_bias = judge::CapturedCasterBias{.constant = 0.1};
  expect_named(capture, "map[1].caster_bias: differs from that of the other half");
  capture.map = {half(1.0), half(1.0)};
  capture.filter = judge::CapturedFilter{.read = judge::FilterRead::linear_depths};
  expect_named(capture, "filter.read: is nearest of paraboloids");
  capture.filter.reset(), capture.map[1].select = judge::CapturedSelect{};
  expect_named(capture, "map: has a select in some layers");
  capture.map[1].select.reset(), (*capture.map[0].clip_from_world)[2][3] = 1.0;
  expect_named(capture, "map[0].clip_from_world: is no turn and shift");
  capture.map = {half(1.0), half(1.0)};
  expect_named(capture, "map[0].clip_from_world: is a perspective where light");
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
  capture.map.assign(33, layer(Mat4(1.0)));
  expect_named(capture, "map: needs one layer to 32");
  capture.map = {layer(Mat4(1.0))};
  capture.map[0].range = Vec2(0.1, 20.0);
  expect_named(capture, "map[0].range: is of distance and linear_z");
  capture.map[0].range.reset();
  capture.map[0].select = judge::CapturedSelect{.near = 0.0, .far = 4.0, .blend = 1.0};
  expect_named(capture, "map[0].select.blend: is towards the next layer, and there is none");
  capture.map.push_back(layer(Mat4(1.0)));
  capture.map[0].select.reset();
  capture.map[1].bias = judge::CapturedBias{.angle = judge::BiasAngle::sine};
  expect_named(capture, "map[1].bias.angle: differs from that of map[0]");
}

// What a convention leaves nothing to say of is no key that is read and forgotten.
TEST(BadCaptures, WithAKeyThatTheConventionHasNotNameTheKey) {
  using judge::CapturedCasterBias;
  using judge::FilterName;
  using enum judge::StoredDepth;
  struct Row {
    judge::StoredDepth convention;
    CapturedCasterBias casters;
    judge::CapturedBias bias;
    FilterName filter;
    std::string named;
  };
  std::vector<Row> rows{
      {linear_z, {.constant = 0.1}, {}, FilterName::none, "map[0].caster_bias.constant: is not of linear_z"},
      {zero_to_one,
       {.constant_world = 0.1, .clamp = 0.1},
       {},
       FilterName::none,
       "map[0].caster_bias.clamp: limits constant and slope"},
      {paraboloid, {}, {.slope = 1.0}, FilterName::none, "bias.slope: is not of paraboloids"},
      {paraboloid, {}, {}, FilterName::vsm, "filter.kind: is none or pcf of paraboloids"}};
  for (const auto linear : {distance, linear_z, paraboloid}) {
    rows.push_back({linear,
                    {.slope = 1.0},
                    {},
                    FilterName::none,
                    "map[0].caster_bias.slope: is of the depths that a matrix makes"});
    rows.push_back({linear,
                    {.constant_world = 0.1, .clamp = 0.1},
                    {},
                    FilterName::none,
                    "map[0].caster_bias.clamp: is of the depths"});
  }
  for (const Row& row : rows) {
    Capture capture = good();
    capture.map.assign(row.convention == paraboloid ? 2 : 1, layer(Mat4(1.0)));
    for (judge::CapturedLayer& one : capture.map)
      one.convention = row.convention, one.caster_bias = row.casters;
    capture.bias = row.bias, capture.filter = judge::CapturedFilter{.kind = row.filter};
    expect_named(capture, row.named);
  }
}

TEST(BadCaptures, ThatContradictNameTheField) {
  Capture capture = good();
  capture.bias = judge::CapturedBias{};
  expect_named(capture, "bias: says nothing without map");
  capture = good();
  capture.shadowed = capture.visibility;
  expect_named(capture, "visibility: cannot stand beside");
  capture = good();
  capture.depth = judge::CapturedDepth{capture.visibility, judge::PixelDepth::zero_to_one, 0.1, {}};
  expect_named(capture, "depth.far: is missing; zero_to_one needs it");
  capture.depth->convention = judge::PixelDepth::view_z;
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

}  // namespace
}  // namespace gnomon::test
