// gnomon grade on the ray-tracing homework: right answers of several styles have every point, each wrong one loses them where its
// mistake shows, once, with its name; and what a function does reaches nobody.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "functions/functions.h"
#include "tests/studies/grade_support.h"
#include "tests/studies/wrong_functions.h"
#include "tests/support/json_schema_check.h"
#include "tests/support/places.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string answers_folder(const std::string& homework = "surfaces") {
  return gnomon::test::source_dir() + "/tests/data/grade/functions/" + homework;
}

class GradeFunctions : public Grade {
 protected:
  /// The folder of the homework that asks for the function.
  std::string folder_of(const std::string& function) const {
    for (const std::string homework : {"light", "structures"})
      if (const fs::path own = answers_folder(homework);
          fs::exists(own / "a/function" / (function + ".glsl")))
        return own.string();
    return answers_folder();
  }
  std::string style(const std::string& which, const std::string& function) const {
    return read_file(folder_of(function) + "/" + which + "/function/" + function + ".glsl");
  }
  /// All of a style, with this function in place of its own.
  void hand_in_with(const std::string& student, const std::string& which, const std::string& function,
                    const std::string& text) const {
    fs::create_directories(folder / "class");
    fs::copy(folder_of(function) + "/" + which, folder / ("class/" + student), fs::copy_options::recursive);
    write_text(folder / ("class/" + student + "/function/" + function + ".glsl"), text);
  }
  std::string text_of(const Wrong& wrong) const {
    std::string text = style(wrong.style, wrong.function);
    const std::size_t at = text.find(wrong.from);
    EXPECT_NE(at, std::string::npos) << wrong.name;
    return at == std::string::npos ? text : text.replace(at, wrong.from.size(), wrong.to);
  }
  void hand_in_wrong(const Wrong& wrong) const {
    hand_in_with(wrong.name, wrong.style, wrong.function, text_of(wrong));
  }
  /// Several wrong answers to each student, of different functions, for which of them has points says nothing of the others.
  /// Returns whose each one is.
  Words hand_in_together(const std::vector<Wrong>& all) const {
    Words students;
    std::map<std::string, int> of_function;
    for (const Wrong& wrong : all) {
      students.push_back("student" + std::to_string(++of_function[wrong.function]));
      const std::string own = "class/" + students.back();
      if (!fs::exists(folder / own)) {
        fs::create_directories(folder / "class");
        fs::copy(folder_of(wrong.function) + "/a", folder / own, fs::copy_options::recursive);
      }
      write_text(folder / (own + "/function/" + wrong.function + ".glsl"), text_of(wrong));
    }
    return students;
  }
  std::map<std::string, json> grade(const Words& words) const {
    const ProcessResult graded = gnomon(Words{"grade"} + words + Words{"--json", "-", "-q"});
    EXPECT_EQ(graded.exit_code, 0) << graded.err;
    std::map<std::string, json> students;
    const json result = json::parse(graded.out);
    for (const json& student : result["students"]) students[student["name"]] = student;
    return students;
  }
};

/// What became of one function, or of all of them.
struct Outcome {
  double lost = 0.0;  ///< points
  Words named;        ///< reasons that name a mistake
};

Outcome outcome_of(const json& student, const std::string& function = "") {
  Outcome out;
  for (const json& check : student["checks"]) {
    const std::string command = check["command"], reason = check["reason"];
    if (command.find("--call " + function) == std::string::npos) continue;
    out.lost += check["of"].get<double>() - check["points"].get<double>();
    if (reason.find("answered as if") != std::string::npos) out.named.push_back(reason);
  }
  return out;
}

/// Whether it cost the points of one check, or of two where the first has parts left; and the right mistake, it alone, is named.
bool is_named(const Wrong& wrong, const json& student) {
  const Outcome outcome = outcome_of(student, wrong.function + " ");
  EXPECT_GE(outcome.lost, 1.0) << wrong.name << " lost less than a check's points";
  EXPECT_LE(outcome.lost, 2.0) << wrong.name << " lost more than once";
  const bool is = outcome.named.size() == 1 && outcome.named[0].find(wrong.mistake) != std::string::npos;
  if (!is) std::printf("%s: %s\n", wrong.name.c_str(), json(outcome.named).dump(1).c_str());
  return is;
}

