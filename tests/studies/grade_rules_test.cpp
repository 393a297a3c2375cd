// What a handed-in shader may not say, however it is written; whose a file is by its name; and what is alike.
#include <gtest/gtest.h>

#include "grade/alike.h"
#include "grade/expand_macros.h"
#include "grade/glsl_names.h"
#include "grade/participant.h"
#include "grade/results.h"
#include "grade/shader_rules.h"

namespace gnomon::grade {
namespace {

Rubric of_functions() {
  return {};
}

TEST(ShaderRules, AMacroOfAProtectedNameIsRefusedHoweverItIsWritten) {
  for (const std::string text : {"#define max(a, b) (b)\n",
                                 "  #  define max(a, b) (b)\n",
                                 "#/* x */define/**/max(a, b) (b)\n",
                                 "#def\\\nine max(a, b) (b)\n",
                                 "#define \\\nmax(a, b) (b)\n",
                                 "/* a\n */ #define max(a, b) (b)\n",
                                 "x\r#define max(a, b) (b)\r",
                                 "\t#\tdefine\tmax b\n",
                                 "#define box_entry(n) 0.0\n",
                                 "#define texelFetch(a, b) vec4(0.0)\n",
                                 "#define vec4 vec3\n",
                                 "#define float int\n",
                                 "#define case_number(i) 1.0\n",
                                 "#define boxes_asked one\n",
                                 "#define gl_FragCoord vec4(0.0)\n",
                                 "#define main other\n",
                                 "#undef CALL_FUNCTION\n",
                                 "#line 7\n",
                                 "#extension GL_ARB_gpu_shader5 : enable\n",
                                 "#version 330\n",
                                 "#include \"solid.glsl\"\n",
                                 "#define GLUE(a, b) a ## b\n",
                                 "layout(binding = 0) float x;\n",
                                 "float f() { return gl_FragCoord.x; }\n",
                                 "vec4 texelFetch(float s, int i) { return vec4(0.0); }\n"})
    EXPECT_NE(why_refused("a.glsl", text, of_functions()), "") << text;
}

TEST(ShaderRules, TheReasonNamesTheLine) {
  EXPECT_EQ(why_refused("a.glsl", "float x;\n/* two\nlines */\n#define max(a, b) (b)\n", of_functions()),
            "a.glsl:4: #define max: the name is GLSL's, which no macro may take");
  EXPECT_EQ(why_refused("a.glsl", "#define leaves_asked x\n", of_functions()),
            "a.glsl:1: #define leaves_asked: the name is the program's, which no macro may take");
}

TEST(ShaderRules, MacrosOfOnesOwnAreFine) {
  for (const std::string text :
       {"#define PI 3.14159265\n", "#define EPSILON 1e-4\n", "#define INF 1e30\n",
        "#define sq(x) ((x) * (x))\n", "#define SWAP(a, b) a\n", "#define node_t int\n",
        "#define corner(i, k) triangle_corner(i, k)\n", "#define MAX_STACK 16\n", "#define vector vec3\n",
        "// #define max(a, b) (b)\n", "/* #define max(a, b) (b) */\n", "// a \\\n#define max(a, b) b\n",
        "#ifdef X\n#endif\n", "#define imageWidth 64\n", "#define MAX3(a, b, c) max(a, max(b, c))\n",
        "#define float3 vec3\n", "#define x1 a.x\n"})
    EXPECT_EQ(why_refused("a.glsl", text, of_functions()), "") << text;
  EXPECT_EQ(ending_macros("#define A 1\n  # define f(x) x\nfloat y;\n"), "\n\n#undef A\n#undef f\n");
  EXPECT_EQ(ending_macros("float y;\n"), "");
}

TEST(ShaderRules, AGivenFilesNamesAreProtected) {
  Rubric rubric;
  rubric.technique = "hard";
  rubric.given = {
      {"technique/hard.glsl", "float technique_visibility() { return light_that_arrives(p, n, l); }\n"}};
  EXPECT_NE(why_refused("a.glsl", "#define light_that_arrives(p, n, l) (test.gap)\n", rubric), "");
  EXPECT_NE(why_refused("a.glsl", "#define RECORDS\n", rubric), "");
  EXPECT_EQ(why_refused("a.glsl", "#define BIAS light.bias.x\n", rubric), "");
}

TEST(ShaderRules, GlslsNamesAreKnown) {
  for (const char* name : {"max", "vec3", "mat4x3", "sampler2DArray", "textureLod", "gl_FragCoord", "a__b",
                           "float", "if", "imageLoad"})
    EXPECT_TRUE(is_glsl_name(name)) << name;
  for (const char* name : {"maximum", "vector", "matter", "textured", "images", "PI", "ray", "packet", "x"})
    EXPECT_FALSE(is_glsl_name(name)) << name;
}

TEST(Participants, PlatformsNameTheirStudents) {
  const auto moodle = participant_in("Ada Lovelace_12345_assignsubmission_file_", true);
  ASSERT_TRUE(moodle);
  EXPECT_EQ(moodle->name + moodle->id, "Ada Lovelace12345");
  EXPECT_EQ(moodle->returned_as, "Ada Lovelace_12345_assignsubmission_file_");
  const auto canvas = participant_in("lovelaceada_LATE_12345_67890_my_ray_box.glsl", false);
  ASSERT_TRUE(canvas);
  EXPECT_EQ(canvas->id + canvas->file, "12345my_ray_box.glsl");
  EXPECT_FALSE(participant_in("ray_box.glsl", false));
  EXPECT_FALSE(participant_in("anna", true));
  EXPECT_FALSE(participant_in("reflection_12345.glsl", false));
}

TEST(Alike, WhatIsBehindMacrosIsCompared) {
  EXPECT_EQ(
      plain_words(with_macros_put_in("#define R return\n#define add(a, b) ((a) + (b))\nR add(x, f(y, z));"),
                  {"return"}),
      plain_words("return ((x) + (f(y, z)));", {"return"}));
  EXPECT_EQ(with_macros_put_in("#define A A\n#define B A B\nB"),
            with_macros_put_in("#define A A\n#define B A B\nB"));
}

TEST(Alike, TenEqualAnswersAreOneGroup) {
  std::vector<AlikePair> pairs;
  for (std::size_t i = 0; i < 10; ++i)
    for (std::size_t j = i + 1; j < 10; ++j) pairs.push_back({i, j, 1.0, true});
  pairs.push_back({12, 14, 0.9, false});
  pairs.push_back({14, 16, 0.8, false});
  const std::vector<AlikeGroup> groups = groups_of(pairs);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].students.size(), 10u);
  EXPECT_TRUE(groups[0].same_text);
  EXPECT_EQ(groups[1].students, (std::vector<std::size_t>{12, 14, 16}));
  EXPECT_EQ(groups[1].share, 0.8);
}

