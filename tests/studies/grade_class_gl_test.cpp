// gnomon grade, a class as it comes: any names, links, folders that cannot be read, shaders that want to know whether they
// are timed. Nobody loses points for what somebody else, or the machine, does.
#include <grp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/studies/grade_support.h"
#include "tests/support/places.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class GradeClass : public Grade {};

/// The program's own shader with another text of its own: it has all points.
const std::string like_own = R"(// mine
float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  return test.gap > light.bias.x ? 0.0 : 1.0;
}
)";
const std::string slow_function = R"(
float slow(float a) { float s = 0.0; for (int i = 0; i < 3000; ++i) s += sin(s + a + float(i)); return s; }
)";

json by_name(const ProcessResult& graded) {
  const json result = json::parse(graded.out);
  json students;
  for (const json& student : result["students"]) students[student["name"]] = student;
  return students;
}

// Slow and right where it is judged, quick and wrong where it is timed.
TEST_F(GradeClass, NoShaderIsTimedByAnotherDrawingThanTheJudgedOne) {
  const std::string runs =
      R"("runs": [{"scene": "thin-wall", "options": {"size": "96x54", "map-size": "64"}}]})";
  write_rubric(R"("checks": [{"name": "right", "points": 1, "kind": "equals", "pixels": 5, )" + runs +
               R"(, {"name": "quick", "points": 1, "kind": "time", "times": 8, )" + runs + "]");
  const std::string
      begin = "float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {\n",
      right = "return test.gap + slow(position.x) * 1e-30 > light.bias.x ? 0.0 : 1.0;\n";
  hand_in("define", slow_function + begin + "#ifdef RECORDS\n" + right + "#else\nreturn 1.0;\n#endif\n}\n");
  hand_in("macro", slow_function + begin +
                       "int judged = 0;\nCOUNT_LOOKUPS(judged = 1);\nif (judged == 0) return 1.0;\n" + right +
                       "}\n");
  hand_in("plain", like_own);
  const ProcessResult graded = gnomon({"grade", "rubric.json", "class", "--json", "-", "-q"});
  ASSERT_EQ(graded.exit_code, 0) << graded.err;
  const json students = by_name(graded);
  EXPECT_EQ(students["plain"]["points"], 2) << students["plain"].dump(2);
  for (const char* name : {"define", "macro"}) {
    EXPECT_EQ(students[name]["checks"][0]["points"], 1) << students[name].dump(2);
    EXPECT_EQ(students[name]["checks"][1]["points"], 0) << students[name].dump(2);
  }
}

TEST_F(GradeClass, WhatIsTimedIsTheProgramThatIsJudged) {
  hand_in("anna", "#ifndef RECORDS\n#error this is another one\n#endif\n" + like_own);
  const Words call{"compare",      "thin-wall",  "--size", "64x36", "--map-size", "64",
                   "--shader-dir", "class/anna", "-o",     "out",   "-q",         "--no-report"};
  EXPECT_EQ(gnomon(call).exit_code, 3);
  const ProcessResult judged = gnomon(call + Words{"--timed-as-judged", "--json", "-"});
  ASSERT_EQ(judged.exit_code, 0) << judged.err;
  EXPECT_EQ(json::parse(judged.out)["timing"]["as_judged"], true);
  // The second light is drawn beside the picture when it is timed.
  EXPECT_EQ(gnomon({"compare", "whitted", "--size", "64x36", "--map-size", "64", "--shader-dir", "class/anna",
                    "-o", "out", "-q", "--no-report", "--timed-as-judged"})
                .exit_code,
            0);
}

// One process makes a student's drawings, and a new one those behind a drawing that failed.
TEST_F(GradeClass, ADrawingThatFailsCostsTheOthersNothing) {
  const auto check = [](const std::string& name, const std::string& scene) {
    return R"({"name": ")" + name + R"(", "points": 1, "kind": "draws", "runs": [{"scene": ")" + scene +
           R"(", "options": {"size": "16x9", "map-size": "64"}}]})";
  };
  write_rubric("\"checks\": [" + check("first", "thin-wall") + ", " + check("lamp", "whitted") + ", " +
               check("last", "acne-floor") + "]");
  hand_in("anna", "#ifdef CUBE\n#error not yet\n#endif\n" + like_own);
  const ProcessResult graded = gnomon({"grade", "rubric.json", "class", "--csv", "-", "-q"});
  EXPECT_EQ(graded.out, "student,points,of,first,lamp,last\nanna,2,3,1,0,1\n") << graded.err;
}

// A shader that counts in a buffer how often it was drawn could answer otherwise the last time.
TEST_F(GradeClass, WhatDrawsOtherwiseWhenItIsTimedIsFound) {
  hand_in("anna", read_file(gnomon::test::source_dir() + "/tests/data/grade/counting_izb.glsl"),
          "technique/izb.glsl");
  const Words call{"compare", "thin-wall",    "--technique", "izb", "--size", "64x36", "--map-size",
                   "64",      "--shader-dir", "class/anna",  "-o",  "out",    "-q",    "--no-report"};
  EXPECT_EQ(gnomon(call).exit_code, 0);
  expect_one_line(gnomon(call + Words{"--timed-as-judged"}), 3, "draws differently when it is timed");
}

