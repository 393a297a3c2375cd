// gnomon grade on the ray-tracing homework: right answers of several styles have every point, each wrong one loses them where its
// mistake shows, once, with its name; and what a function does reaches nobody.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "studies/functions/functions.h"
#include "tests/studies/grade_support.h"
#include "tests/support/json_schema_check.h"
#include "tests/support/places.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string answers_folder(const std::string& homework = "surfaces") {
  return gnomon::test::source_dir() + "/tests/data/grade/functions/" + homework;
}

/// An answer of style a or b with one thing changed: which mistake is named (part of its words).
struct Wrong {
  std::string name, style, function, from, to, mistake;
};

const std::vector<Wrong>& wrong_surfaces() {
  static const std::vector<Wrong> all = {
      {"corner", "a", "eye_ray", "(pixel.x + 0.5) / size.x - 1.0;\n  float v = 1.0 - 2.0 * (pixel.y + 0.5)",
       "pixel.x / size.x - 1.0;\n  float v = 1.0 - 2.0 * pixel.y", "through the pixel's corner"},
      {"no-aspect", "a", "eye_ray", "t * aspect *", "t *", "the picture was square"},
      {"whole-angle", "a", "eye_ray", "(radians(degrees) / 2.0)", "(radians(degrees))",
       "the whole angle was the half"},
      {"radians", "b", "eye_ray", "radians(degrees)", "degrees", "the angle was in radians"},
      {"upside-down", "b", "eye_ray", "- from_middle.y", "+ from_middle.y",
       "rows were counted from the bottom"},
      {"not-normal", "a", "eye_ray", "normalize(forward", "(forward", "was not normalized"},
      {"unit", "a", "ray_sphere", "dot(direction, direction)", "1.0", "the direction had length 1"},
      {"metres", "b", "ray_sphere", "t / size", "t", "t was a length"},
      {"far-root", "a", "ray_sphere", "if (t0 >= 0.0) return t0;\n", "", "the farther of the two places"},
      {"outside-only", "a", "ray_sphere", "if (t1 >= 0.0) return t1;\n", "", "begins inside met nothing"},
      {"first-root", "a", "ray_sphere",
       "if (t0 >= 0.0) return t0;\n  if (t1 >= 0.0) return t1;\n  return -1.0", "return t0",
       "the nearer place was the answer even behind"},
      {"no-square", "a", "ray_sphere", "radius * radius", "radius", "the radius was not squared"},
      {"sign", "a", "ray_sphere", "2.0 * dot(oc", "-2.0 * dot(oc", "b had the wrong sign"},
      {"no-disc", "a", "ray_sphere", "if (disc < 0.0) return -1.0;", "disc = abs(disc);",
       "its absolute value"},
      {"no-center", "b", "ray_sphere", "center - origin;", "-origin;", "around the origin of the world"},
      {"nan-sphere", "a", "ray_sphere", "if (disc < 0.0) return -1.0;\n",
       "if (isnan(sqrt(disc))) return sqrt(disc);\n", "no number"},
      {"plane-sign", "a", "ray_plane", "point - origin", "origin - point", "t had the wrong sign"},
      {"plane-behind", "a", "ray_plane", "t < 0.0 ? -1.0 : t", "t", "a plane behind the ray was met"},
      {"plane-flat", "a", "ray_plane", "slant == 0.0", "abs(slant) < 0.01", "nearly parallel met nothing"},
      {"plane-culled", "a", "ray_plane", "slant == 0.0", "slant >= 0.0", "seen from the back was not there"},
      {"plane-center", "b", "ray_plane", " + d, speed", ", speed", "went through the origin of the world"},
      {"no-third", "a", "ray_triangle", "if (dot(n, cross(c - b, p - b)) < 0.0) return -1.0;\n", "",
       "no third edge"},
      {"square", "b", "ray_triangle", "u + v > 1.0", "v > 1.0", "a parallelogram"},
      {"no-first", "a", "ray_triangle", "if (dot(n, cross(b - a, p - a)) < 0.0) return -1.0;\n", "",
       "v could be less than 0"},
      {"no-second", "a", "ray_triangle", "if (dot(n, cross(a - c, p - c)) < 0.0) return -1.0;\n", "",
       "u could be less than 0"},
      {"plane", "b", "ray_triangle", "if (u < 0.0 || u > 1.0) return -1.0;",
       "return dot(e2, cross(tvec, e1)) * inv_det < 0.0 ? -1.0 : dot(e2, cross(tvec, e1)) * inv_det;",
       "the whole plane was the triangle"},
      {"behind", "a", "ray_triangle", "if (t < 0.0) return -1.0;\n", "", "behind the ray was met"},
      {"culled", "b", "ray_triangle", "abs(det) < 1e-8", "det < 1e-8", "seen from the back was not there"},
      {"coarse", "b", "ray_triangle", "1e-8", "1e-3", "parallel to a small triangle"},
      {"length", "a", "ray_triangle",
       "vec3 n =", "direction = normalize(direction);\n  vec3 n =", "t was a length"},
      {"no-divide", "b", "ray_triangle", "dot(e2, qvec) * inv_det", "dot(e2, qvec)",
       "t was not divided by the determinant"},
      {"at-origin", "b", "ray_triangle", "origin - a", "origin", "at the origin of the world"},
      {"unordered", "a", "ray_box", "if (t0 > t1) { float s = t0; t0 = t1; t1 = s; }\n", "",
       "every direction were positive"},
      {"flat", "a", "ray_box", "axis < 3", "axis < 2", "no slab of z"},
      {"from-behind", "b", "ray_box", " || leave < 0.0", "", "a box behind the ray was met, at 0"},
      {"negative", "b", "ray_box", "return max(enter, 0.0)", "return enter", "behind its begin"},
      {"exit", "b", "ray_box", "return max(enter, 0.0)", "return enter < 0.0 ? leave : enter",
       "where it leaves it"},
      {"no-inside", "b", "ray_box", "|| leave < 0.0", "|| enter < 0.0", "begins inside met nothing"},
      {"last", "a", "ray_box", "return tmin;", "return tmax;", "where the ray leaves the box"},
      {"any-slab", "b", "ray_box", "leave < enter || ", "", "the order of the slabs' ends did not matter"},
      {"never-along", "a", "ray_box",
       "if (origin[axis] < low[axis] || origin[axis] > high[axis]) return -1.0;", "return -1.0;",
       "runs along was never met"},
      {"always-along", "a", "ray_box",
       "if (origin[axis] < low[axis] || origin[axis] > high[axis]) return -1.0;", "continue;",
       "runs along was not there"},
      {"open-face", "b", "ray_box", "step(low, origin) * step(origin, high)",
       "vec3(greaterThan(origin, low)) * vec3(lessThan(origin, high))", "runs in a face met nothing"}};
  return all;
}

