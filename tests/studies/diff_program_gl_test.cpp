// gnomon diff on pairs of results whose answer is known: the same, better, worse, other by chance alone, not comparable.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/support/app_process.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Results that the pairs share, each made once: compare's words by the name of its folder.
const std::map<std::string, Words>& settings() {
  static const Words fence{"fence", "--size", "160x90"}, lamp{"penumbra", "--size", "160x90"};
  static const Words rays = lamp + Words{"--technique", "rays"}, pcf = lamp + Words{"--technique", "pcf"};
  static const std::map<std::string, Words> all{
      {"fence", fence},
      {"again", fence},
      {"coarse", fence + Words{"--map-size", "256"}},
      {"fine", fence + Words{"--map-size", "4096"}},
      {"acne", fence + Words{"--bias", "0", "--slope-bias", "0"}},
      {"loose", fence + Words{"--bias", "20texel"}},
      {"noseed", fence + Words{"--seed", "9"}},
      {"wide", {"fence", "--size", "192x90"}},
      {"turned", fence + Words{"--light-azimuth", "40"}},
      {"other", {"courtyard", "--size", "160x90"}},
      {"pcf", pcf},
      {"pcf-1", pcf + Words{"--seed", "1"}},
      {"pcf-2", pcf + Words{"--seed", "2"}},
      {"pcf-few", pcf + Words{"--samples", "64"}},
      {"pcf-wide", pcf + Words{"--filter-radius", "12"}},
      {"pcf-hard", lamp + Words{"--technique", "hard"}},
      {"rays", rays},
      {"rays-1", rays + Words{"--seed", "1"}},
      {"rays-2", rays + Words{"--seed", "2"}},
      {"rays-raw", rays + Words{"--denoiser", "none"}},
      {"raw-1", rays + Words{"--denoiser", "none", "--seed", "1"}},
  };
  return all;
}