// One folder's name costs neither its owner nor the class anything.
TEST_F(GradeClass, AnyNameOfAFolderHasItsPointsAndItsPage) {
  std::string cyrillic, chinese;
  while (cyrillic.size() < 120) cyrillic += "\xd0\x96";
  while (chinese.size() < 255) chinese += "\xe5\xad\xa6";
  const std::vector<std::string> names = {
      "anna", "Anna", "a b", "a_20b", cyrillic, chinese, std::string(255, 'x'), "\xff\xfe", "a\nb", "index"};
  for (const std::string& name : names) hand_in(name, like_own);
  write_rubric(one_check);
  const ProcessResult graded = gnomon({"grade", "rubric.json", "class", "--csv", "-", "-o", "pages", "-q"});
  ASSERT_EQ(graded.exit_code, 0) << graded.err;
  EXPECT_EQ(std::count(graded.out.begin(), graded.out.end(), '\n'), static_cast<long>(names.size()) + 1)
      << graded.out;
  const json result = json::parse(read_file(folder / "pages/grades.json"));
  ASSERT_EQ(result["students"].size(), names.size());
  for (const json& student : result["students"]) {
    EXPECT_EQ(student["points"], 1) << student.dump(2);
    EXPECT_TRUE(fs::is_regular_file(folder / ("pages/" + student["page"].get<std::string>())))
        << student.dump(2);
  }
}

// The folder's name is none of the program's own.
TEST_F(GradeClass, AHiddenFolderTakesNoPlaceOfTheProgramsOwn) {
  write_rubric(R"("checks": [{"name": "a", "points": 1, "kind": "equals", "pixels": 5,
    "runs": [{"scene": "acne-floor", "options": {"size": "16x9", "map-size": "64"}}]}])");
  for (const std::string name : {".own", "own", ".kit", "kit", "0", "1"}) hand_in(name, like_own);
  const ProcessResult graded = gnomon({"grade", "rubric.json", "class/.own", "class/own", "class/.kit",
                                       "class/kit", "class/0", "class/1", "--json", "-", "-q"});
  ASSERT_EQ(graded.exit_code, 0) << graded.err;
  const json result = json::parse(graded.out);
  for (const json& student : result["students"]) EXPECT_EQ(student["points"], 1) << student.dump(2);
}

TEST_F(GradeClass, LinksAndWhatIsNoFileAreNamedForWhatTheyAre) {
  write_rubric(one_check);
  hand_in("anna", like_own);
  fs::create_symlink("anna", folder / "class/mallory");
  fs::create_symlink("circle", folder / "class/circle");
  fs::create_symlink("nowhere", folder / "class/lost");
  fs::create_directories(folder / "class/unzipped/technique/hard.glsl");
  hand_in("unzipped-twice", like_own, "technique/hard.glsl/hard.glsl");
  fs::create_directories(folder / "class/pipe/technique");
  ASSERT_EQ(mkfifo((folder / "class/pipe/technique/hard.glsl").c_str(), 0600), 0);
  const std::map<std::string, std::string> reasons = {
      {"mallory", "the folder is a link"},
      {"circle", "the folder is a link"},
      {"lost", "the folder is a link"},
      {"unzipped", "technique/hard.glsl is a folder, not a file"},
      {"unzipped-twice", "technique/hard.glsl is a folder, not a file"},
      {"pipe", "technique/hard.glsl is a pipe, not a file"}};
  const ProcessResult graded = gnomon({"grade", "rubric.json", "class", "--json", "-", "-q"});
  ASSERT_EQ(graded.exit_code, 0) << graded.err;
  const json students = by_name(graded);
  EXPECT_EQ(students["anna"]["points"], 1);
  ASSERT_EQ(students.size(), reasons.size() + 1);
  for (const auto& [name, reason] : reasons) {
    EXPECT_EQ(students[name]["points"], 0);
    EXPECT_NE(students[name]["checks"][0]["reason"].get<std::string>().find(reason), std::string::npos)
        << students[name].dump(2);
  }
  for (const std::string given : {"class/mallory", "class/mallory/", "class/mallory/."})
    EXPECT_NE(gnomon({"grade", "rubric.json", given}).out.find("the folder is a link"), std::string::npos)
        << given;
}

/// Root may read everything.
void become_nobody() {
  if (geteuid() != 0) return;
  constexpr uid_t nobody = 65534;
  if (setgroups(0, nullptr) != 0 || setgid(nobody) != 0 || setuid(nobody) != 0) _exit(98);
}

