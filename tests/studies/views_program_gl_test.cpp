// A setting judged from several views by compare, sweep and tune: what holds of each view alone, and by which of them it is
// judged.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/program_process.h"

namespace gnomon::test {
namespace {

// From near by a map is coarser on the screen than from afar; the third camera looks at nothing.
constexpr const char* level = R"({
  "schema": "gnomon/scene/1",
  "name": "level",
  "cameras": [
    {"name": "far", "eye": [0, 30, 40], "target": [0, 0, 0]},
    {"name": "near", "eye": [2.5, 1.5, 4], "target": [1, 0, 0]},
    {"name": "sky", "eye": [0, 5, 0], "target": [0, 50, 1]}
  ],
  "lights": [{"name": "sun", "type": "directional", "direction": [-0.8, -1, -0.45]}],
  "materials": [{"name": "grey"}],
  "shapes": [
    {"name": "floor", "plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}, "material": "grey"},
    {"name": "ball", "sphere": {"center": [0, 1, 0], "radius": 1}, "material": "grey"},
    {"name": "other", "sphere": {"center": [-6, 1.5, -4], "radius": 1.5}, "material": "grey"}
  ]
})";

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Writes a number as it is given on the command line.
std::string text_of(const nlohmann::json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

class Views : public SweepProgram {
 protected:
  void SetUp() override {
    SweepProgram::SetUp();
    scene = (root / "level.json").string();
    std::ofstream(scene) << level;
  }
  nlohmann::json compared(const Words& more) {
    const std::string out = (root / "one").string();
    EXPECT_EQ(run(Words{"compare", scene, "-o", out, "--no-report"} + setting + more), 0) << said();
    return nlohmann::json::parse(bytes_of(out + "/result.json"));
  }
  static double error_of(const nlohmann::json& result) {
    const nlohmann::json& error = result["lights"][0]["error"];
    return std::max(error["wrong_fraction"].get<double>(), error["mean_absolute"].get<double>());
  }

  std::string scene;
  const Words setting{"--size", "120x80", "--map-size", "128"};
};

TEST_F(Views, CompareIsThatOfTheWorstCamera) {
  const double far = error_of(compared({"--camera", "far"}));
  const nlohmann::json near = compared({"--camera", "near"}), all = compared({"--cameras", "all"});
  ASSERT_GT(error_of(near), far);
  const nlohmann::json& views = all["views"];
  EXPECT_EQ(views["measure"], "wrong and mean");
  EXPECT_EQ(views["worst"], "near");
  ASSERT_EQ(views["each"].size(), 3u);
  EXPECT_EQ(views["each"][0]["error"], far);
  EXPECT_EQ(views["each"][1]["error"], error_of(near));
  EXPECT_EQ(views["each"][1]["light"], "sun");
  EXPECT_TRUE(views["each"][2]["error"].is_null()) << "nothing is seen there";
  EXPECT_DOUBLE_EQ(views["mean_error"], 0.5 * (far + error_of(near)));
  EXPECT_EQ(all["lights"][0]["error"], near["lights"][0]["error"]);
  EXPECT_EQ(all["lights"][0]["classes"], near["lights"][0]["classes"]);
  EXPECT_NE(said().find("Worst of 3 views: near, "), std::string::npos) << said();
}

// The squares have every compared pixel of every view, and all that they are off by.
TEST_F(Views, PlacesHoldTheErrorsOfAllViews) {
  const nlohmann::json far = compared({"--camera", "far"}), near = compared({"--camera", "near"});
  const nlohmann::json places = compared({"--cameras", "all"})["views"]["places"];
  double pixels = places["pixels_beyond"], error = pixels * places["mean_absolute_beyond"].get<double>();
  double most = 0.0, at_worst = 0.0;
  for (const nlohmann::json& cell : places["cells"]) {
    const double sum = cell[2].get<double>() * cell[3].get<double>();
    pixels += cell[2].get<double>(), error += sum, most = std::max(most, sum);
    if (cell[0] == places["worst"][0] && cell[1] == places["worst"][1]) at_worst = sum;
  }
  double compared_pixels = 0.0, all_error = 0.0;
  for (const nlohmann::json& view : {far, near}) {
    const nlohmann::json& light = view["lights"][0];
    const double count = light["pixels"]["compared"];
    compared_pixels += count, all_error += count * light["error"]["mean_absolute"].get<double>();
  }
  EXPECT_EQ(pixels, compared_pixels);
  const double rounding = 1e-5 * compared_pixels;
  EXPECT_NEAR(error, all_error, rounding);
  EXPECT_NEAR(at_worst, most, rounding);
  EXPECT_NEAR(places["worst_share"].get<double>(), most / all_error, rounding / all_error);
}

// Of hard shadows those that lie outside the map are what is wrong there; the map's corners are its window's.
TEST_F(Views, AWindowsCornersAndWhatLiesOutsideIt) {
  const nlohmann::json result = compared({"--camera", "far", "--window-size", "4,3"});
  const nlohmann::json &light = result["lights"][0], &outside = light["outside_map"];
  EXPECT_GT(outside["shadowed"], 0);
  EXPECT_GT(outside["receivers"], outside["shadowed"]);
  EXPECT_EQ(outside["shadowed"], light["classes"]["outside_map"]);
  const nlohmann::json &window = light["map"]["window"], &corners = light["map"]["windows"][0];
  const auto apart = [&](int a, int b) {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) sum += std::pow(corners[a][k].get<double>() - corners[b][k].get<double>(), 2);
    return std::sqrt(sum);
  };
  EXPECT_NEAR(apart(0, 1), 4.0, 1e-9);
  EXPECT_NEAR(apart(1, 2), 3.0, 1e-9);
  EXPECT_NEAR(apart(2, 6), window["far"].get<double>() - window["near"].get<double>(), 1e-9);
  EXPECT_NE(said().find("is shadow that is lost."), std::string::npos) << said();
}

TEST_F(Views, LimitsHoldForTheWorst) {
  const double far = error_of(compared({"--camera", "far"})), near = error_of(compared({"--camera", "near"}));
  const std::string between = std::to_string(50.0 * (far + near)) + "%";
  const Words words =
      Words{"compare", scene, "-o", (root / "one").string(), "--no-report", "--fail-above", between} +
      setting;
  EXPECT_EQ(run(words + Words{"--cameras", "far"}), 0) << said();
  EXPECT_EQ(run(words + Words{"--cameras", "far,near"}), 1) << said();
}

TEST_F(Views, SweepsCellsAreThoseOfCompare) {
  const std::string out = (root / "sweep").string();
  ASSERT_EQ(run({"sweep", scene, "-o", out, "--size", "120x80", "--map-size", "64,128", "--bias", "0,0.02",
                 "--cameras", "far,near", "--runs", "1"}),
            0)
      << said();
  std::istringstream lines(bytes_of(out + "/sweep.jsonl"));
  std::string line;
  std::size_t cells = 0;
  while (std::getline(lines, line)) {
    const nlohmann::json cell = nlohmann::json::parse(line);
    if (!cell.contains("axes")) continue;
    ++cells;
    const std::string out_of_one = (root / "cell").string();
    ASSERT_EQ(run({"compare", scene, "-o", out_of_one, "--no-report", "--size", "120x80", "--map-size",
                   text_of(cell["axes"]["map_size"]), "--bias", text_of(cell["axes"]["bias"]), "--cameras",
                   "far,near"}),
              0)
        << said();
    nlohmann::json one = nlohmann::json::parse(bytes_of(out_of_one + "/result.json"));
    one["views"].erase("places");  // a cell's line goes without
    EXPECT_EQ(cell["views"], one["views"]);
    EXPECT_EQ(cell["lights"][0]["error"]["wrong"], one["lights"][0]["error"]["wrong"]);
    EXPECT_NE(cell["command"].get<std::string>().find("--cameras far,near"), std::string::npos);
  }
  EXPECT_EQ(cells, 4u);
}

TEST_F(Views, TunesAnswerKeepsItsWordFromEveryCamera) {
  const std::string json = (root / "answer.json").string();
  const Words words{"tune", scene,        "--size",     "120x80", "--max-error", "wrong:0.1%", "--technique",
                    "hard", "--map-size", "64:1024:x2", "--runs", "1",           "--json",     json};
  ASSERT_EQ(run(words + Words{"--camera", "far"}), 0) << said();
  const int alone = nlohmann::json::parse(bytes_of(json))["options"]["map-size"] == "64" ? 64 : 0;
  ASSERT_EQ(run(words + Words{"--cameras", "far,near"}), 0) << said();
  const nlohmann::json answer = nlohmann::json::parse(bytes_of(json));
  EXPECT_EQ(answer["views"]["worst"], "near");
  EXPECT_LE(answer["error"].get<double>(), 0.001);
  EXPECT_GT(std::stoi(answer["options"]["map-size"].get<std::string>()), alone);
  EXPECT_NE(answer["command"].get<std::string>().find("--cameras far,near"), std::string::npos);
  for (const char* camera : {"far", "near"}) {
    Words check{"compare", scene,          "-o",        (root / "one").string(), "--no-report", "--camera",
                camera,    "--fail-above", "wrong:0.1%"};
    for (const auto& [name, value] : answer["options"].items())
      if (value != "off") {
        check.push_back("--" + name);
        if (value != "on") check.push_back(value);
      }
    EXPECT_EQ(run(check), 0) << camera << ": " << said();
  }
}

TEST_F(Views, PathsBeginAtTheCameraAndEndWithTheFilm) {
  const nlohmann::json own = compared({"--camera", "near"});
  const nlohmann::json along =
      compared({"--camera", "near", "--path", "walk", "--frames", "31", "--fps", "10", "--views", "3"});
  const nlohmann::json& each = along["views"]["each"];
  ASSERT_EQ(each.size(), 3u);
  EXPECT_EQ(each[0]["view"], "walk at 0 s");
  EXPECT_EQ(each[0]["error"], error_of(own));
  EXPECT_EQ(each[1]["view"], "walk at 1.5 s");
  EXPECT_EQ(each[2]["view"], "walk at 3 s");
  EXPECT_NE(each[2]["error"], each[0]["error"]);
}

TEST_F(Views, WhatContradictsIsRefused) {
  for (const Words& more : {Words{"--cameras", "all", "--camera", "near"},
                            Words{"--cameras", "all", "--path", "walk"}, Words{"--cameras", "nowhere"},
                            Words{"--views", "3"}, Words{"--cameras", "all", "--camera-orbit", "10,20"},
                            Words{"--frames", "10"}, Words{"--path", "drift"}})
    EXPECT_EQ(run(Words{"compare", scene, "-o", (root / "no").string(), "--no-report"} + setting + more), 2)
        << more.back() << ": " << said();
}

}  // namespace
}  // namespace gnomon::test
