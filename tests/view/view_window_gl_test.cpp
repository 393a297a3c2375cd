// The window itself: a script drives it under Xvfb, and its screenshots are held against what the other
// commands write. Needs Xvfb and an OpenGL 4.5 that serves it (Mesa's llvmpipe will do); skipped where there
// is no Xvfb.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <set>
#include <thread>

#include "compare/result/outputs.h"
#include "compare/result/palette.h"
#include "scene/files/pictures/image_io.h"
#include "tests/support/app_process.h"
#include "tests/view/view_display.h"

namespace gnomon::app_test {
namespace {

constexpr const char* tour = R"(# all views of one state, then of others; the pictures alone
set panels off
set size 480x270
set map-size 256
set bias 0.25texel
wait done
screenshot raster.png
set view raytrace
screenshot raytrace.png
set view difference
screenshot difference.png
set view labels
screenshot labels.png
set view depth
screenshot depth.png
set view difference
set bias 6texel
wait done
screenshot difference-6.png
set camera-orbit 40 30
set camera-distance 7
set light-azimuth 100
set light-elevation 35
set view raster
screenshot turned-at-once.png
wait done
screenshot turned.png
set view raytrace
screenshot turned-raytrace.png
)";

const std::vector<std::string> same_size{"--size", "480x270"};

std::vector<std::string> with(std::vector<std::string> words, std::initializer_list<std::string> more) {
  words.insert(words.end(), more);
  words.insert(words.end(), same_size.begin(), same_size.end());
  return words;
}

Rgb8Image read_png(const std::string& path) {
  const auto texture = read_texture(path, true);
  if (!texture) {
    ADD_FAILURE() << texture.error().message();
    return {};
  }
  Rgb8Image image(texture->size);
  std::transform(texture->texels.begin(), texture->texels.end(), image.data.begin(),
                 [](const glm::u8vec4& t) { return glm::u8vec3(t); });
  return image;
}

int channel_difference(const glm::u8vec3& a, const glm::u8vec3& b) {
  int most = 0;
  for (int i = 0; i < 3; ++i) most = std::max(most, std::abs(int(a[i]) - int(b[i])));
  return most;
}

/// Pixels that differ by more than `tolerance` in some channel; all of them when the sizes differ.
std::size_t differing(const Rgb8Image& a, const Rgb8Image& b, int tolerance) {
  if (!(a.size == b.size) || a.data.empty()) return std::max<std::size_t>(1, a.data.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.data.size(); ++i)
    count += channel_difference(a.data[i], b.data[i]) > tolerance;
  return count;
}

std::size_t colours(const Rgb8Image& image) {
  std::set<std::uint32_t> seen;
  for (const glm::u8vec3& c : image.data) seen.insert(c.r * 65536u + c.g * 256u + c.b);
  return seen.size();
}

bool is_grey(const glm::u8vec3& c) {
  return c.r == c.g && c.g == c.b;
}

/// One display and one tour for all tests.
class ViewWindow : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new Shared;
    if (!shared_->display.missing().empty()) return;
    write_text(shared_->folder / "tour.txt", tour);
    shared_->result = run({"view", "floating-box", "--script", "tour.txt"});
  }
  static void TearDownTestSuite() {
    delete shared_;
    shared_ = nullptr;
  }
  void SetUp() override {
    if (!shared_->display.missing().empty()) GTEST_SKIP() << shared_->display.missing();
    ASSERT_EQ(shared_->result.exit_code, 0) << shared_->result.err;
  }
  static ProcessResult run(const std::vector<std::string>& arguments, bool with_display = true,
                           const std::string& folder = shared_->folder.path()) {
    ProcessOptions options;
    options.folder = folder;
    options.environment = {with_display ? shared_->display.variable() : "DISPLAY=", "WAYLAND_DISPLAY="};
    return run_gnomon(arguments, options);
  }
  static ProcessResult run_script(const std::string& script, bool with_display = true) {
    write_text(shared_->folder / "script.txt", script);
    return run({"view", "floating-box", "--script", "script.txt"}, with_display);
  }
  static Rgb8Image picture(const std::string& name) { return read_png(shared_->folder / name); }
  static bool exists(const std::string& name) {
    const auto entries = shared_->folder.entries();
    return std::find(entries.begin(), entries.end(), name) != entries.end();
  }

 private:
  struct Shared {
    VirtualDisplay display;
    TemporaryFolder folder;
    ProcessResult result;
  };
  static Shared* shared_;
};

