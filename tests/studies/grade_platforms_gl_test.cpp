// gnomon grade on what a class hands in by way of platforms, browsers and archives: the right answer has its points wherever it lies,
// and what is there but cannot be told is not graded.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/studies/grade_support.h"
#include "tests/studies/packed.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string right = "vec3 reflection(vec3 d, vec3 n) { return d - 2.0 * dot(d, n) * n; }\n",
                  wrong = "vec3 reflection(vec3 d, vec3 n) { return d; }\n",
                  place = "function/reflection.glsl";

class GradePlatforms : public Grade {
 protected:
  void SetUp() override {
    write_text(
        folder / "rubric.json",
        R"({"schema": "gnomon/rubric/1", "title": "Mirror", "hand_in": ["function/reflection.glsl"], "checks": [
                {"name": "slanted", "points": 2, "kind": "answers", "function": "reflection", "cases": "slanted"},
                {"name": "length", "points": 1, "kind": "answers", "function": "reflection", "cases": "length"}]})");
  }
  void put(const std::string& file, const std::string& bytes) const {
    const fs::path path = folder / ("class/" + file);
    fs::create_directories(path.parent_path());
    write_text(path.string(), bytes);
  }
  ProcessResult grade(const Words& students = {"class"}, const Words& more = {}) const {
    return gnomon(Words{"grade", "rubric.json"} + students + Words{"--json", "grades.json", "-q"} + more);
  }
  json students() const { return json::parse(read_file(folder / "grades.json"))["students"]; }
};

TEST_F(GradePlatforms, TheRightAnswerHasItsPointsWhereverItLies) {
  const std::string own = read_file(test::source_dir() + "/shaders/function/reflection.glsl");
  put("plain/" + place, right);
  put("flat/reflection.glsl", right);
  put("browser/reflection (1).glsl", right);
  put("numbered/reflection_12345.glsl", right);
  put("second/reflection-2.glsl", right);
  put("windows/reflection.glsl.txt", right);
  put("capital/Function/Reflection.GLSL", right);
  put("nested/final/src/" + place, right);
  put("finder/.DS_Store", "x");
  put("finder/__MACOSX/function/._reflection.glsl", "x");
  put("finder/function/._reflection.glsl", "x");
  put("finder/" + place, right);
  put("kit/README.md", "x");
  put("kit/rubric.json", "{}");
  put("kit/student/" + place, right);
  put("begun/student/" + place, own);
  put("begun/reflection (1).glsl", right);
  put("zip/homework.zip",
      zip_of({{"__MACOSX/._reflection.glsl", "x"}, {"homework/student/" + place, right}}));
  put("twice/a.zip", zip_of({{"b.zip", zip_of({{place, right}})}}));
  put("same/a.zip", zip_of({{place, right}}));
  put("same/" + place, right);
  put("packed.zip", zip_of({{"function\\reflection.glsl", right}}));
  put("helper/x/reflection.glsl",
      "#include \"mine.glsl\"\nvec3 reflection(vec3 d, vec3 n) { return mine(d, n); }\n");
  put("helper/x/mine.glsl", "vec3 mine(vec3 d, vec3 n) { return d - 2.0 * dot(d, n) * n; }\n");
  const ProcessResult graded = grade();
  EXPECT_EQ(graded.exit_code, 0) << graded.err;
  EXPECT_EQ(students().size(), 16u);
  for (const json& student : students()) EXPECT_EQ(student["points"], 3) << student.dump(2);
}

TEST_F(GradePlatforms, WhatIsThereButCannotBeToldIsNotGraded) {
  put("good/" + place, right);
  put("two/" + place, right);
  put("two/reflection (1).glsl", wrong);
  put("versions/v1/" + place, right);
  put("versions/v2/" + place, wrong);
  put("paper/homework.docx", "PK");
  put("rar/homework.rar", "Rar!");
  put("broken/homework.zip", "PK\3\4 and no more");
  put("other/answer.glsl", right);
  put("out/homework.zip", zip_of({{"../" + place, right}}));
  put("absolute/homework.zip", zip_of({{"/" + place, right}}));
  const std::string deep = zip_of({{"c.zip", zip_of({{"d.zip", zip_of({{place, right}})}})}});
  put("deep/a.zip", zip_of({{"b.zip", deep}}));
  const ProcessResult graded = grade();
  EXPECT_EQ(graded.exit_code, 3) << graded.err;
  const std::map<std::string, std::string> reasons = {
      {"two", "two files may be function/reflection.glsl: function/reflection.glsl and reflection (1).glsl"},
      {"versions", "v1/function/reflection.glsl and v2/function/reflection.glsl"},
      {"paper", "holds no function/reflection.glsl, but homework.docx"},
      {"rar", "but homework.rar"},
      {"broken", "class/broken/homework.zip: cannot be opened"},
      {"other", "but answer.glsl"},
      {"out", "leads out of it"},
      {"absolute", "leads out of it"},
      {"deep", "an archive in an archive"}};
  for (const json& student : students()) {
    const std::string name = student["name"];
    if (name == "good") {
      EXPECT_EQ(student["points"], 3);
      continue;
    }
    EXPECT_TRUE(student["points"].is_null()) << student.dump(2);
    EXPECT_NE(student["error"].get<std::string>().find(reasons.at(name)), std::string::npos)
        << student.dump(2);
    EXPECT_NE(graded.err.find(reasons.at(name)), std::string::npos);
  }
}

