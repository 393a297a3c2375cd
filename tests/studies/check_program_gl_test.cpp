// gnomon check on a repository of six scenes: limits, a baseline, views, places of values, and what is wrong in a configuration.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/app_process.h"
#include "tests/support/places.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* configuration = R"(baseline = "baseline"
[settings]
size = "96x54"
map-size = 512
[limits]
fail-above = "wrong:40%"
fail-worse = "0.1%"
[[scene]]
file = "scenes/fence.json"
[[scene]]
file = "scenes/acne-floor.json"
settings = { map-size = 128, bias = "1texel", snap = true }
[[scene]]
file = "scenes/thin-wall.json"
  [[scene.view]]
  name = "door"
  settings = { camera-orbit = [20, 20] }
  [[scene.view]]
  name = "above"
  settings = { camera-orbit = "0,60" }
[[scene]]
file = "scenes/floating-box.json"
name = "box"
limits = { fail-above = "mean:50%" }
[[scene]]
file = "scenes/wires.json"
[[scene]]
file = "scenes/penumbra.json"
settings = { technique = "pcf", samples = 16 }
)";

class CheckProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(at("scenes"));
    for (const char* name : {"fence", "acne-floor", "thin-wall", "floating-box", "wires", "penumbra"})
      fs::copy(test::source_dir() + "/scene/builtin/" + name + ".json", at("scenes"));
    write_text(at("gnomon.toml"), configuration);
  }
  std::string at(const std::string& name) const { return folder_.path() + "/" + name; }
  ProcessResult check(const Words& more = {}) const {
    return run_gnomon(Words{"check"} + more, {.folder = folder_.path()});
  }
  Json document(const std::string& name = "out/check/check.json") const {
    return Json::parse(read_file(at(name)));
  }
  void replace(const std::string& old, const std::string& now) const {
    std::string text = configuration;
    const std::size_t place = text.find(old);
    ASSERT_NE(place, std::string::npos) << old;
    write_text(at("gnomon.toml"), text.replace(place, old.size(), now));
  }

  const TemporaryFolder folder_;
};

TEST_F(CheckProgram, HoldsEverySceneAgainstItsLimitsAndTheBaseline) {
  const ProcessResult first = check();
  ASSERT_EQ(first.exit_code, 0) << first.err << first.out;
  const Json before = document();
  EXPECT_EQ(before["schema"], "gnomon/check/1");
  ASSERT_EQ(before["runs"].size(), 7u);
  EXPECT_EQ(before["runs"][3]["name"], "thin-wall-above");
  for (const Json& run : before["runs"])
    EXPECT_TRUE(run["verdict"] == "kept" && run["trend"].is_null()) << run;
  fs::rename(at("out/check"), at("baseline"));
  // A week later: one scene is drawn worse, one has another name, and one is new.
  replace(R"(settings = { map-size = 128, bias = "1texel", snap = true })",
          "settings = { map-size = 128, bias = 0, slope-bias = 0 }");
  fs::rename(at("scenes/wires.json"), at("scenes/cables.json"));
  std::string text = read_file(at("gnomon.toml"));
  text.replace(text.find("wires.json\""), 11, "cables.json\"\nname = \"wires\"");
  write_text(at("gnomon.toml"), text + "[[scene]]\nfile = \"courtyard\"\n");
  const ProcessResult second = check({"--annotate", "junit:shadows.xml", "--jobs", "3"});
  EXPECT_EQ(second.exit_code, 1) << second.err << second.out;
  const Json runs = document()["runs"];
  EXPECT_EQ(runs[1]["verdict"], "exceeded");
  EXPECT_EQ(runs[1]["trend"], "worse");
  EXPECT_EQ(runs[5]["trend"], "same") << "the same scene under another name";
  EXPECT_TRUE(runs[7]["trend"].is_null());
  for (const int kept : {0, 2, 3, 4, 5, 6, 7}) EXPECT_EQ(runs[kept]["verdict"], "kept") << runs[kept];
  const std::string xml = read_file(at("shadows.xml"));
  EXPECT_NE(xml.find("tests=\"8\" failures=\"1\" errors=\"0\""), std::string::npos) << xml;
  const std::string page = read_file(at("out/check/report.html"));
  EXPECT_NE(page.find("acne-floor/diff/report.html"), std::string::npos);
  EXPECT_TRUE(fs::exists(at("out/check/acne-floor/diff/report.html")) &&
              fs::exists(at("out/check/fence/report.html")));
}

TEST_F(CheckProgram, WritesOverNoBaselineUnasked) {
  const ProcessResult over = check({"fence", "-o", "baseline"});
  EXPECT_EQ(over.exit_code, 2);
  EXPECT_NE(over.err.find("--baseline none"), std::string::npos) << over.err;
  EXPECT_EQ(check({"fence", "-o", "baseline", "--baseline", "none", "--quiet"}).exit_code, 0);
}

