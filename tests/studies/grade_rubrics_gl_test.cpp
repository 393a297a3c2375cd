// gnomon grade: what a rubric may ask, which folders are students', and which outputs are refused.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "tests/studies/grade_support.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;

TEST_F(Grade, OutputsTakeNoPlaceOfWhatIsReadOrWritten) {
  write_text(folder / "mine.json", "mine");
  write_rubric(
      R"("checks": [{"name": "a", "points": 1, "kind": "draws", "runs": [{"scene": "mine.json"}]}])");
  hand_in("anna", "her work");
  const std::string rubric = read_file(folder / "rubric.json"), shader = "class/anna/technique/hard.glsl";
  const Words call{"grade", "rubric.json", "class"};
  const std::string lost = "this file is also an input, which would be lost (got ";
  expect_one_line(gnomon(call + Words{"--json", "rubric.json"}), 2, lost);
  expect_one_line(gnomon(call + Words{"--csv", shader}), 2, lost);
  expect_one_line(gnomon(call + Words{"--json", "mine.json"}), 2, lost);
  expect_one_line(gnomon(call + Words{"--json", "a", "--csv", "a"}), 2, "two outputs of one name");
  expect_one_line(gnomon(call + Words{"--csv", "d/grades.csv", "-o", "d"}), 2, "two outputs of one name");
  expect_one_line(gnomon(call + Words{"--json", "-", "--csv", "-"}), 2, "stdout takes one of the two");
  EXPECT_EQ(read_file(folder / "rubric.json"), rubric);
  EXPECT_EQ(read_file(folder / shader), "her work");
  EXPECT_EQ(read_file(folder / "mine.json"), "mine");
}

TEST_F(Grade, WhatIsHandedInHasToBeRead) {
  const auto write = [&](const std::string& technique, const std::string& hand_in) {
    write_text(folder / "rubric.json", R"({"schema": "gnomon/rubric/1", "title": "One", "technique": ")" +
                                           technique + "\",\n\"hand_in\": [" + hand_in + "],\n" + one_check +
                                           "}");
  };
  write("hard", R"("technique/pcf_box.glsl")");
  expect_one_line(gnomon({"grade", "rubric.json"}), 3,
                  "rubric.json:2:13: hand_in[0]: is not read by --technique hard (got "
                  "\"technique/pcf_box.glsl\", allowed technique/hard.glsl or what it shares with others)");
  write("hard", R"("technique/hard.glsl", "moments.frag")");
  expect_one_line(gnomon({"grade", "rubric.json"}), 3, "rubric.json:2:36: hand_in[1]: is not read");
  write("pcf", R"("technique/hard.glsl")");
  expect_one_line(gnomon({"grade", "rubric.json"}), 3, "technique/pcf_hardware.glsl, ");
  for (const auto& [technique, read] :
       std::map<std::string, std::string>{{"hard", "gap.glsl"},
                                          {"pcf", "technique/pcf_vogel.glsl"},
                                          {"pcss", "technique/hard.glsl"},
                                          {"msm", "moments.frag"},
                                          {"midpoint", "midpoint.frag"},
                                          {"izb", "izb/insert.frag"},
                                          {"csm", "technique/cascade_blend.glsl"}}) {
    write(technique, "\"" + read + "\"");
    const ProcessResult graded = gnomon({"grade", "rubric.json", "-q"});
    EXPECT_EQ(graded.exit_code, 0) << technique << ": " << graded.err;
  }
}

TEST_F(Grade, BadRubricsAndFolders) {
  expect_one_line(gnomon({"grade"}), 2, "a rubric is needed");
  expect_one_line(gnomon({"grade", "nowhere.json"}), 3, "nowhere.json");
  expect_one_line(gnomon({"grade", "first-shadow-map", "nobody"}), 2, "no such folder (got nobody)");
  const std::string runs = R"("runs": [{"scene": "acne-floor"}]})";
  const auto check = [](const std::string& members) {
    return R"("checks": [{"name": "a", )" + members + "]";
  };
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {R"("checks": [])", "checks: is empty"},
      {R"("chekcs": [])", "unknown key"},
      {check(R"("points": 0, "kind": "draws", )" + runs), "checks[0].points"},
      {check(R"("points": 1, "kind": "at_most", "measure": "wrong", "at_most": "1texel", )" + runs),
       "checks[0].at_most: is no limit of this measure"},
      {check(R"("points": 1, "kind": "draws", "pixels": 3, )" + runs),
       "applies to checks of the kind equals"},
      {check(R"("points": 1, "kind": "draws", "needs": ["b"], )" + runs), "checks[0].needs[0]"},
      {check(R"("points": 1, "kind": "draws", "runs": [{"scene": "../secret.json"}]})"),
       "checks[0].runs[0].scene"},
      {check(
           R"("points": 1, "kind": "draws", "runs": [{"scene": "acne-floor", "options": {"output": "x"}}]})"),
       "is not for a rubric to set"},
      {check(
           R"("points": 1, "kind": "draws", "runs": [{"scene": "acne-floor", "options": {"allow-outside": ""}}]})"),
       "is not for a rubric to set"},
      {check(
           R"("points": 1, "kind": "draws", "runs": [{"scene": "acne-floor", "options": {"map-size": "none"}}]})"),
       "check \"a\": gnomon compare acne-floor --map-size none"}};
  for (const auto& [members, part] : wrong) {
    write_rubric(members);
    expect_one_line(gnomon({"grade", "rubric.json"}), 3, part);
  }
  fs::create_directories(folder / "a/anna");
  fs::create_directories(folder / "b/anna");
  write_rubric(one_check);
  expect_one_line(gnomon({"grade", "rubric.json", "a", "b"}), 2,
                  "two folders have the same name, which is the student's (got anna)");
}

}  // namespace
}  // namespace gnomon::app_test