TEST_F(GradeClass, WhoCannotBeReadIsNotGradedAndCostsNobodyElse) {
  write_rubric(one_check);
  for (const std::string name : {"anna", "bert", "carl", "dora"}) hand_in(name, like_own);
  fs::permissions(folder.path(), fs::perms(0755));
  fs::permissions(folder / "class/bert", fs::perms::none);
  fs::permissions(folder / "class/carl/technique", fs::perms::none);
  fs::permissions(folder / "class/dora/technique/hard.glsl", fs::perms::none);
  for (const Words& given : {Words{"class"}, Words{"class/anna", "class/bert", "class/carl", "class/dora"}}) {
    const ProcessResult graded =
        run_gnomon(Words{"grade", "rubric.json"} + given + Words{"--json", "-", "-q"},
                   {.folder = folder.path(), .prepare = become_nobody});
    if (graded.exit_code == 98) GTEST_SKIP() << "the program cannot be run by another user";
    EXPECT_EQ(graded.exit_code, 3) << graded.err;
    const json students = by_name(graded);
    EXPECT_EQ(students["anna"]["points"], 1);
    EXPECT_FALSE(students["anna"].contains("error"));
    for (const std::string name : {"bert", "carl", "dora"}) {
      EXPECT_TRUE(students[name]["points"].is_null()) << students[name].dump(2);
      EXPECT_TRUE(students[name]["checks"][0]["points"].is_null());
      EXPECT_NE(students[name]["error"].get<std::string>().find("Permission denied"), std::string::npos);
      EXPECT_NE(graded.err.find(name + " (class/" + name), std::string::npos) << graded.err;
    }
  }
  for (const char* path : {"class/bert", "class/carl/technique"})
    fs::permissions(folder / path, fs::perms(0755));
}

// No room for a page: the old pages stay, and the points come out on stdout.
TEST_F(GradeClass, PagesAppearTogetherOrNotAtAllAndThePointsRegardless) {
  write_rubric(one_check);
  hand_in("anna", like_own);
  ASSERT_EQ(gnomon({"grade", "rubric.json", "class", "-o", "pages", "-q"}).exit_code, 0);
  const std::string index = read_file(folder / "pages/index.html"),
                    grades = read_file(folder / "pages/grades.csv");
  hand_in("bert", like_own);
  constexpr long limit = 300'000;  // bytes
  write_rubric("\"text\": \"" + std::string(limit, 'x') + "\", " + one_check);
  for (const std::string out : {"pages", "new/pages"}) {
    const ProcessResult graded = run_gnomon({"grade", "rubric.json", "class", "-o", out, "--csv", "-", "-q"},
                                            {.folder = folder.path(), .file_size_limit = limit});
    EXPECT_EQ(graded.exit_code, 4) << graded.err;
    EXPECT_EQ(graded.out, "student,points,of,draws\nanna,1,1,1\nbert,1,1,1\n");
  }
  EXPECT_FALSE(fs::exists(folder / "new/pages"));
  EXPECT_EQ(read_file(folder / "pages/index.html"), index);
  EXPECT_EQ(read_file(folder / "pages/grades.csv"), grades);
  EXPECT_FALSE(fs::exists(folder / "pages/bert.html"));
  // What cannot be put there is known before anything is drawn.
  fs::create_directories(folder / "pages/bert.html");
  expect_one_line(gnomon({"grade", "rubric.json", "class", "-o", "pages"}), 4,
                  "pages/bert.html: is a folder");
}

TEST_F(GradeClass, AKitAppearsWholeOrNotAtAll) {
  const ProcessResult begun =
      run_gnomon({"grade", "--new", "homework"}, {.folder = folder.path(), .file_size_limit = 2000});
  EXPECT_EQ(begun.exit_code, 4) << begun.err;
  EXPECT_EQ(folder.entries(), Words{});
}

// Two hand in the same file, and one of them has the name that Moodle gives to folders.
TEST_F(GradeClass, AlikeAnswersAndMoodlesColumns) {
  const std::string lovelace = "Ada Lovelace_12345_assignsubmission_file";
  hand_in(lovelace, like_own);
  hand_in("bert", like_own);
  hand_in("carl", "// another\n" + slow_function + like_own);
  write_rubric(R"("language": "de", )" + one_check);
  const ProcessResult graded = gnomon({"grade", "rubric.json", "class", "--csv", "grades.csv", "--csv-form",
                                       "moodle", "--json", "grades.json", "-o", "pages"});
  ASSERT_EQ(graded.exit_code, 0) << graded.err;
  EXPECT_NE(graded.out.find(lovelace + " and bert: the very same text"), std::string::npos) << graded.out;
  const json alike = json::parse(read_file(folder / "grades.json"))["alike"];
  ASSERT_EQ(alike.size(), 1u) << alike.dump();
  EXPECT_EQ(alike[0]["students"], json({lovelace, "bert"}));
  EXPECT_EQ(alike[0]["same_text"], true);
  EXPECT_EQ(read_file(folder / "grades.csv"),
            "Identifier,Full name,Grade,Maximum Grade,Feedback comments\n"
            "Participant 12345,Ada Lovelace,1,1,\n,bert,1,1,\n,carl,1,1,\n");
  const std::string page = read_file(folder / "pages/index.html");
  EXPECT_NE(page.find("Answers that are alike"), std::string::npos);
  EXPECT_NE(page.find("<span lang=\"de\">One</span>"), std::string::npos);
  write_rubric(R"("language": "de\" onclick", )" + one_check);
  expect_one_line(gnomon({"grade", "rubric.json"}), 3, "language: is no language");
}

}  // namespace
}  // namespace gnomon::app_test
