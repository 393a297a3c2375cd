// The shadow lab as a person uses it with the mouse: its numbers are those of `gnomon compare`, its panels take the
// pointer, and many changes in a row leave no error.
#include <fmt/format.h>

#include <map>
#include <random>

#include "tests/view/view_lab_fixture.h"

namespace gnomon::app_test {
namespace {

/// Some setting, light and camera.
std::string random_state(std::mt19937& random) {
  const auto number = [&](double from, double to) {
    return from + (to - from) * double(random()) / double(std::mt19937::max());
  };
  constexpr std::array techniques{"hard", "pcf", "vsm", "second-depth", "csm", "hybrid"};
  const std::size_t technique = random() % techniques.size();
  const int map_size = 64 << random() % 4;
  const double bias = number(0.0, 3.0), slope = number(0.0, 2.0), azimuth = number(-180.0, 180.0),
               elevation = number(20.0, 80.0), around = number(-180.0, 180.0), up = number(10.0, 60.0);
  return fmt::format(
      "set technique {}\nset map-size {}\nset bias {:.3f}texel\nset slope-bias {:.2f}\nset light-azimuth "
      "{:.1f}\n"
      "set light-elevation {:.1f}\nset camera-orbit {:.1f} {:.1f}\nset camera-target {:.2f} 0.5 0\n",
      techniques[technique], map_size, bias, slope, azimuth, elevation, around, up, number(-0.5, 0.5));
}

TEST_F(ViewLab, LabelsOnTheScreenAreThoseOfThePrintedCommand) {
  constexpr std::size_t states = 4;  // view_thread_gl_test goes through more of them
  std::mt19937 random(7);
  std::string script = "set panels off\nset size 96x64\nset view labels\n";
  for (std::size_t i = 0; i < states; ++i)
    script += random_state(random) + fmt::format("wait done\nscreenshot {}.png\nprint\n", i);
  const Words commands = printed("floating-box", script);
  ASSERT_EQ(commands.size(), states);
  for (std::size_t i = 0; i < states; ++i) expect_labels(fmt::format("{}.png", i), commands[i]);
}

// The settings' column at its first size: its sliders lie one below the other, at heights that follow from the
// size of the text alone.
TEST_F(ViewLab, ASliderThatIsDraggedSetsTheBias) {
  const Words commands =
      printed("floating-box",
              "set size 900x700\nset results off\nset bias 0texel\nset slope-bias 0\nwait 4\n"
              "drag 20 343 150 343\nwait 2\nprint\n");
  ASSERT_EQ(commands.size(), 1u);
  const std::size_t at = commands[0].find("--bias ");
  ASSERT_NE(at, std::string::npos) << commands[0];
  const double texels = std::stod(commands[0].substr(at + 7));
  EXPECT_GT(texels, 3.0) << commands[0];  // half the slider, which ends at 10
  EXPECT_LT(texels, 7.0) << commands[0];
}

// Eight texels move no shadow of the floating box that anyone sees.
TEST_F(ViewLab, PeterPanningTakesTheBiasFromTheScene) {
  const Words commands = printed("floating-box", "set size 320x240\nshow peter-panning\nwait done\nprint\n");
  ASSERT_EQ(commands.size(), 1u);
  const std::size_t at = commands[0].find("--bias ");
  ASSERT_NE(at, std::string::npos) << commands[0];
  EXPECT_GT(std::stod(commands[0].substr(at + 7)), 20.0) << commands[0];
}

/// Where the line of the best bias stands in the curve: the middle of the first column with many pixels of its
/// green. Nothing: (0, 0).
PixelPlace best_line(const std::vector<glm::u8vec4>& window, int width) {
  constexpr int least = 60;  // the letters beside it are lower
  std::map<int, std::vector<int>> columns;
  for (std::size_t i = 0; i < window.size(); ++i)
    if (window[i] == glm::u8vec4(96, 206, 143, 255))
      columns[static_cast<int>(i) % width].push_back(static_cast<int>(i) / width);
  for (const auto& [x, rows] : columns)
    if (rows.size() > least) return {x, rows[rows.size() / 2]};
  return {};
}

double number_after(const std::string& text, const std::string& name) {
  const std::size_t at = text.find(name);
  EXPECT_NE(at, std::string::npos) << name << " in " << text.substr(0, 500);
  return at == std::string::npos ? 0.0 : std::stod(text.substr(at + name.size()));
}

// To the best bias, as `compare` has it, and then beyond the curve's end.
TEST_F(ViewLab, TheBiasIsDraggedInTheCurve) {
  const std::string start =
      "set size 640x700\nset settings off\nset map-size 256\nset bias 0\nset slope-bias 0\nwait done\n";
  const Words before = printed("floating-box", start + "screenshot before.png\nprint\n");
  ASSERT_EQ(before.size(), 1u);
  const Words more{"--json", "-", "--runs", "1", "--no-report", "--quiet"};
  const std::string result = run(words_of(before[0]) + more).out;
  const double best = number_after(result.substr(result.find("\"best_bias\"")), "\"constant_world\": ");
  const PixelPlace line = best_line(texels("before.png"), 640);
  ASSERT_GT(line.x, 340) << "no line of the best bias";
  const Words after = printed(
      "floating-box", start + fmt::format("drag {0} {1} {2} {1}\nwait done\nprint\nscreenshot after.png\n"
                                          "drag {2} {1} 1500 {1}\nprint\n",
                                          line.x - 100, line.y, line.x));
  ASSERT_EQ(after.size(), 2u);
  const double set = number_after(after[0], "--bias ");
  EXPECT_NEAR(set, best, 0.02 * best) << "two pixels of the curve's hundred and more to the best bias";
  EXPECT_GT(number_after(after[1], "--bias "), 1.2 * best);
  EXPECT_GT(differing("before.png", "after.png", {0, 60, 320, 600}), 50000u) << "the acne is still there";
}

TEST_F(ViewLab, ADragOverThePictureTurnsTheCameraAndOneOverAPanelDoesNot) {
  const Words commands = printed("floating-box",
                                 "set size 900x700\nset results off\nwait 4\ndrag 150 367 200 "
                                 "367\nprint\ndrag 700 600 760 600\nprint\n");
  ASSERT_EQ(commands.size(), 2u);
  EXPECT_EQ(commands[0].find("--camera-orbit"), std::string::npos) << commands[0];
  EXPECT_NE(commands[1].find("--camera-orbit"), std::string::npos) << commands[1];
}

TEST_F(ViewLab, TheLightsHandleFollowsThePointer) {
  for (const char* scene : {"floating-box", "whitted"}) {
    const Words commands =
        printed(scene,
                "set size 900x700\nset results off\nset camera-distance 40\nwait 4\nprint\n"
                "drag light 700 250\nprint\nscreenshot there.png\ndrag light 500 200\nprint\n");
    ASSERT_EQ(commands.size(), 3u);
    EXPECT_EQ(commands[0].find("--light-azimuth"), std::string::npos) << commands[0];
    EXPECT_EQ(commands[1].find(commands[0] + " --light-azimuth"), 0u)
        << commands[1];                   // and nothing else moved
    EXPECT_NE(commands[2], commands[1]);  // it was taken again where it had been left
    EXPECT_EQ(texel("there.png", {700, 250}), glm::u8vec4(255, 210, 60, 255)) << scene;  // its disc
  }
}

// Beside a swipe's line it is on the side that shows the scene, and there alone.
TEST_F(ViewLab, TheLightsHandleIsOnEitherSideOfASwipe) {
  const std::string start =
      "set size 900x700\nset results off\nset map-size 64\ndrag light 450 250\nset layout swipe\n";
  const glm::u8vec4 disc(255, 210, 60, 255);
  for (const char* views : {"set view raster\nset view difference\nset swipe 0.6\n",
                            "set view difference\nset view raytrace\nset swipe 0.1\n"}) {
    printed("floating-box", start + views + "drag light 500 300\nscreenshot there.png\n");
    EXPECT_EQ(texel("there.png", {500, 300}), disc) << views;
  }
  const std::string away = "set view raster\nset view difference\nset swipe 0.1\n";
  printed("floating-box", start + away + "screenshot away.png\n");
  EXPECT_NE(texel("away.png", {450, 250}), disc);
  EXPECT_EQ(drive("floating-box", start + away + "drag light 500 300\n").exit_code, 3);
}

// The settings' column is 312 pixels wide; a note is wider.
TEST_F(ViewLab, WhatThePointerRestsOnExplainsItself) {
  printed("floating-box",
          "set size 900x700\nset results off\nset map-size 64\nwait done\nscreenshot none.png\n"
          "point 40 114\nscreenshot name.png\npoint 40 138\nscreenshot slider.png\n"
          "set layout quad\nwait done\nscreenshot quad.png\npoint 450 200\nscreenshot cross.png\n");
  EXPECT_GT(differing("none.png", "name.png", {320, 0, 580, 700}), 2000u);
  EXPECT_EQ(differing("none.png", "slider.png", {320, 0, 580, 700}), 0u);
  for (const Box& pane : {Box{612, 60, 280, 280}, Box{312, 400, 280, 280}, Box{612, 400, 280, 280}})
    EXPECT_GT(differing("quad.png", "cross.png", pane), 20u) << pane.x << " " << pane.y;
}

// And when a panel that was come to by keyboard has been left, keys are the pictures' again, whatever appears.
TEST_F(ViewLab, NotesComeToTheKeyboardToo) {
  const Words said =
      printed("floating-box",
              "set size 900x700\nset results off\nset map-size 64\nwait done\nscreenshot none.png\n"
              "key ctrl+tab\nwait 3\nkey down\nkey down\nscreenshot keyboard.png\n"
              "key esc\nset layout quad\nwait 3\nprint\nkey left\nprint\n");
  EXPECT_GT(differing("none.png", "keyboard.png", {320, 0, 580, 700}), 2000u);
  ASSERT_EQ(said.size(), 2u);
  EXPECT_EQ(said[0].find("--camera-orbit"), std::string::npos) << said[0];
  EXPECT_NE(said[1].find("--camera-orbit"), std::string::npos) << said[1];
}

TEST_F(ViewLab, WhatIsCopiedIsWhatIsPrinted) {
  const Words said = printed("floating-box", "set map-size 64\nkey C\nprint clipboard\n");
  ASSERT_EQ(said.size(), 2u);
  EXPECT_EQ(said[0], said[1]);
  EXPECT_NE(said[1].find("gnomon compare floating-box"), std::string::npos) << said[1];
}

TEST_F(ViewLab, AFileLetFallOnTheWindowIsOpened) {
  printed("floating-box", "save-scene mine.json\n");
  const Words said = printed("fence", "drop mine.json\nprint\n");
  ASSERT_EQ(said.size(), 1u);
  EXPECT_TRUE(said[0].starts_with("gnomon compare mine.json")) << said[0];
}

TEST_F(ViewLab, AMomentOfAFilmIsThePrintedCommands) {
  const Words commands =
      printed("floating-box",
              "set panels off\nset size 96x64\nset view labels\nset film sun\nset film-time 4\n"
              "set light-size 3\nwait done\nscreenshot film.png\nprint\n"
              "set film camera-orbit\nset film-play on\nwait 30\nset film-play off\nprint\n");
  ASSERT_EQ(commands.size(), 2u);
  for (const char* word : {"--light-azimuth", "--light-size 3"})
    EXPECT_NE(commands[0].find(word), std::string::npos) << commands[0];
  expect_labels("film.png", commands[0]);
  EXPECT_NE(commands[1].find("--camera-orbit"), std::string::npos) << commands[1];
  EXPECT_EQ(drive("floating-box", "set film no-such\n").exit_code, 3);
}

TEST_F(ViewLab, ThePicturesCanComeFromAnotherBackend) {
  const std::string script = "set panels off\nset size 96x64\nwait done\nprint\n";
  const Words said = printed("floating-box", script, {"--backend", "egl-software"});
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("--backend egl-software"), std::string::npos) << said[0];
  // Where there is no graphics card, both say so; where there is one, both draw.
  const Words hardware{"--backend", "egl-hardware"};
  EXPECT_EQ(
      drive("floating-box", script, hardware).exit_code,
      run(Words{"raster", "floating-box", "--size", "16x16", "-o", "card.png", "-q"} + hardware).exit_code);
}

TEST_F(ViewLab, EveryViewLayoutThemeAndScaleIsDrawnWithoutAnError) {
  std::string script = "set size 800x600\nset probe 100 100\nshow acne\nwait done\n";
  for (const char* view : {"raster", "raytrace", "difference", "labels", "truth", "gap", "texels", "depth"})
    script += fmt::format("set view {}\nwait 2\n", view);
  for (const char* look : {"layout swipe", "layout quad", "theme light", "zoom 8", "ui-scale 2",
                           "large-type on", "help on", "settings off", "results off", "panels off"})
    script += fmt::format("set {}\nwait 3\n", look);
  script += "open acne\nwait done\nkey F8\nkey V\nwait done\nscreenshot end.png\nsave-scene saved.json\n";
  printed("floating-box", script);
  EXPECT_EQ(texels("end.png").size(), 800u * 600u);
  EXPECT_EQ(run({"compare", "saved.json", "--size", "64x48", "--json", "-", "--runs", "1"}).exit_code, 0);
}

}  // namespace
}  // namespace gnomon::app_test