const std::vector<Wrong>& wrong_light() {
  static const std::vector<Wrong> all = {
      {"backwards", "a", "reflection", "return direction - 2.0", "return -direction + 2.0",
       "pointed back to where"},
      {"no-two", "a", "reflection", "2.0 * dot", "dot", "the 2 was left out"},
      {"plus", "a", "reflection", "direction - 2.0", "direction + 2.0", "was added, not taken away"},
      {"shortened", "b", "reflection", "along - through", "normalize(along - through)",
       "the result had length 1"},
      {"front-only", "a", "reflection", "2.0 * dot(normal, direction)", "2.0 * -abs(dot(normal, direction))",
       "had to point against the ray"},
      {"exchanged", "a", "refraction", "n1 / n2", "n2 / n1", "the two indices were exchanged"},
      {"no-test", "a", "refraction", "if (k < 0.0) return vec3(0.0);\n", "",
       "total reflection was not tested"},
      {"mirror", "a", "refraction", "return vec3(0.0)", "return direction + 2.0 * c * normal",
       "the mirrored direction"},
      {"through", "b", "refraction", "return vec3(0.0)", "return direction", "went straight on"},
      {"cosine-sign", "a", "refraction", "= -dot(normal", "= dot(normal", "the cosine had the wrong sign"},
      {"ratio", "a", "refraction", "r * r * (1.0", "r * (1.0", "was not squared"},
      {"no-root", "a", "refraction", "sqrt(k)", "k", "the root was left out"},
      {"no-cosine", "a", "refraction", "r * c - sqrt(k)", "-sqrt(k)",
       "left out of the part along the normal"},
      {"clamped", "a", "refraction", "if (k < 0.0) return vec3(0.0)", "k = max(k, 0.0)",
       "under the root was 0"},
      {"amplitudes", "a", "fresnel", "(s * s + p * p) / 2.0", "(abs(s) + abs(p)) / 2.0",
       "they are not squared"},
      {"one", "a", "fresnel", "(s * s + p * p) / 2.0", "s * s", "the first polarisation"},
      {"sum", "a", "fresnel", "(s * s + p * p) / 2.0", "s * s + p * p", "were added"},
      {"transmitted", "b", "fresnel", "return 0.5 *", "return 1.0 - 0.5 *", "the answer was what passes"},
      {"none-in-total", "a", "fresnel", "return 1.0;", "return 0.0;", "total reflection reflected nothing"},
      {"nan-in-total", "a", "fresnel", "if (sine2 > 1.0) return 1.0;\n", "",
       "total reflection was not tested"},
      {"schlick", "a", "fresnel", "if (sine2 > 1.0) return 1.0;",
       "return mix(pow((n1 - n2) / (n1 + n2), 2.0), 1.0, pow(1.0 - cosine, 5.0));",
       "Schlick's approximation"},
      {"no-offset", "a", "shadow_ray", "point + offset * n", "point", "there is no offset"},
      {"along-ray", "b", "shadow_ray", "faceforward(normal, light.w * point - light.xyz, normal)",
       "normalize(light.xyz - light.w * point)", "the offset ran along the ray"},
      {"front-offset", "a", "shadow_ray", "if (dot(n, toLight) < 0.0) n = -n;\n", "",
       "always pointed to the light's side"},
      {"into", "a", "shadow_ray", "toLight) < 0.0", "toLight) > 0.0", "the side away from the light"},
      {"unnormalized", "b", "shadow_ray", "direction /= size;\n", "", "was not normalized"},
      {"to-point", "a", "shadow_ray", "normalize(light.xyz - begin)", "normalize(begin - light.xyz)",
       "ran from the light to the point"},
      {"endless-lamp", "a", "shadow_ray", "distance(light.xyz, begin)", "1e30", "a lamp's ray had no end"},
      {"end-from-point", "a", "shadow_ray", "distance(light.xyz, begin)", "distance(light.xyz, point)",
       "the end was measured from the point"},
      {"end-one", "a", "shadow_ray", "distance(light.xyz, begin)", "1.0", "the end was 1"},
      {"sun-is-lamp", "b", "shadow_ray", "light.xyz - light.w * begin", "light.xyz - begin",
       "a sun was a lamp"},
      {"sun-near", "a", "shadow_ray", "end = 1e30", "end = length(light.xyz)", "as its direction is long"},
      {"own-epsilon", "a", "shadow_ray", "offset * n", "0.001 * n", "a small number of its own"},
      {"squared-end", "a", "shadow_ray", "distance(light.xyz, begin)",
       "dot(light.xyz - begin, light.xyz - begin)", "the distance squared"}};
  return all;
}

