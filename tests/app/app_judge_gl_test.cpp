// gnomon judge seen from outside: where its results go, and that they take nobody's place.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "scene/files/pictures/image_io.h"
#include "tests/support/app_process.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;

/// A capture of the teapot, 96 x 54; its pictures as JSON members.
std::string capture_text(const std::string& pictures) {
  return fmt::format(
      R"({{"schema": "gnomon/capture/1", "renderer": {{"name": "mine"}}, "scene": "teapot", "size": [96, 54], {}}})",
      pictures);
}

/// A folder that the program works in.
struct JudgeFolder {
  TemporaryFolder folder;
  void put(const std::string& name, const std::string& text) const {
    fs::create_directories(fs::path(folder / name).parent_path());
    write_text(folder / name, text);
  }
  ProcessResult judge(const Words& words) const {
    return run_gnomon(Words{"judge"} + words, {.folder = folder.path()});
  }
};

TEST(JudgeProgram, PicturesOfACaptureAreNotOverwritten) {
  const JudgeFolder world;
  const Words mine{"--renderer", "mine", "--scene", "teapot", "--size", "96x54"};
  const std::string lost = "this file is also an input, which would be lost (got ";
  for (const char* name : {"v.exr", "p.exr", "m.exr", "d/raster.png"}) world.put(name, "mine");
  expect_one_line(world.judge(mine + Words{"--visibility", "v.exr", "--aov", "v.exr"}), 2, lost);
  expect_one_line(
      world.judge(mine + Words{"--visibility", "v.exr", "--position", "p.exr", "--json", "p.exr"}), 2, lost);
  expect_one_line(world.judge(mine + Words{"--visibility", "d/raster.png", "-o", "d"}), 2, lost);
  world.put("a.json",
            capture_text(R"("visibility": "v.exr", "depth": {"file": "m.exr", "convention": "view_z"})"));
  expect_one_line(world.judge({"a.json", "--json", "m.exr"}), 2, lost);
  // Of several captures each has a folder of its own.
  fs::rename(world.folder / "d", world.folder / "b");
  world.put("b.json", capture_text(R"("visibility": "b/raster.png")"));
  expect_one_line(world.judge({"a.json", "b.json", "-o", "."}), 2, lost);
  for (const char* name : {"v.exr", "p.exr", "m.exr", "b/raster.png"})
    EXPECT_EQ(read_file(world.folder / name), "mine") << name;
  EXPECT_FALSE(fs::exists(world.folder / "a"));
}

// None of the three can be judged, and each is named by itself.
TEST(JudgeProgram, NoTwoCapturesShareAName) {
  const JudgeFolder world;
  for (const char* name : {"x/a.json", "y/a.json", "z/a-2.json"})
    world.put(name, capture_text(R"("visibility": "nowhere.exr")"));
  const ProcessResult judged = world.judge({"x/a.json", "y/a.json", "z/a-2.json", "-o", "out"});
  EXPECT_EQ(judged.exit_code, 3) << judged.err;
  for (const char* name : {"\na  ", "\na-2  ", "\na-2-2  "})
    EXPECT_NE(judged.out.find(name), std::string::npos) << judged.out;
  EXPECT_NE(policy_of(read_file(world.folder / "out/report.html")).find("default-src 'none'"),
            std::string::npos);
}

// Each light of a capture has a verdict and a folder of its own; --light takes one of them.
TEST(JudgeProgram, LightsOfACaptureAreJudgedOneByOne) {
  const JudgeFolder world;
  ASSERT_EQ(
      run_gnomon({"raytrace", "teapot", "--size", "96x54", "-o", world.folder / "traced.exr"}).exit_code, 0);
  const auto image = read_channels(world.folder / "traced.exr");
  ASSERT_TRUE(image && image->find("truth.V") != nullptr);
  const Channel seen{"V", image->find("truth.V")->values};
  ASSERT_TRUE(write_exr(world.folder / "v.exr", image->size, std::span(&seen, 1)));
  world.put(
      "frame.json",
      R"({"schema": "gnomon/capture/2", "renderer": {"name": "mine"}, "scene": "teapot", "size": [96, 54],
 "lights": [{"light": 7, "visibility": "v.exr"}, {"light": 0, "visibility": "v.exr"}]})");
  const ProcessResult all = world.judge({"frame.json"});
  EXPECT_EQ(all.exit_code, 3) << all.err;
  EXPECT_NE(all.out.find("\nframe-0  "), std::string::npos) << all.out;
  EXPECT_NE(all.out.find("\nframe-7   not judged: "), std::string::npos) << all.out;
  EXPECT_TRUE(fs::exists(world.folder / "out/frame/frame-0/report.html"));
  const ProcessResult one = world.judge({"frame.json", "--light", "0", "-o", "one"});
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_TRUE(fs::exists(world.folder / "one/result.json"));
  expect_one_line(world.judge({"frame.json", "--light", "moon"}), 3,
                  "lights: has no such light (got moon, allowed 7, 0)");
}

// What the ray tracer sees of the light is a right picture of the visibility.
TEST(JudgeProgram, AGenericNameIsThatOfItsFolder) {
  const JudgeFolder world;
  const ProcessResult traced =
      run_gnomon({"raytrace", "teapot", "--size", "96x54", "-o", world.folder / "traced.exr"});
  ASSERT_EQ(traced.exit_code, 0) << traced.err;
  const auto image = read_channels(world.folder / "traced.exr");
  ASSERT_TRUE(image && image->find("truth.V") != nullptr);
  world.put("wall/capture.json", capture_text(R"("visibility": "v.exr")"));
  const Channel seen{"V", image->find("truth.V")->values};
  ASSERT_TRUE(write_exr(world.folder / "wall/v.exr", image->size, std::span(&seen, 1)));
  const ProcessResult judged = world.judge({"wall/capture.json", "-q"});
  EXPECT_EQ(judged.exit_code, 0) << judged.err;
  EXPECT_TRUE(fs::exists(world.folder / "out/wall/report.html"));
}

}  // namespace
}  // namespace gnomon::app_test
