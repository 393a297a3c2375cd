// Each lesson shows the fault that it names: its own commands, at a smaller size of the picture, and what the
// labels say.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "report/lessons.h"
#include "tests/support/app_process.h"
#include "tests/support/places.h"

namespace gnomon::app_test {
namespace {

using nlohmann::json;

/// The commands of a lesson's file that begin so, as words.
std::vector<Words> commands(const std::string& lesson, const std::string& command) {
  std::vector<Words> found;
  std::ifstream lines(test::source_dir() + "/docs/lessons/" + lesson + ".md");
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    Words all;
    for (std::string word; words >> word;) all.push_back(word);
    if (all.size() > 1 && all[0] == "gnomon" && all[1] == command)
      found.emplace_back(all.begin() + 1, all.end());
  }
  return found;
}

/// Without these options and their values.
Words without(Words words, const Words& options) {
  for (const std::string& option : options) {
    const auto at = std::find(words.begin(), words.end(), option);
    if (at != words.end()) words.erase(at, at + 2);
  }
  return words;
}

json compared(const std::string& lesson, std::size_t which) {
  const std::vector<Words> all = commands(lesson, "compare");
  if (which >= all.size()) {
    ADD_FAILURE() << lesson << " has no such command";
    return {};
  }
  const ProcessResult result =
      run_gnomon(without(all[which], {"--size", "--json"}) +
                 Words{"--size", "480x270", "--runs", "1", "--quiet", "--json", "-"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return json::parse(result.out, nullptr, false)["lights"][0];
}

/// The label with the most pixels; empty where none is wrong.
std::string leading(const json& light) {
  std::string name;
  std::uint64_t most = 0;
  for (const auto& [label, count] : light["classes"].items())
    if (count.get<std::uint64_t>() > most) name = label, most = count;
  return name;
}

TEST(LessonFaults, LeadingLabelIsTheLessons) {
  const std::vector<std::tuple<std::string, std::size_t, std::string>> told = {
      {"shadow-map", 0, "aliasing"},
      {"shadow-map", 3, "acne"},
      {"acne", 0, "acne"},
      {"peter-panning", 0, "peter_panning"},
      {"peter-panning", 1, "peter_panning"},
      {"light-leaks", 0, "light_leak"},
      {"light-leaks", 1, "light_leak"},
      {"light-leaks", 5, "peter_panning"},
      {"aliasing", 1, "aliasing"},
      {"filtering", 0, "blur"},
      {"filtering", 1, "blur"},
      {"soft-shadows", 0, "light_size"},
      {"cube-maps", 3, "acne"},
      {"intersections", 0, "aliasing"},
      {"precision", 0, "precision"}};
  for (const auto& [lesson, which, label] : told) {
    const json light = compared(lesson, which);
    EXPECT_EQ(leading(light), label) << lesson << ", command " << which + 1 << ": " << light["classes"];
  }
}

TEST(LessonFaults, CuresLeaveNothingOfTheFault) {
  EXPECT_EQ(compared("acne", 1)["classes"]["acne"], 0);
  // What is left with 32 bits lies on the diagonal of the floor, where the fill rule gives a texel to the
  // other triangle.
  EXPECT_EQ(compared("cube-maps", 5)["classes"]["acne"], 0);
  EXPECT_LE(compared("precision", 1)["classes"]["precision"], 5);
  EXPECT_EQ(compared("hybrid", 0)["error"]["wrong"], 0);
}

// Wires thinner than a texel: both kinds, beside the stairs of the slabs.
TEST(LessonFaults, AliasingHasAllItsKinds) {
  const json classes = compared("aliasing", 0)["classes"];
  for (const char* label : {"aliasing", "missed_feature", "false_feature"})
    EXPECT_GT(classes[label], 50) << label << ": " << classes;
}

// The teeth of the terminator are no error: they face away in both renderers, and no bias moves them.
TEST(LessonFaults, TerminatorIsNoFaultOfTheMap) {
  const json exact = compared("terminator", 0), coarse = compared("terminator", 1),
             biased = compared("terminator", 3);
  EXPECT_GT(coarse["pixels"]["facing_away"], exact["pixels"]["facing_away"]);
  EXPECT_EQ(biased["pixels"]["facing_away"], coarse["pixels"]["facing_away"]);
  EXPECT_EQ(coarse["classes"]["acne"], 0);
}

// What the structures' lesson says of a grid in the stadium, at a few pixels: it tests thousands of triangles for a ray
// where a kd-tree tests a few.
TEST(LessonFaults, TeapotInTheStadiumRuinsTheGrid) {
  const ProcessResult result = run_gnomon(
      {"bench", "stadium", "--accel", "grid,kdtree", "--size", "16x9", "--runs", "1", "--json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json bench = json::parse(result.out);
  std::map<std::string, double> values;
  for (const json& row : bench["rows"]) values[row["name"]] = row["value"].get<double>();
  EXPECT_GT(values.at("grid triangles per ray"), 5000.0);
  EXPECT_LT(values.at("kdtree triangles per ray"), 20.0);
}

// Texels of the same size everywhere: the spread between the median and the worst hundredth is smaller, and
// so is the error.
TEST(LessonFaults, CascadesBringTheTexelsTogether) {
  const json csm = compared("cascades", 0), hard = compared("cascades", 1);
  ASSERT_EQ(csm["map"]["technique"], "csm");
  EXPECT_LT(csm["error"]["wrong"], hard["error"]["wrong"]);
  EXPECT_LT(csm["edges"]["rms_pixels"], hard["edges"]["rms_pixels"]);
  EXPECT_LT(csm["theory"]["aliasing"]["p99"], hard["theory"]["aliasing"]["p99"]);
}

// The steps of the budget add up to the error, and undo each other on the way.
TEST(LessonFaults, BudgetAddsUp) {
  const json light = compared("error-budget", 0);
  double sum = 0.0, work = 0.0;
  for (const json& step : light["budget"])
    sum += step["signed"].get<double>(), work += step["absolute"].get<double>();
  const double error =
      light["ladder"].back()["mean"].get<double>() - light["ladder"].front()["mean"].get<double>();
  EXPECT_NEAR(sum, error, 1e-12);
  EXPECT_GT(work, 2.0 * std::abs(sum));
}

// Every command of a lesson that makes a picture, a comparison or a plan does so, and an exercise is begun and tried. Small pictures,
// and of comparisons the numbers alone: what they show, and how pages and maps are written, is the other tests' matter.
TEST(LessonFaults, CommandsRun) {
  const TemporaryFolder folder;
  std::set<Words> done;
  const auto run = [&](const std::string& lesson, const Words& words) {
    if (!done.insert(words).second && words[0] != "grade") return;  // a kit lies in each lesson's own folder
    std::filesystem::create_directories(folder / lesson);
    const ProcessResult result = run_gnomon(words, {.folder = folder / lesson});
    EXPECT_EQ(result.exit_code, 0) << lesson << ": " << result.err;
  };
  for (const report::Lesson& lesson : report::all_lessons()) {
    const std::string name(lesson.name);
    for (const Words& words : commands(name, "raytrace"))
      run(name, without(words, {"--size"}) + Words{"--size", "64x36"});
    for (const Words& words : commands(name, "plan")) run(name, words);
    for (const Words& words : commands(name, "grade"))
      if (words[1] == "--new") run(name, words);
    for (const Words& words : commands(name, "shaders")) run(name, words);
    for (const Words& words : commands(name, "compare"))
      run(name,
          without(words, {"--size", "--json"}) + Words{"--size", "64x36", "--runs", "1", "--json", "-"});
  }
  EXPECT_GE(done.size(), 60u);
}

}  // namespace
}  // namespace gnomon::app_test