TEST_F(GradePlatforms, NothingButWhatOneBeginsWithHasNoPoints) {
  put("kit/student/" + place, read_file(test::source_dir() + "/shaders/function/reflection.glsl"));
  put("kit/README.md", "x");
  put("kit/rubric.json", "{}");
  fs::create_directories(folder / "class/nothing");
  const ProcessResult graded = grade();
  EXPECT_EQ(graded.exit_code, 0) << graded.err;
  for (const json& student : students()) {
    EXPECT_EQ(student["points"], 0) << student.dump(2);
    EXPECT_NE(student.dump().find("nothing was handed in"), std::string::npos);
  }
}

// Two folders of one participant are one row; the feedback's folder has the name that Moodle gave.
TEST_F(GradePlatforms, MoodlesFoldersAndFilesAreItsParticipants) {
  put("Ada Lovelace_12345_assignsubmission_file/reflection.glsl", right);
  put("Ada Lovelace_12345_assignsubmission_onlinetext/onlinetext.html", "<p>see the file</p>");
  put("=Bert_12346_assignsubmission_file_/homework.zip", zip_of({{place, wrong}}));
  put("Carl, C._12347_assignsubmission_file_reflection.glsl", right);
  const ProcessResult graded =
      grade({"class"}, {"--csv", "grades.csv", "--csv-form", "moodle", "-o", "pages"});
  EXPECT_EQ(graded.exit_code, 0) << graded.err;
  const std::string csv = read_file(folder / "grades.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4) << csv;
  EXPECT_NE(csv.find("\nParticipant 12345,Ada Lovelace,3,3,\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\nParticipant 12346,=Bert,1,3,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\nParticipant 12347,\"Carl, C.\",3,3,\n"), std::string::npos) << csv;
  for (const std::string name : {"Ada Lovelace", "=Bert", "Carl, C."}) {
    const std::string number = name == "=Bert" ? "12346" : name == "Ada Lovelace" ? "12345" : "12347";
    const std::string named = name + "_" + number + "_assignsubmission_file" + (name == "=Bert" ? "_" : "");
    EXPECT_TRUE(fs::exists(folder / ("pages/feedback/" + named + "/feedback.html"))) << named;
  }
}

TEST_F(GradePlatforms, CanvasFilesAreItsStudents) {
  put("lovelaceada_12345_67890_reflection.glsl", right);
  put("smithbob_LATE_124_678_reflection-1.glsl", right);
  put("jonescarl_125_679_homework.zip", zip_of({{place, wrong}}));
  const ProcessResult graded =
      grade({"class"}, {"--csv", "grades.csv", "--csv-form", "canvas", "-o", "pages"});
  EXPECT_EQ(graded.exit_code, 0) << graded.err;
  EXPECT_EQ(read_file(folder / "grades.csv"),
            "Student,ID,SIS User ID,SIS Login ID,Section,Mirror\n    Points Possible,,,,,3\n"
            "jonescarl,125,,,,1\nlovelaceada,12345,,,,3\nsmithbob,124,,,,3\n");
  EXPECT_TRUE(fs::exists(folder / "pages/feedback/lovelaceada_12345_67890_reflection.glsl.html"));
}

TEST_F(GradePlatforms, OtherPlatformsNameTheirStudentsToo) {
  put("Homework 3_alovelace_attempt_2026-11-30-09-16-02_reflection.glsl", right);
  put("Homework 3_alovelace_attempt_2026-11-30-09-16-02.txt", "Name: Ada Lovelace");
  ASSERT_EQ(grade().exit_code, 0);
  ASSERT_EQ(students().size(), 1u);
  EXPECT_EQ(students()[0]["name"], "alovelace");
  EXPECT_EQ(students()[0]["points"], 3);
  fs::remove_all(folder / "class");
  put("12345-67890 - Ada Lovelace - Nov 30, 2026 916 AM/reflection.glsl", right);
  put("index.html", "x");
  ASSERT_EQ(grade().exit_code, 0);
  EXPECT_EQ(students()[0]["points"], 3);
}

TEST_F(GradePlatforms, AnArchiveIsAClassOrAStudent) {
  write_text(folder / "class.zip",
             zip_of({{"export/Ada_1_assignsubmission_file/reflection.glsl", right},
                     {"export/Bert_2_assignsubmission_file/homework.zip", zip_of({{place, right}})}}));
  write_text(folder / "anna.zip", zip_of({{place, right}}));
  const ProcessResult graded = grade({"class.zip", "anna.zip"});
  EXPECT_EQ(graded.exit_code, 0) << graded.err;
  ASSERT_EQ(students().size(), 3u) << students().dump(2);
  for (const json& student : students()) EXPECT_EQ(student["points"], 3) << student.dump(2);
  EXPECT_EQ(students()[2]["name"], "anna");
}

}  // namespace
}  // namespace gnomon::app_test