ViewWindow::Shared* ViewWindow::shared_ = nullptr;

TEST_F(ViewWindow, EveryScreenshotHasTheWindowsSizeAndShowsSomething) {
  for (const char* name :
       {"raster.png", "raytrace.png", "difference.png", "labels.png", "depth.png", "turned.png"}) {
    const Rgb8Image image = picture(name);
    EXPECT_EQ(image.size, (ImageSize{480, 270})) << name;
    EXPECT_GE(colours(image), 4u) << name;  // labels: background, lit, in shadow, and some wrong ones
  }
}

// Pixels that the difference shows in grey have the same shadow in both; there the two pictures come from one
// formula, in float here and in double there, so that 8-bit values may round differently. At silhouettes the
// two may see different surfaces: measured 3 of 107,026 pixels, and no other pixel differs at all.
TEST_F(ViewWindow, RasterAndRayTracedAgreeWhereTheShadowIsRight) {
  const Rgb8Image drawn = picture("raster.png"), traced = picture("raytrace.png"),
                  difference = picture("difference.png");
  std::size_t right = 0, off = 0, wrong = 0;
  for (std::size_t i = 0; i < drawn.data.size(); ++i) {
    if (!is_grey(difference.data[i])) {
      ++wrong;
      continue;
    }
    ++right;
    off += channel_difference(drawn.data[i], traced.data[i]) > 1;
  }
  EXPECT_GT(wrong, 100u);
  EXPECT_GT(right, drawn.data.size() / 2);
  EXPECT_LT(double(off), 0.001 * double(right)) << off << " of " << right;
}

TEST_F(ViewWindow, AnotherBiasChangesTheDifference) {
  EXPECT_GT(differing(picture("difference.png"), picture("difference-6.png"), 0), 100u);
}

TEST_F(ViewWindow, LabelsReachTheScreenUnchanged) {
  std::set<std::uint32_t> allowed;
  const auto key = [](const glm::u8vec3& c) { return c.r * 65536u + c.g * 256u + c.b; };
  for (int label = -4; label <= int(compare::class_count); ++label)
    allowed.insert(key(compare::label_colour(static_cast<compare::Label>(label))));
  allowed.insert(key(compare::right_in_shadow_colour));
  for (const glm::u8vec3& c : picture("labels.png").data) ASSERT_TRUE(allowed.contains(key(c))) << key(c);
}

// The same program on the same software rasterizer: nothing but the context differs. One step of the 8-bit
// value is allowed for a rasterizer that rounds otherwise.
TEST_F(ViewWindow, RasterIsWhatTheRasterCommandWrites) {
  const auto written = run(
      with({"raster", "floating-box", "-o", "command.png"}, {"--map-size", "256", "--bias", "0.25texel"}));
  ASSERT_EQ(written.exit_code, 0) << written.err;
  EXPECT_EQ(differing(picture("raster.png"), picture("command.png"), 1), 0u);
}

TEST_F(ViewWindow, EveryViewIsWhatCompareWrites) {
  const auto written =
      run(with({"compare", "floating-box", "-o", "report"}, {"--map-size", "256", "--bias", "0.25texel"}));
  ASSERT_EQ(written.exit_code, 0) << written.err;
  EXPECT_EQ(differing(picture("raster.png"), picture("report/raster.png"), 1), 0u);
  EXPECT_EQ(differing(picture("raytrace.png"), picture("report/raytrace.png"), 0), 0u);
  EXPECT_EQ(differing(picture("labels.png"), picture("report/labels.png"), 0), 0u);
  EXPECT_EQ(differing(picture("difference.png"), picture("report/difference.png"), 1), 0u);
}

// The command line has the script's words, and both mean the same to the last bit.
TEST_F(ViewWindow, TurnedCameraAndLightAreThoseOfTheCommandLine) {
  const std::initializer_list<std::string> poses{"--camera-orbit",  "40,30", "--camera-distance", "7",
                                                 "--light-azimuth", "100",   "--light-elevation", "35"};
  auto arguments = with(
      {"raster", "floating-box", "-o", "turned-command.png", "--map-size", "256", "--bias", "6texel"}, poses);
  ASSERT_EQ(run(arguments).exit_code, 0);
  EXPECT_EQ(differing(picture("turned.png"), picture("turned-command.png"), 1), 0u);
  arguments = with({"raytrace", "floating-box", "-o", "turned-rays.png"}, poses);
  ASSERT_EQ(run(arguments).exit_code, 0);
  EXPECT_EQ(differing(picture("turned-raytrace.png"), picture("turned-rays.png"), 0), 0u);
  EXPECT_GT(differing(picture("turned.png"), picture("raster.png"), 8), 1000u);
}