// Of two lights the one that exceeds the limit, whichever has more wrong pixels.
TEST_F(CheckProgram, NamesTheFiguresThatExceedTheLimit) {
  Json scene = Json::parse(read_file(at("scenes/penumbra.json")), nullptr, false, true);
  scene["lights"].push_back({{"type", "point"}, {"position", {1.5, 4, 1}}, {"intensity", 20}});
  write_text(at("scenes/two.json"), scene.dump());
  write_text(at("gnomon.toml"), R"([[scene]]
file = "scenes/two.json"
settings = { size = "96x54", technique = "pcf", map-size = 256 }
limits = { fail-above = "mean:1%" }
)");
  ASSERT_EQ(check().exit_code, 1);
  const Json run = document()["runs"][0];
  EXPECT_GT(run["mean_absolute"].get<double>(), 0.01) << run;
}

TEST_F(CheckProgram, GoesOnWhereItWasInterrupted) {
  ASSERT_EQ(check({"fence", "box", "--quiet"}).exit_code, 0);
  const std::string before = read_file(at("out/check/fence/result.json"));
  ASSERT_EQ(check({"--resume", "--quiet"}).exit_code, 0);
  EXPECT_EQ(read_file(at("out/check/fence/result.json")), before);
  Json runs = document()["runs"];
  EXPECT_TRUE(runs[0]["was_there"] && runs[4]["was_there"] && !runs[1]["was_there"]) << runs;
  write_text(at("scenes/fence.json"), read_file(at("scenes/fence.json")) + "\n");
  replace("fail-above = \"mean:50%\"", "fail-above = \"mean:60%\"");
  ASSERT_EQ(check({"--resume", "--quiet", "fence", "box", "wires"}).exit_code, 0);
  runs = document()["runs"];
  EXPECT_TRUE(!runs[0]["was_there"] && !runs[1]["was_there"] && runs[2]["was_there"]) << runs;
}

TEST_F(CheckProgram, SaysWhereEachValueStands) {
  const ProcessResult said = check({"acne-floor", "--explain"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  for (const char* line : {"file                 scenes/acne-floor.json   gnomon.toml:11:8",
                           "size                 96x54                    gnomon.toml:3:8",
                           "map-size             128                      gnomon.toml:12:25",
                           "fail-worse           0.1%                     gnomon.toml:7:14"})
    EXPECT_NE(said.out.find(line), std::string::npos) << line << "\nin\n" << said.out;
  EXPECT_FALSE(fs::exists(at("out")));
}

TEST_F(CheckProgram, RefusesWhatItDoesNotKnow) {
  const auto refused = [&](const std::string& old, const std::string& now, const std::string& part) {
    replace(old, now);
    expect_one_line(check(), 3, part);
  };
  refused("baseline =", "baselin =", "gnomon.toml:1:1: baselin: unknown key; did you mean baseline?");
  refused("map-size = 512", "map-sise = 512",
          "gnomon.toml:4:12: settings.map-sise: unknown option --map-sise; did you mean --map-size?");
  refused("map-size = 512", "resolution = 512", "did you mean --size?");
  refused("map-size = 512", "map-size = \"many\"", "gnomon.toml:4:12: settings.map-size: ");
  refused("map-size = 512", "fail-above = \"1%\"", "settings.fail-above: is a limit, and belongs to limits");
  refused("snap = true", "snap = \"perhaps\"", "not a switch's value (got perhaps, allowed true, false)");
  refused("fail-worse", "fail-wors", "limits.fail-wors: unknown key; did you mean fail-worse?");
  refused("\"wrong:40%\"", "1", "gnomon.toml:6:14: limits.fail-above: ");
  refused("name = \"box\"", "name = \"../box\"", "not a name of a folder");
  refused("name = \"box\"", "name = \"Fence\"", "two runs are called Fence");
  refused("[[scene]]", "[[scene]", "gnomon.toml:8:");
}

TEST_F(CheckProgram, GoesOnPastASceneThatCannotBeRead) {
  fs::remove(at("scenes/fence.json"));
  const ProcessResult said = check({"fence", "box", "--annotate", "github"});
  EXPECT_EQ(said.exit_code, 3) << said.err;
  const Json runs = document()["runs"];
  EXPECT_EQ(runs[0]["verdict"], "failed");
  EXPECT_EQ(runs[1]["verdict"], "kept");
  EXPECT_NE(said.err.find("::error title=scenes/fence.json%2C fence::"), std::string::npos) << said.err;
  EXPECT_EQ(check({"fense"}).exit_code, 2);
}

}  // namespace
}  // namespace gnomon::app_test