class WrongAnswers : public GradeFunctions {
 protected:
  void check(const std::vector<Wrong>& all, const std::string& homework) const {
    const Words students = hand_in_together(all);
    const auto graded = grade({"rays-and-" + homework, "class", answers_folder(homework)});
    for (const std::string right : {"a", "b"})
      EXPECT_EQ(graded.at(right)["points"], graded.at(right)["of"]) << graded.at(right).dump(2);
    std::size_t named = 0;
    for (std::size_t i = 0; i < all.size(); ++i) named += is_named(all[i], graded.at(students[i])) ? 1 : 0;
    EXPECT_GE(100 * named, 95 * all.size());
    std::printf("%zu of %zu mistakes are named\n", named, all.size());
  }
};

TEST_F(WrongAnswers, OfSurfaces) {
  check(wrong_surfaces(), "surfaces");
}

TEST_F(WrongAnswers, OfLight) {
  check(wrong_light(), "light");
}

TEST_F(WrongAnswers, OfStructures) {
  check(wrong_structures(), "structures");
}

// A mistake in one function excuses nothing in another.
TEST_F(GradeFunctions, EachFunctionHasMistakesOfItsOwn) {
  hand_in_wrong(
      {"both", "a", "ray_triangle", "if (dot(n, cross(c - b, p - b)) < 0.0) return -1.0;\n", "", ""});
  const std::string order = "if (t0 > t1) { float s = t0; t0 = t1; t1 = s; }";
  std::string box = style("a", "ray_box");
  write_text(folder / "class/both/function/ray_box.glsl", box.replace(box.find(order), order.size(), ""));
  const json student = grade({"rays-and-surfaces", "class"}).at("both");
  EXPECT_EQ(student["checks"][22]["points"], 0) << student["checks"][22].dump(2);
  EXPECT_EQ(outcome_of(student).named.size(), 2u) << student.dump(2);
}

const std::string box_begin = "float ray_box(vec3 origin, vec3 direction, vec3 low, vec3 high) {\n";

// One function's fault costs the others nothing, and no function ends, hangs or fools the grader.
TEST_F(GradeFunctions, NothingThatAFunctionDoesReachesTheGrader) {
  const std::map<std::string, std::pair<std::string, std::string>> hostile = {
      {"endless",
       {"float wait(float x) { return sin(sin(sin(sin(sin(sin(sin(sin(x + 1.0) + x) + x) + x) + x) + x) + x) "
        "+ x); }\n" +
            box_begin +
            "  float sum = origin.x;\n  for (int i = 0; i < 60000; ++i)\n"
            "    sum = wait(wait(wait(wait(wait(wait(wait(wait(sum))))))));\n  return sum;\n}\n",
        "did not end within 5 s of processor time"}},
      {"no-number", {box_begin + "  return 0.0 / (low.x - low.x);\n}\n", "answered t = nan, right: t = "}},
      {"discards", {box_begin + "  discard;\n  return 0.0;\n}\n", "answered nothing, right: t = "}},
      {"broken",
       {box_begin + "\n  return origin.w;\n}\n", "function/ray_box.glsl:3: the shader does not compile"}},
      {"empty", {"float nothing() { return 0.0; }\n", "the function ray_box is missing"}},
      {"borrows",
       {"#include \"solid.glsl\"\n" + box_begin + "  return 0.0;\n}\n", "includes the program's solid.glsl"}},
      {"peeks", {"float case_number(int i);\n" + box_begin + "  return case_number(9);\n}\n", "case_number"}},
      {"declares",
       {"layout(binding = 0) uniform samplerBuffer all;\n" + box_begin + "  return 0.0;\n}\n",
        "has the word layout"}},
      {"undefines", {"#undef CALL_FUNCTION\n" + box_begin + "  return 0.0;\n}\n", "has an #undef"}}};
  for (const auto& [name, fault] : hostile) hand_in_with(name, "a", "ray_box", fault.first);
  ASSERT_EQ(gnomon({"grade", "--new", "kit", "rays-and-surfaces"}).exit_code, 0);
  std::string rubric = read_file(folder / "kit/rubric.json");
  const std::string seconds = "\"seconds\": 20";
  write_text(folder / "kit/rubric.json",
             rubric.replace(rubric.find(seconds), seconds.size(), "\"seconds\": 5"));
  const auto students = grade({"kit/rubric.json", "class"});
  for (const auto& [name, fault] : hostile) {
    const json& student = students.at(name);
    std::string reasons;
    for (const json& check : student["checks"]) reasons += check["reason"].get<std::string>() + "\n";
    EXPECT_NE(reasons.find(fault.second), std::string::npos) << name << ": " << reasons;
    const bool refused = name == "borrows" || name == "undefines" || name == "declares";
    EXPECT_EQ(student["checks"][0]["points"], refused ? 0 : 1) << name << " handed in a right eye ray";
    EXPECT_EQ(student["points"], refused ? 0 : student["of"].get<int>() - 6) << name << ": " << reasons;
  }
}