class GradeFunctions : public Grade {
 protected:
  /// The folder of the homework that asks for the function.
  std::string folder_of(const std::string& function) const {
    const std::string light = answers_folder("light");
    return fs::exists(light + "/a/function/" + function + ".glsl") ? light : answers_folder();
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
  void hand_in_wrong(const Wrong& wrong) const {
    std::string text = style(wrong.style, wrong.function);
    const std::size_t at = text.find(wrong.from);
    ASSERT_NE(at, std::string::npos) << wrong.name;
    hand_in_with(wrong.name, wrong.style, wrong.function, text.replace(at, wrong.from.size(), wrong.to));
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

/// The reasons that name a mistake.
Words named_in(const json& student) {
  Words reasons;
  for (const json& check : student["checks"]) {
    const std::string reason = check["reason"];
    if (reason.find("answered as if") != std::string::npos) reasons.push_back(reason);
  }
  return reasons;
}

/// Returns how many of the wrong answers have the right mistake, and it alone, named.
std::size_t named_of(const std::vector<Wrong>& all, const std::map<std::string, json>& students) {
  for (const std::string right : {"a", "b"})
    EXPECT_EQ(students.at(right)["points"], students.at(right)["of"]) << students.at(right).dump(2);
  std::size_t named = 0;
  for (const Wrong& wrong : all) {
    const json& student = students.at(wrong.name);
    EXPECT_LE(student["points"].get<double>() + 1.0, student["of"].get<double>())
        << wrong.name << " lost less than a check's points";
    const Words reasons = named_in(student);
    const bool is =
        reasons.size() == 1 && reasons[0].find(wrong.mistake) != std::string::npos && !wrong.mistake.empty();
    named += is ? 1 : 0;
    if (!is) std::printf("%s: %s\n", wrong.name.c_str(), json(reasons).dump(1).c_str());
    EXPECT_GE(student["points"].get<double>() + 2.0, student["of"].get<double>())
        << wrong.name << " lost more than once";
  }
  return named;
}

TEST_F(GradeFunctions, EveryMistakeIsNamedAndCostsItsPointsOnce) {
  for (const Wrong& wrong : wrong_surfaces()) hand_in_wrong(wrong);
  EXPECT_GE(100 * named_of(wrong_surfaces(), grade({"rays-and-surfaces", "class", answers_folder()})),
            95 * wrong_surfaces().size());
}

TEST_F(GradeFunctions, TheSameOfLight) {
  for (const Wrong& wrong : wrong_light()) hand_in_wrong(wrong);
  EXPECT_GE(100 * named_of(wrong_light(), grade({"rays-and-light", "class", answers_folder("light")})),
            95 * wrong_light().size());
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
  EXPECT_EQ(named_in(student).size(), 2u) << student.dump(2);
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
    const bool refused = name == "borrows" || name == "undefines";
    EXPECT_EQ(student["checks"][0]["points"], refused ? 0 : 1) << name << " handed in a right eye ray";
    EXPECT_EQ(student["points"], refused ? 0 : student["of"].get<int>() - 6) << name << ": " << reasons;
  }
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

TEST_F(GradeFunctions, AFunctionIsTriedByHand) {
  const Words call{"shaders", "--call", "ray_box", "--shader-dir", answers_folder() + "/a"};
  EXPECT_NE(gnomon(call).out.find("inside     12 of 12 right\n"), std::string::npos) << gnomon(call).out;
  const ProcessResult inside = gnomon(call + Words{"--cases", "inside", "--json", "answers.json"});
  EXPECT_EQ(inside.exit_code, 0) << inside.err;
  EXPECT_EQ(inside.out.find("right  the ray from ("), 0u) << inside.out;
  EXPECT_EQ(std::count(inside.out.begin(), inside.out.end(), '\n'), 12);
  SchemaCheck schema(
      json::parse(read_file(gnomon::test::source_dir() + "/studies/functions/answers.schema.json")));
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
