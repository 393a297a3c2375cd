// gnomon tune of scenes with several lights: one bias is asked for, and each light draws it with its own texels. What is
// promised of a setting is what its command gives, of every light.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/program_process.h"

namespace gnomon::test {
namespace {

using Json = nlohmann::ordered_json;

class TuneLights : public SweepProgram {
 protected:
  /// Two boxes on a floor under these lights.
  std::string scene_under(const Json& lights) const {
    const std::string path = (root / "scene.json").string();
    std::ofstream(path) << Json{
        {"schema", "gnomon/scene/1"},
        {"camera", {{"eye", {4, 3, 5}}, {"target", {0, 0.3, 0}}, {"vertical_fov_degrees", 40}}},
        {"lights", lights},
        {"materials", {{{"name", "grey"}}}},
        {"meshes",
         {{{"name", "box"}, {"generate", {{"kind", "box"}, {"size", {0.6, 0.6, 0.6}}}}},
          {{"name", "floor"},
           {"vertices", {{-20, 0, -20}, {-20, 0, 20}, {20, 0, 20}, {20, 0, -20}}},
           {"triangles", {{0, 1, 2}, {0, 2, 3}}}}}},
        {"instances",
         {{{"mesh", "box"}, {"material", "grey"}, {"translate", {0, 0.3, 0}}},
          {{"mesh", "floor"}, {"material", "grey"}},
          {{"mesh", "box"}, {"material", "grey"}, {"translate", {1.5, 0.3, -0.5}}}}}};
    return path;
  }

  /// The exit code of tune, and its answer.
  std::pair<int, Json> tune(const std::string& scene, const Words& more) const {
    const std::string json = (root / "answer.json").string();
    Words words{"tune", scene, "--size", "96x64", "--runs", "1", "-q", "--json", json};
    words.insert(words.end(), more.begin(), more.end());
    const int code = run(words);
    const std::string text = bytes_of(json);
    if (text.empty()) ADD_FAILURE() << said();
    return {code, text.empty() ? Json() : Json::parse(text)};
  }

  /// The exit code of an answer's command, and its result.
  std::pair<int, Json> compare(const Json& family, const Words& more = {}) const {
    std::istringstream command(family["command"].get<std::string>());
    Words words;
    for (std::string word; command >> word;) words.push_back(word);
    words.erase(words.begin());
    const std::string json = (root / "result.json").string();
    words.insert(words.end(), {"--runs", "1", "-q", "--json", json});
    words.insert(words.end(), more.begin(), more.end());
    const int code = run(words);
    return {code, Json::parse(bytes_of(json))};
  }

  /// Expects that the winner and all others keep what they promise.
  void expect_kept_promises(const Json& answer, std::string_view figure) const {
    Json families = answer["others"];
    families.push_back(answer);
    for (const Json& family : families) {
      const auto [code, result] = compare(family);
      EXPECT_EQ(code, 0) << said();
      double error = 0.0;
      for (const Json& light : result["lights"])
        error = std::max(error, light["error"][figure].get<double>());
      EXPECT_EQ(family["error"].get<double>(), error) << family["command"];
    }
  }
};

/// One texel of the sun's map is 35 times as wide as one of the lamp's.
const Json lamp{{"name", "lamp"},      {"type", "spot"},
                {"intensity", 20},     {"position", {0.5, 2, 0.5}},
                {"target", {0, 0, 0}}, {"outer_angle_degrees", 15}};
const Json sun{{"name", "sun"}, {"type", "directional"}, {"intensity", 2}, {"direction", {-1.0, -1.0, -0.4}}};

TEST_F(TuneLights, AGoalIsMetInAnyOrderOfTheLights) {
  const Words goal{"--technique",     "pcf", "--filter-plane", "off",    "--map-size", "128",
                   "--normal-offset", "1",   "--max-error",    "mean:6%"};
  for (const Json& lights : {Json{lamp, sun}, Json{sun, lamp}}) {
    const auto [code, answer] = tune(scene_under(lights), goal);
    EXPECT_EQ(code, 0) << lights[0]["name"] << " first: " << answer["why"];
    EXPECT_LE(answer["error"].get<double>(), 0.06);
    EXPECT_EQ(compare(answer, {"--fail-above", "mean:6%"}).first, 0) << answer["command"];
    expect_kept_promises(answer, "mean_absolute");
  }
}

// Where a bias is tried, and where a drawing tells the error of every bias. Nothing meets this goal: the others are not
// drawn a second time at what is said of them.
TEST_F(TuneLights, CommandsGiveTheErrorsPromised) {
  const auto [code, answer] = tune(
      scene_under({lamp, sun}),
      {"--technique", "hard,pcf", "--filter-plane", "off", "--map-size", "128", "--max-error", "mean:0"});
  EXPECT_EQ(code, 1);
  EXPECT_GE(answer["others"].size(), 7u);
  expect_kept_promises(answer, "mean_absolute");
}

// A constant in texels is one of each light's own cascade, or place in a warped map.
TEST_F(TuneLights, CommandsGiveTheErrorsPromisedWhereBiasesScale) {
  Json low = sun;
  low["name"] = "low sun", low["direction"] = {1.0, -0.15, 0.3};
  const auto [code, answer] =
      tune(scene_under({sun, low}), {"--technique", "csm,lispsm", "--cascade-blend", "0,0.2", "--map-size",
                                     "128", "--max-error", "wrong:0"});
  EXPECT_EQ(code, 1);
  EXPECT_GE(answer["others"].size(), 8u);
  expect_kept_promises(answer, "wrong_fraction");
}

// The lamp has the larger error; too many pixels of the bulb are uncertain to say that they are right.
TEST_F(TuneLights, EveryLightHasToBeCertainEnough) {
  const Json lights{{{"name", "bulb"},
                     {"type", "point"},
                     {"intensity", 20},
                     {"position", {-1.5, 1.8, 0.3}},
                     {"sphere", {{"radius", 0.3}}},
                     {"shadow_samples", 4}},
                    {{"name", "lamp"}, {"type", "point"}, {"intensity", 20}, {"position", {-0.7, 2.3, 3.0}}}};
  const std::string scene = scene_under(lights);
  const Words setting{"--technique", "hard", "--slope-bias", "1", "--map-size", "32", "--max-error"};
  const auto tune_to = [&](const char* goal) {
    Words words = setting;
    words.emplace_back(goal);
    return tune(scene, words);
  };
  const auto [code, answer] = tune_to("2%");
  EXPECT_EQ(code, 1);
  EXPECT_FALSE(answer["feasible"]);
  EXPECT_LE(answer["error"].get<double>(), 0.02);
  EXPECT_NE(answer["why"].get<std::string>().find("pixels of one light are uncertain"), std::string::npos)
      << answer["why"];
  EXPECT_EQ(compare(answer, {"--fail-above", "2%"}).first, 1);
  const auto [mean_code, by_mean] = tune_to("mean:2%");  // means know the visibility of those pixels
  EXPECT_EQ(mean_code, 0) << by_mean["why"];
  EXPECT_EQ(compare(by_mean, {"--fail-above", "mean:2%"}).first, 0);
}

}  // namespace
}  // namespace gnomon::test