TEST_F(GradeFunctions, WhatAnExerciseAsksForIsNotHandedToIt) {
  hand_in_with("mirror", "a", "reflection",
               "vec3 reflection(vec3 direction, vec3 normal) { return reflect(direction, normal); }\n");
  hand_in_with("glass", "a", "refraction",
               "vec3 refraction(vec3 direction, vec3 normal, float n1, float n2) {\n"
               "  return refract(direction, normal, n1 / n2);\n}\n");
  hand_in_with("own", "a", "reflection",
               "vec3 reflect(vec3 d, vec3 n) { return d - 2.0 * dot(d, n) * n; }\n"
               "vec3 reflection(vec3 direction, vec3 normal) { return reflect(direction, normal); }\n");
  const auto students = grade({"rays-and-light", "class"});
  EXPECT_EQ(students.at("mirror")["points"], 25 - 6) << students.at("mirror").dump(2);
  EXPECT_EQ(students.at("glass")["points"], 25 - 7) << students.at("glass").dump(2);
  EXPECT_NE(students.at("glass").dump().find("refract_is_what_the_exercise_asks_for"), std::string::npos);
  EXPECT_EQ(students.at("own")["points"], students.at("own")["of"]);
}

TEST_F(GradeFunctions, OneAnswerToAllQuestionsHasFewPoints) {
  for (const std::string constant : {"-1.0", "0.0", "1.0", "4.0", "length(origin)"}) {
    const std::string student = "all-" + constant.substr(0, 2);
    const std::string body = "return " + constant + ";\n}\n";
    hand_in_with(student, "a", "ray_sphere",
                 "float ray_sphere(vec3 origin, vec3 direction, vec3 center, float radius) {\n" + body);
    write_text(folder / ("class/" + student + "/function/ray_box.glsl"), box_begin + body);
    write_text(folder / ("class/" + student + "/function/ray_triangle.glsl"),
               "float ray_triangle(vec3 origin, vec3 direction, vec3 a, vec3 b, vec3 c) {\n" + body);
    fs::remove(folder / ("class/" + student + "/function/eye_ray.glsl"));
    write_text(folder / ("class/" + student + "/function/ray_plane.glsl"),
               "float ray_plane(vec3 origin, vec3 direction, vec3 point, vec3 normal) {\n" + body);
  }
  for (const auto& [name, student] : grade({"rays-and-surfaces", "class"}))
    EXPECT_EQ(student["points"], 0) << student.dump(2);
}

TEST_F(GradeFunctions, AKitIsWholeAndItsPageShowsWhatIsWrong) {
  ASSERT_EQ(gnomon({"grade", "--new", "kit", "rays-and-surfaces"}).exit_code, 0);
  const auto begun = grade({"kit/rubric.json", "kit/student"});
  EXPECT_EQ(begun.at("student")["points"], 0);
  hand_in_wrong(wrong_surfaces()[6]);
  const ProcessResult graded = gnomon({"grade", "kit/rubric.json", "class", "-o", "pages", "-q"});
  ASSERT_EQ(graded.exit_code, 0) << graded.err;
  const std::string page = read_file(folder / "pages/unit.html");
  for (const std::string shown : {"data:image/png;base64,", "what was answered", "red: where the two differ",
                                  "gnomon shaders --call ray_sphere --cases length --shader-dir student"})
    EXPECT_NE(page.find(shown), std::string::npos) << shown;
}

