// gnomon grade on percentage-closer filtering: each wrong filter is named for what it is, and right ones of other styles have every
// point. The rubric is a part of the kit's, small: that all of the kit passes is grade_gl_test's to say.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "tests/studies/grade_support.h"

namespace gnomon::app_test {
namespace {

using nlohmann::json;

const std::string by_offsets = R"(#include "taps.glsl"
float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  if (!test.at.inside) return 1.0;
  Comparison c = make_comparison(test, normal);
  ivec2 own = ivec2(floor(c.at.uv));
  float sum = 0.0;
  int r = BOX_SIZE / 2, side = 2 * r + 1;
  for (int y = -r; y <= r; y++)
    for (int x = -r; x <= r; x++)
      sum += lit_at(c, own + ivec2(x, y));
  return sum / float(side * side);
}
)";

const std::string by_count = R"(#include "taps.glsl"
float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  if (!test.at.inside) return 1.0;
  Comparison c = make_comparison(test, normal);
  int shadowed = 0, all = BOX_SIZE * BOX_SIZE;
  for (int i = 0; i < all; ++i)
    if (lit_at(c, ivec2(c.at.uv) + ivec2(i / BOX_SIZE, i % BOX_SIZE) - (BOX_SIZE - 1) / 2) < 0.5) ++shadowed;
  return 1.0 - float(shadowed) / float(all);
}
)";

/// The first style with one thing changed.
struct WrongFilter {
  std::string name, from, to, mistake;
};

const std::vector<WrongFilter>& wrong_filters() {
  static const std::vector<WrongFilter> all = {
      {"from-own", "own + ivec2(x, y)", "own + ivec2(x, y) + r", "began at the receiver's own texel"},
      {"rounded", "floor(c.at.uv)", "round(c.at.uv)", "rounded, not cut"},
      {"half-down", "floor(c.at.uv)", "floor(c.at.uv - 0.5)", "half a texel to the left and down"},
      {"one-down", "ivec2(x, y)", "ivec2(x - 1, y - 1)", "too far to the left and down"},
      {"apart", "ivec2(x, y)", "2 * ivec2(x, y)", "two texels apart"},
      {"own-only", "own + ivec2(x, y)", "own", "one texel was compared with"},
      {"no-bias", "  ivec2 own", "  c.slack = 0.0;\n  ivec2 own", "there was no bias"},
      {"bias-twice", "  ivec2 own", "  c.slack *= 2.0;\n  ivec2 own", "the bias was taken twice"},
      {"threshold", "return sum / float(side * side)", "return step(0.5, sum / float(side * side))",
       "rounded to lit or shadowed"},
      {"squared", "return sum / float(side * side)",
       "float mean = sum / float(side * side);\n  return mean * mean", "the mean was squared"},
      {"own-twice", "return sum / float(side * side)",
       "return (sum + lit_at(c, own)) / float(side * side + 1)", "counted twice"},
      {"wide", "r = BOX_SIZE / 2", "r = BOX_SIZE", "as wide to each side"},
      {"always-three", "r = BOX_SIZE / 2", "r = 1", "always three texels"},
      {"beside-is-dark", "inside) return 1.0", "inside) return 0.0", "beside the map was in shadow"},
      {"mean-depth", "sum += lit_at(c, own + ivec2(x, y));\n  return sum / float(side * side)",
       "sum += tap_at(c, own + ivec2(x, y)).occluder;\n  Tap tap = tap_at(c, own);\n  tap.occluder = sum / "
       "float(side * side);\n  return lit_by(c, tap)",
       "averaged before the comparison"},
      {"lit-is-dark", "return sum", "return 1.0 - sum", "light and shadow were exchanged"}};
  return all;
}

class GradeFilter : public Grade {
 protected:
  void SetUp() override {
    Grade::SetUp();
    const auto check = [](const std::string& name, const std::string& radius, const std::string& scene) {
      return R"({"name": ")" + name +
             R"(", "points": 1, "kind": "equals", "pixels": 10, "runs": [{"scene": ")" + scene +
             R"(", "options": {"size": "120x68", "map-size": "256", "bias": "3texel", "filter-radius": ")" +
             radius + "\"}}]}";
    };
    write_text(folder / "filter.json",
               R"({"schema": "gnomon/rubric/1", "title": "Filter", "technique": "pcf",
                   "hand_in": ["technique/pcf_box.glsl"], "checks": [)" +
                   check("three", "1", "floating-box") + "," + check("seven", "3", "floating-box") + "," +
                   check("beside", "1", "field") + "]}");
  }
};

TEST_F(GradeFilter, EachWrongFilterIsNamed) {
  hand_in("offsets", by_offsets, "technique/pcf_box.glsl");
  hand_in("count", by_count, "technique/pcf_box.glsl");
  for (const WrongFilter& wrong : wrong_filters()) {
    std::string text = by_offsets;
    const std::size_t at = text.find(wrong.from);
    ASSERT_NE(at, std::string::npos) << wrong.name;
    hand_in(wrong.name, text.replace(at, wrong.from.size(), wrong.to), "technique/pcf_box.glsl");
  }
  const ProcessResult graded = gnomon({"grade", "filter.json", "class", "--json", "-", "-q"});
  ASSERT_EQ(graded.exit_code, 0) << graded.err;
  std::map<std::string, json> students;
  const json result = json::parse(graded.out);
  for (const json& student : result["students"]) students[student["name"]] = student;
  for (const std::string right : {"offsets", "count"}) EXPECT_EQ(students[right]["points"], 3) << right;
  for (const WrongFilter& wrong : wrong_filters()) {
    const json& student = students[wrong.name];
    EXPECT_LT(student["points"], 3) << wrong.name;
    EXPECT_NE(student.dump().find(wrong.mistake), std::string::npos) << wrong.name << student.dump(1);
  }
}

}  // namespace
}  // namespace gnomon::app_test