TEST_F(ViewWindow, ScreenshotShowsWhatWasSetJustBefore) {
  EXPECT_EQ(differing(picture("turned-at-once.png"), picture("turned.png"), 0), 0u);
}

TEST_F(ViewWindow, WindowFollowsTheSizeAsked) {
  const ProcessResult result = run_script(
      "wait 1\nset panels off\nset size 200x120\nset view labels\nwait done\nscreenshot new/small.png\n");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(picture("new/small.png").size, (ImageSize{200, 120}));
}

TEST_F(ViewWindow, WhatCannotBeDrawnEndsTheScriptWithItsLine) {
  const ProcessResult result = run_script("wait 1\nset map-size 65536\nwait done\nscreenshot never.png\n");
  EXPECT_EQ(result.exit_code, 5) << "signal " << result.signal;
  EXPECT_EQ(result.err.substr(0, 13), "script.txt:2:") << result.err;
  EXPECT_FALSE(exists("never.png"));
}

/// The left half of the status line: what was said last.
Rgb8Image said(const Rgb8Image& window) {
  constexpr int rows = 20;
  if (window.size.height < rows) return {};
  Rgb8Image out({window.size.width / 2, rows});
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < out.size.width; ++x) out.at(x, y) = window.at(x, window.size.height - rows + y);
  return out;
}

TEST_F(ViewWindow, MistakesOfAnEditedSceneAreSaidUntilTheyAreMended) {
  const TemporaryFolder folder;
  const std::string scene =
      R"({"schema": "gnomon/scene/1", "materials": [{"name": "grey", "diffuse": [0.5, 0.5, 0.5]}],
          "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "grey"}]})";
  const std::string path = folder / "edited.json";
  write_text(path, scene);
  // The file is changed once there is the picture before the change. It goes by its name, for a long path would leave no room for
  // what is wrong.
  std::thread editor([&] {
    const auto change_after = [&](const std::string& picture, const std::string& text) {
      for (int i = 0; i < 200 && !std::filesystem::exists(folder / picture); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
      write_text(path, text);
    };
    change_after("good.png", "{ x");
    change_after("first.png", "{ \"a\": ");
    change_after("second.png", scene);
  });
  write_text(folder / "script.txt",
             "set size 700x500\nwait done\nscreenshot good.png\nwait 400\nscreenshot first.png\nwait 400\n"
             "screenshot second.png\nwait 400\nscreenshot mended.png\n");
  const ProcessResult result = run({"view", "edited.json", "--script", "script.txt"}, true, folder.path());
  editor.join();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto at = [&](const char* name) { return said(read_png(folder / name)); };
  EXPECT_GT(differing(at("good.png"), at("first.png"), 0), 0u);
  EXPECT_GT(differing(at("first.png"), at("second.png"), 0), 0u);
  EXPECT_EQ(differing(at("good.png"), at("mended.png"), 0), 0u);
}

TEST_F(ViewWindow, ReportThatTheWindowsEndCutsOffIsSaid) {
  const ProcessResult result = run_script("wait done\nkey ctrl+R\nquit\n");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find(
                "the window was closed before this was done: writing the report to floating-box-report"),
            std::string::npos)
      << result.err;
}

// Without a display, so that a window cannot have been opened before the script was read.
TEST_F(ViewWindow, ScriptIsCheckedBeforeTheWindowOpens) {
  const ProcessResult result = run_script("wait done\nset bios 1\n", false);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err.substr(0, 13), "script.txt:2:") << result.err;
  EXPECT_EQ(run({"view", "floating-box", "--script", "missing.txt"}, false).exit_code, 3);
}

TEST_F(ViewWindow, ScreenshotThatCannotBeWrittenIsSaidBeforeTheWindowOpens) {
  const ProcessResult result = run_script("wait done\nscreenshot tour.txt/a.png\n", false);
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_EQ(result.err.substr(0, 13), "script.txt:2:") << result.err;
  EXPECT_NE(result.err.find("tour.txt"), std::string::npos) << result.err;
}

TEST_F(ViewWindow, NoDisplayIsOneClearLine) {
  const ProcessResult result = run({"view", "floating-box"}, false);
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_NE(result.err.find("cannot open a window"), std::string::npos) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

}  // namespace
}  // namespace gnomon::app_test
