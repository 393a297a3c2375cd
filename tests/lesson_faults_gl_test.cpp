// Each lesson shows the fault that it names: its own commands, at a smaller size of the picture, and what the
// labels say.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "compare/report/lessons.h"
#include "tests/app_process.h"
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

json compared(const std::string& lesson, std::size_t which) {
  const std::vector<Words> all = commands(lesson, "compare");
  if (which >= all.size()) {
    ADD_FAILURE() << lesson << " has no such command";
    return {};
  }
  const TemporaryFolder folder;
  const ProcessResult result = run_gnomon(
      all[which] + Words{"--size", "480x270", "--runs", "1", "--quiet", "--json", "-", "-o", folder / "out"});
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
      {"acne", 0, "acne"},
      {"peter-panning", 0, "peter_panning"},
      {"peter-panning", 1, "peter_panning"},
      {"light-leaks", 0, "light_leak"},
      {"light-leaks", 1, "light_leak"},
      {"aliasing", 1, "aliasing"},
      {"filtering", 0, "blur"},
      {"filtering", 1, "blur"},
      {"soft-shadows", 0, "light_size"},
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
  EXPECT_LE(compared("precision", 1)["classes"]["precision"], 5);
  EXPECT_EQ(compared("hybrid", 0)["error"]["wrong"], 0);
}

// Wires thinner than a texel: both kinds, beside the stairs of the slabs.
TEST(LessonFaults, AliasingHasAllItsKinds) {
  const json classes = compared("aliasing", 0)["classes"];
  for (const char* label : {"aliasing", "missed_feature", "false_feature"})
    EXPECT_GT(classes[label], 50) << label << ": " << classes;
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

// Every other command of a lesson that makes a picture or a plan does so.
TEST(LessonFaults, OtherCommandsRun) {
  const TemporaryFolder folder;
  for (const compare::Lesson& lesson : compare::all_lessons()) {
    for (const Words& words : commands(std::string(lesson.name), "raytrace")) {
      const ProcessResult result = run_gnomon(words + Words{"--size", "64x36"}, {.folder = folder.path()});
      EXPECT_EQ(result.exit_code, 0) << result.err;
    }
    for (const Words& words : commands(std::string(lesson.name), "plan"))
      EXPECT_EQ(run_gnomon(words).exit_code, 0);
    for (const Words& words : commands(std::string(lesson.name), "compare")) {
      const ProcessResult result =
          run_gnomon(words + Words{"--size", "64x36", "--runs", "1", "-o", folder / "out"});
      EXPECT_EQ(result.exit_code, 0) << lesson.name << ": " << result.err;
    }
  }
}

}  // namespace
}  // namespace gnomon::app_test