TEST(ClassPage, SaysWhatSeveralLostAndPutsEqualAnswersOnOneLine) {
  Rubric rubric;
  rubric.title = "One";
  rubric.checks.resize(2);
  rubric.checks[0].name = "first", rubric.checks[1].name = "second";
  for (Check& check : rubric.checks)
    check.points = 1.0, check.runs.resize(1), check.runs[0].function = "eye_ray";
  std::vector<StudentResult> students;
  for (const char* name : {"anna", "bert", "carl", "dora"}) {
    students.push_back({name, {CheckResult{}, CheckResult{}}});
    students.back().checks[1].points = 1.0;
    if (students.size() < 4) students.back().checks[0].mistake = "0.5 is left out";
  }
  students[0].checks[1].points = 0.5, students[3].checks[1].points = 0.5;
  const ClassResult result{
      rubric, students, "gnomon grade", {{0, 1, 1.0, true}, {0, 2, 1.0, true}, {1, 2, 1.0, true}}};
  const std::vector<CommonLoss> losses = common_losses(result);
  ASSERT_EQ(losses.size(), 2u);
  EXPECT_EQ(loss_words(result, losses[0]), "3 of 4: eye_ray as if 0.5 is left out");
  EXPECT_EQ(loss_words(result, losses[1]), "2 of 4 without all points of: second");
  const std::string page = class_page(result);
  EXPECT_NE(page.find("What to say next time"), std::string::npos);
  EXPECT_NE(page.find("<li>anna, bert and carl: the very same text</li>"), std::string::npos) << page;
}

}  // namespace
}  // namespace gnomon::grade
