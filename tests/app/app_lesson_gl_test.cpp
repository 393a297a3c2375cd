// A lesson's name as SCENE gives what the lesson's command gives, and options on the command line come first.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "report/lessons.h"
#include "scene/load.h"
#include "tests/support/app_process.h"

namespace gnomon::app_test {
namespace {

using nlohmann::json;

json result_of(Words words) {
  const TemporaryFolder folder;
  for (const char* word : {"--size", "64x36", "--runs", "1", "--json", "-", "--quiet", "-o"})
    words.emplace_back(word);
  words.push_back(folder / "out");
  const ProcessResult result = run_gnomon(words);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return json::parse(result.out, nullptr, false);
}

void expect_same_picture(const json& a, const json& b) {
  ASSERT_FALSE(a["lights"].empty());
  EXPECT_EQ(a["scene"], b["scene"]);
  for (const char* key : {"technique", "size", "bias", "filter", "depth_format"})
    EXPECT_EQ(a["lights"][0]["map"][key], b["lights"][0]["map"][key]) << key;
  EXPECT_EQ(a["lights"][0]["classes"], b["lights"][0]["classes"]);
}

TEST(Lessons, NameStandsForTheFirstCommand) {
  expect_same_picture(result_of({"compare", "acne"}),
                      result_of({"compare", "acne-floor", "--bias", "0", "--map-size", "64"}));
  expect_same_picture(result_of({"compare", "filtering"}),
                      result_of({"compare", "fence", "--technique", "pcf", "--filter-radius", "2"}));
}

TEST(Lessons, OptionsGivenComeFirst) {
  expect_same_picture(result_of({"compare", "acne", "--bias", "0.125"}),
                      result_of({"compare", "acne-floor", "--bias", "0.125", "--map-size", "64"}));
  expect_same_picture(result_of({"compare", "filtering", "--technique", "vsm"}),
                      result_of({"compare", "fence", "--technique", "vsm"}));
}

// What the tuner finds, a lesson does not narrow: of any error the smallest map, where the lesson has one of 128 texels.
TEST(Lessons, TheTunerFindsTheMapsOptionsItself) {
  for (const char* lesson : {"acne", "aliasing"}) {
    const ProcessResult result = run_gnomon({"tune", lesson, "--max-error", "wrong:100%", "--size", "64x36",
                                             "--runs", "1", "--json", "-", "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << lesson << ": " << result.err;
    const json answer = json::parse(result.out, nullptr, false);
    ASSERT_TRUE(answer.is_object()) << lesson;
    EXPECT_EQ(answer["options"]["map-size"], "64") << lesson;
  }
}

// The lesson on shimmer is about a film, which neither makes unless errors are to be flips.
TEST(Lessons, AFilmsOptionsHoldWhereAFilmIsMade) {
  const TemporaryFolder folder;
  const Words sweep = {"sweep",  "shimmer", "--size", "64x36",        "--map-size", "64,128",
                       "--runs", "1",       "-o",     folder / "out", "--quiet"};
  const ProcessResult still = run_gnomon(sweep);
  EXPECT_EQ(still.exit_code, 0) << still.err;
}

json bias_of(const Words& words) {
  return result_of(words)["lights"][0]["map"]["bias"];
}

TEST(SceneSettings, HoldWhereNoOptionSaysOtherwise) {
  expect_same_picture(result_of({"compare", "acne-floor"}),
                      result_of({"compare", "acne-floor", "--bias", "0"}));
  EXPECT_EQ(bias_of({"compare", "floating-box"})["constant_texels"], 1.0);
  EXPECT_EQ(bias_of({"compare", "floating-box"})["slope"], 0.0);
  const json sloped = bias_of({"compare", "floating-box", "--slope-bias", "1"});
  EXPECT_EQ(sloped["unit"], "auto") << "a bias of any kind replaces the scene's";
  EXPECT_EQ(bias_of({"compare", "floating-box", "--technique", "csm"})["slope"], 1.0);
  EXPECT_EQ(bias_of({"compare", "floating-box", "--technique", "hard"})["slope"], 0.0) << "the scene's own";
}

TEST(SceneSettings, WhatBecomesOfThemIsSaid) {
  const TemporaryFolder folder;
  const std::string scene = folder / "s.json";
  std::ofstream(scene)
      << R"({"schema": "gnomon/scene/1", "lights": [{"type": "directional", "direction": [0, -1, 0]}],
    "materials": [{"name": "m"}], "shapes": [{"material": "m", "sphere": {"center": [0, 0, 0], "radius": 1}}], "settings": {"map-size": "64"}})";
  const auto said = [&](const Words& words) {
    const ProcessResult result = run_gnomon(words + Words{scene, "--size", "32x18"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err;
  };
  const std::string asked = "the scene asks for --map-size 64";
  const std::string picture = folder / "a.png";
  EXPECT_NE(said({"raster", "-o", picture}).find(asked + ", where no option given here says otherwise"),
            std::string::npos);
  EXPECT_NE(
      said({"raster", "-o", picture, "--technique", "pcf"}).find(asked + "; another technique was given"),
      std::string::npos);
  EXPECT_NE(said({"raster", "-o", picture, "--technique", "hard"}).find("says otherwise"), std::string::npos);
  EXPECT_EQ(said({"raytrace", "-o", picture}).find("the scene asks for"), std::string::npos);
}

TEST(SceneSettings, ThatAreNoneAreErrors) {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& settings) {
    std::ofstream(folder / "s.json") << R"({"schema": "gnomon/scene/1", "shapes": [{"name": "p",
      "plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}}], "settings": )"
                                     << settings << "}";
    return run_gnomon({"compare", folder / "s.json", "--quiet"});
  };
  for (const char* wrong : {R"({"bais": "1"})", R"({"bias": "wide"})", R"({"bias": 1})", R"(["bias"])"}) {
    const ProcessResult result = said(wrong);
    EXPECT_EQ(result.exit_code, 3) << wrong << result.err;
    EXPECT_NE(result.err.find("settings"), std::string::npos) << result.err;
  }
  EXPECT_NE(said(R"({"map_size": "64"})")
                .err.find("s.json:2:86: settings.map_size: is no option of the shadow map; "
                          "did you mean \"map-size\"?"),
            std::string::npos)
      << said(R"({"map_size": "64"})").err;
  EXPECT_NE(said(R"({"bias": "wide"})").err.find("s.json:2:82: settings.bias: "), std::string::npos);
  EXPECT_NE(
      said(R"({"bias": 0.5})").err.find("s.json:2:82: settings.bias: wrong type (got 0.5, allowed a string)"),
      std::string::npos);
  EXPECT_NE(said(R"({"cascades": "3"})").err.find("s.json:2:86: settings.cascades: belongs to csm; "),
            std::string::npos);
}

TEST(Lessons, CommandsWithoutTheSettingsTakeTheScene) {
  EXPECT_EQ(run_gnomon({"plan", "acne"}).out, run_gnomon({"plan", "acne-floor"}).out);
  EXPECT_EQ(run_gnomon({"plan", "acnee"}).exit_code, 3);
}

TEST(Lessons, AreNoSceneNames) {
  for (const report::Lesson& lesson : report::all_lessons())
    EXPECT_FALSE(find_builtin_scene(lesson.name)) << lesson.name << " names two things";
}

TEST(Lessons, UserIsToldTheCommand) {
  const ProcessResult result = run_gnomon({"plan", "peter-panning"});
  EXPECT_NE(result.err.find("gnomon compare floating-box --bias 0.6"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace gnomon::app_test