TEST_F(GradeFunctions, AKitsCommandsAreTypedAsTheProgramWasCalled) {
  for (const auto& [called, command] : std::map<std::string, std::string>{
           {"", "\ngnomon shaders --call bvh_walk --shader-dir student                 # how many"},
           {"./gnomon",
            "\n./gnomon shaders --call bvh_walk --shader-dir kit/student                 # how many"}}) {
    setenv("GNOMON_CALLED", called.c_str(), 1);
    fs::remove_all(folder / "kit");
    ASSERT_EQ(gnomon({"grade", "--new", "kit", "rays-and-structures"}).exit_code, 0);
    const std::string readme = read_file(folder / "kit/README.md");
    EXPECT_NE(readme.find(command), std::string::npos) << readme;
    EXPECT_EQ(readme.find("`gnomon ") == std::string::npos, !called.empty());
    EXPECT_EQ(readme.find("\ngnomon ") == std::string::npos, !called.empty());
  }
  unsetenv("GNOMON_CALLED");
}

TEST_F(GradeFunctions, AFunctionIsTriedByHand) {
  const Words call{"shaders", "--call", "ray_box", "--shader-dir", answers_folder() + "/a"};
  EXPECT_NE(gnomon(call).out.find("inside     12 of 12 right\n"), std::string::npos) << gnomon(call).out;
  const ProcessResult inside = gnomon(call + Words{"--cases", "inside", "--json", "answers.json"});
  EXPECT_EQ(inside.exit_code, 0) << inside.err;
  EXPECT_EQ(inside.out.find("right  the ray from ("), 0u) << inside.out;
  EXPECT_EQ(std::count(inside.out.begin(), inside.out.end(), '\n'), 12);
  SchemaCheck schema(json::parse(read_file(gnomon::test::source_dir() + "/functions/answers.schema.json")));
  const json answers = json::parse(read_file(folder / "answers.json"));
  EXPECT_EQ(schema.violations(answers), Words{});
  EXPECT_EQ(answers["groups"][0]["wrong"], 0);
  expect_one_line(gnomon({"shaders", "--call", "ray_bxo"}), 2,
                  "no such function (got ray_bxo, allowed eye_ray, ray_sphere");
  expect_one_line(gnomon(call + Words{"--cases", "edges"}), 2,
                  "is not tried on these (got edges, allowed front, ");
  expect_one_line(gnomon(call + Words{"-o", "mine"}), 2, "--call: goes without -o");
  expect_one_line(gnomon({"shaders", "--cases", "edges"}), 2, "--cases: goes with --call");
}

TEST_F(GradeFunctions, BadRubrics) {
  const auto write = [&](const std::string& hand_in, const std::string& check) {
    write_text(folder / "rubric.json", R"({"schema": "gnomon/rubric/1", "title": "One", "hand_in": [")" +
                                           hand_in + R"("], "checks": [{"name": "a", "points": 1, )" + check +
                                           "}]}");
  };
  const std::string box = R"("kind": "answers", "function": "ray_box", "cases": "inside")";
  write("function/ray_box.glsl", box);
  EXPECT_EQ(gnomon({"grade", "rubric.json"}).out, "the program's own shader  1 of 1\n");
  write("technique/hard.glsl", box);
  expect_one_line(gnomon({"grade", "rubric.json"}), 3, "hand_in[0]: is no function");
  write("function/ray_sphere.glsl", box);
  expect_one_line(gnomon({"grade", "rubric.json"}), 3, "is about nothing that is handed in");
  write("function/ray_box.glsl", R"("kind": "answers", "function": "ray_box", "cases": "edges")");
  expect_one_line(gnomon({"grade", "rubric.json"}), 3, "checks[0].cases");
  write("function/ray_box.glsl", box + R"(, "runs": [])");
  expect_one_line(gnomon({"grade", "rubric.json"}), 3, "does not apply to checks of the kind answers");
  write("function/ray_box.glsl", R"("kind": "draws", "runs": [{"scene": "fence"}])");
  expect_one_line(gnomon({"grade", "rubric.json"}), 3, "is about nothing that is handed in");
}

}  // namespace
}  // namespace gnomon::app_test