class DiffProgram : public ::testing::Test {
 protected:
  /// A folder of that name.
  static std::string result(const std::string& name) {
    static const TemporaryFolder folder;
    const std::string path = folder.path() + "/" + name;
    if (!fs::exists(path)) {
      const ProcessResult made =
          run_gnomon(Words{"compare"} + settings().at(name) + Words{"--no-report", "--quiet", "-o", path});
      EXPECT_EQ(made.exit_code, 0) << made.err;
    }
    return path;
  }
  static ProcessResult diff(const std::string& before, const std::string& after, const Words& more = {}) {
    return run_gnomon(Words{"diff", result(before), result(after)} + more);
  }
  static Json diff_json(const std::string& before, const std::string& after, const Words& more = {}) {
    const ProcessResult made = diff(before, after, more + Words{"--json", "-"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return Json::parse(made.out, nullptr, false);
  }
};

struct Pair {
  std::string before, after, trend;
};

TEST_F(DiffProgram, NoVerdictIsWrong) {
  const std::string same = "same", chance = "not told from chance", better = "better", worse = "worse";
  for (const auto& [before, after, trend] :
       {Pair{"fence", "fence", same}, {"fence", "again", same},     {"fence", "noseed", same},
        {"pcf", "pcf", same},         {"rays", "rays", same},       {"coarse", "fence", better},
        {"fence", "fine", better},    {"acne", "fence", better},    {"pcf-hard", "pcf", better},
        {"fence", "coarse", worse},   {"fine", "fence", worse},     {"fence", "acne", worse},
        {"fence", "loose", worse},    {"pcf", "pcf-hard", worse},   {"rays", "rays-raw", worse},
        {"pcf", "pcf-1", chance},     {"pcf-1", "pcf-2", chance},   {"pcf", "pcf-few", chance},
        {"rays", "rays-1", chance},   {"rays-1", "rays-2", chance}, {"rays-raw", "raw-1", chance}})
    EXPECT_EQ(diff_json(before, after).value("trend", ""), trend) << before << " and " << after;
}

// Noise has a spread that is less than what a denoiser is good for.
TEST_F(DiffProgram, TellsMoreThanNoise) {
  const Json light = diff_json("rays", "rays-raw")["lights"][0];
  for (const Json& figure : light["figures"])
    if (figure["key"] == "error.wrong_fraction" || figure["key"] == "error.mean_absolute") {
      EXPECT_EQ(figure["trend"], "worse") << figure;
    }
}

TEST_F(DiffProgram, RefusesWhatShowsSomethingElse) {
  for (const auto& [after, why] : {std::pair{"other", "another scene"},
                                   {"wide", "other sizes (160x90; 192x90)"},
                                   {"turned", "light sun is another"}})
    expect_one_line(diff("fence", after), 3, why);
}

TEST_F(DiffProgram, CountsPixelsByWhatTheyWere) {
  const Json there = diff_json("fence", "acne"), back = diff_json("acne", "fence");
  const Json pixels = there["lights"][0]["pixels"];
  EXPECT_EQ(pixels["new"], back["lights"][0]["pixels"]["fixed"]);
  EXPECT_EQ(pixels["fixed"], back["lights"][0]["pixels"]["new"]);
  EXPECT_EQ(pixels["same"], back["lights"][0]["pixels"]["same"]);
  std::map<std::string, std::uint64_t> sums;
  bool acne = false;
  for (const Json& label : there["lights"][0]["labels"]) {
    for (const char* key : {"new", "fixed", "same", "before", "after"})
      sums[key] += label[key].get<std::uint64_t>();
    acne |= label["label"] == "acne" && label["new"] > 100;
  }
  EXPECT_TRUE(acne) << there;
  for (const char* key : {"new", "fixed", "same"}) EXPECT_EQ(sums[key], pixels[key]);
  EXPECT_EQ(sums["after"], sums["new"] + sums["same"]);
  EXPECT_EQ(sums["before"], sums["fixed"] + sums["same"]);
}

TEST_F(DiffProgram, FailsWhereItIsWorseThanTheLimit) {
  const Words limit{"--quiet", "--fail-worse", "0.1%"};
  EXPECT_EQ(diff("fence", "again", limit).exit_code, 0);
  EXPECT_EQ(diff("fence", "fine", limit).exit_code, 0);
  EXPECT_EQ(diff("pcf", "pcf-1", {"--quiet", "--fail-worse", "0.0001%"}).exit_code, 0);
  const ProcessResult worse = diff("fence", "coarse", {"--fail-worse", "0.1%"});
  EXPECT_EQ(worse.exit_code, 1);
  EXPECT_NE(worse.err.find("more than --fail-worse 0.1% allows"), std::string::npos) << worse.err;
  EXPECT_EQ(diff("fence", "coarse", {"--quiet", "--fail-worse", "50%"}).exit_code, 0);
  EXPECT_EQ(diff("rays", "rays-1", {"--quiet", "--fail-worse", "flip:0.00001"}).exit_code, 0)
      << "chance fails nothing";
  const ProcessResult unknown = diff("pcf", "rays", {"--fail-worse", "edge:0.1texel"});
  EXPECT_EQ(unknown.exit_code, 3) << "few rays have no texels";
  EXPECT_NE(unknown.err.find("not in both results"), std::string::npos) << unknown.err;
  // Both in texels of the map now: by a finer map's own texels its edges would be called worse.
  EXPECT_EQ(diff("fence", "fine", {"--quiet", "--fail-worse", "edge:0.1texel"}).exit_code, 0);
  EXPECT_EQ(diff("fence", "coarse", {"--quiet", "--fail-worse", "edge:0.1texel"}).exit_code, 1);
  expect_one_line(diff("fence", "coarse", {"--fail-worse", "1"}), 2, "1%");
}

TEST_F(DiffProgram, TakesABaselineAndWritesAPage) {
  const TemporaryFolder out;
  const std::string folder = out.path() + "/diff", json = out.path() + "/copy.json";
  const ProcessResult made = run_gnomon({"diff", result("coarse") + "/result.json", "--baseline",
                                         result("fence"), "-o", folder, "--json", json});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Json document = Json::parse(read_file(folder + "/diff.json"));
  EXPECT_EQ(document["schema"], "gnomon/diff/1");
  EXPECT_EQ(document["changed"][0], Json({{"key", "size"}, {"before", "1024"}, {"after", "256"}}));
  EXPECT_EQ(read_file(json), read_file(folder + "/diff.json"));
  const std::string page = read_file(folder + "/report.html");
  for (const char* part : {"fence: worse", "Which wrong pixels are new", "aliasing", "data:image/png"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(page.find("<script"), std::string::npos);
}

// A scene is known by its bytes; one that was edited is compared where that is asked for.
TEST_F(DiffProgram, KnowsARenamedSceneAndAChangedOne) {
  const TemporaryFolder out;
  const std::string text = R"({"schema": "gnomon/scene/1", "name": "hall",
    "camera": {"eye": [0, 3, 6], "target": [0, 0.5, 0]},
    "lights": [{"name": "sun", "type": "directional", "direction": [-1, -2, -1], "intensity": [3, 3, 3]}],
    "materials": [{"name": "grey", "diffuse": [0.5, 0.5, 0.5]}],
    "shapes": [{"plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}, "material": "grey"},
               {"sphere": {"center": [0, 1, 0], "radius": 1}, "material": "grey"}]})";
  const auto made = [&](const std::string& name, const std::string& scene) {
    write_text(out.path() + "/" + name + ".json", scene);
    return run_gnomon(Words{"compare", out.path() + "/" + name + ".json", "--no-report", "--quiet", "-o",
                            out.path() + "/" + name} +
                      small);
  };
  const auto first = made("hall", text);
  if (first.exit_code != 0) GTEST_FAIL() << first.err;
  ASSERT_EQ(made("foyer", text).exit_code, 0);
  const auto compared = [&](const std::string& a, const std::string& b, const Words& more) {
    return run_gnomon(Words{"diff", out.path() + "/" + a, out.path() + "/" + b} + more);
  };
  EXPECT_EQ(compared("hall", "foyer", {}).exit_code, 0);
  fs::rename(out.path() + "/hall", out.path() + "/before");
  ASSERT_EQ(made("hall", text + "\n").exit_code, 0);
  expect_one_line(compared("before", "hall", {}), 3, "--changed-scene");
  EXPECT_EQ(compared("before", "hall", {"--changed-scene"}).exit_code, 0);
}

TEST_F(DiffProgram, SaysWhatItCannotRead) {
  expect_one_line(run_gnomon({"diff", result("fence")}), 2, "--baseline");
  expect_one_line(run_gnomon({"diff", result("fence"), result("fence") + "/none"}), 3, "none");
  const TemporaryFolder out;
  write_text(out.path() + "/result.json", R"({"schema": "gnomon/result/1"})");
  expect_one_line(run_gnomon({"diff", result("fence"), out.path()}), 3, "no whole result");
  // A result without its folder has figures, and no pixels.
  fs::copy(result("coarse") + "/result.json", out.path() + "/result.json",
           fs::copy_options::overwrite_existing);
  const ProcessResult figures = run_gnomon({"diff", result("fence"), out.path(), "--json", "-"});
  EXPECT_EQ(figures.exit_code, 0) << figures.err;
  const Json light = Json::parse(figures.out)["lights"][0];
  EXPECT_EQ(light["trend"], "worse");
  EXPECT_TRUE(light["pixels"].is_null() && light["labels"][0]["new"].is_null());
}

}  // namespace
}  // namespace gnomon::app_test
