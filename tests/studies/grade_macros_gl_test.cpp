// gnomon grade on shaders that reach behind their own end: what a student defines ends with the student's file.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/studies/grade_support.h"
#include "tests/support/places.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string
    asks =
        "float box_entry(int node);\nint left_child(int node);\nint right_child(int node);\nfloat "
        "hit_in_leaf(int node);\n",
    all_leaves =
        asks +
        "float bvh_walk() {\n  float best = -1.0;\n  for (int n = 0; n < 11; ++n) {\n"
        "    float h = hit_in_leaf(n);\n    if (h >= 0.0 && (best < 0.0 || h < best)) best = h;\n  }\n"
        "  return best;\n}\n";

class GradeMacros : public Grade {
 protected:
  std::string answers(const std::string& homework) const {
    return test::source_dir() + "/tests/data/grade/functions/" + homework + "/a";
  }
  void hand_in_walk(const std::string& student, const std::string& text) const {
    fs::create_directories(folder / "class");
    fs::copy(answers("structures"), folder / ("class/" + student), fs::copy_options::recursive);
    write_text(folder / ("class/" + student + "/function/bvh_walk.glsl"), text);
  }
  json grade(const std::string& rubric) const {
    const ProcessResult graded = gnomon({"grade", rubric, "class", "--json", "-", "-q"});
    EXPECT_EQ(graded.exit_code, 0) << graded.err;
    json students;
    const json result = json::parse(graded.out);
    for (const json& student : result["students"]) students[student["name"]] = student;
    return students;
  }
};

TEST_F(GradeMacros, NothingVoidsTheCountingOfWhatIsAsked) {
  const std::string right = read_file(answers("structures") + "/function/bvh_walk.glsl");
  hand_in_walk("macro", all_leaves + "#define max(a, b) (b)\n");
  hand_in_walk("joined", all_leaves + "#def\\\nine boxes_asked nothing\n");
  hand_in_walk("function",
               all_leaves + "float max(float a, float b) { return b; }\nint int_of(float x) { return 0; }\n");
  std::string walk = right;
  walk.replace(walk.find("float bvh_walk()"), 16, "float walk()");
  hand_in_walk(
      "every-box",
      walk + "float bvh_walk() {\n  for (int n = 0; n < 11; ++n) box_entry(n);\n  return walk();\n}\n");
  hand_in_walk("own",
               "#define BIG 1e30\n#define least(a, b) ((a) < (b) ? (a) : (b))\n#define x1 b\n" + right);
  const json students = grade("rays-and-structures");
  EXPECT_EQ(students["own"]["points"], 25) << students["own"].dump(2);
  EXPECT_EQ(students["macro"]["points"], 16)
      << "the walk's points are lost, and no others: " << students["macro"].dump(2);
  EXPECT_NE(students["macro"].dump().find("function/bvh_walk.glsl:13: #define max: the name is GLSL's"),
            std::string::npos)
      << students["macro"].dump(2);
  EXPECT_EQ(students["joined"]["points"], 16);
  EXPECT_LE(students["function"]["points"], 17) << students["function"].dump(2);
  EXPECT_LE(students["every-box"]["points"], 24) << students["every-box"].dump(2);
}

TEST_F(GradeMacros, TheGivenFileTakesNoMacroOfAStudents) {
  hand_in("macro", "#define light_that_arrives(p, n, l) (test.gap > light.bias.x ? 0.0 : 1.0)\n",
          "shadow_map.glsl");
  hand_in(
      "later",
      "#define LATER light_that_arrives\nfloat light_that_arrives(vec3 p, vec3 n, vec3 l) { return 1.0; }\n"
      "#define technique_visibility other\n",
      "shadow_map.glsl");
  const json students = grade("first-shadow-map");
  for (const std::string name : {"macro", "later"})
    EXPECT_EQ(students[name]["points"], 0) << students[name].dump(2);
  EXPECT_NE(students["macro"].dump().find("shadow_map.glsl:1: #define light_that_arrives"),
            std::string::npos);
}

}  // namespace
}  // namespace gnomon::app_test
