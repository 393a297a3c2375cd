// gnomon grade: shaders with a known fault lose exactly the points that the fault costs, the right one has them all, and
// nothing that a shader does reaches the grader.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/studies/grade_support.h"
#include "tests/support/places.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// The shipped shader with its steps filled in.
std::string exercise_solution() {
  const std::string skeleton =
      read_file(gnomon::test::source_dir() + "/grade/kits/first-shadow-map/shadow_map.glsl");
  return skeleton.substr(0, skeleton.find("  // TODO 1")) +
         read_file(gnomon::test::source_dir() + "/tests/data/grade/steps.glsl");
}

/// The same as the technique's own file.
std::string solution() {
  std::string text = exercise_solution();
  const std::string name = "float light_that_arrives(";
  return text.replace(text.find(name), name.size(), "float technique_visibility(ShadowTest test, ");
}

struct Edit {
  std::string from, to;
};
/// Checks that lose points, by a letter: Compiles, Shadows, Light, Acne, Panning, Texel, Outside, spot (K), lamp (M), along
/// the Ray, Quick. A check that needs a lost one is lost with it, unless the mistake in that one has a name.
struct Fault {
  std::string name;
  std::vector<Edit> edits;
  std::string lost;
  std::string mistake = "";  ///< part of its name; empty: none is named
};

constexpr std::string_view letters = "CSLAPTOKMRQ";

const std::string test_line = "return gap > light.bias.x ? 0.0 : 1.0";
const std::string border = "greaterThanEqual(place, vec2(size)))) return 1.0";

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all = {
      {"right", {}, ""},
      {"byte-order-mark", {{"// Your first", "\xef\xbb\xbf// Your first"}}, ""},
      {"given-gap", {{"return gap >", "return test.gap >"}}, "CSLAPTOKMRQ"},
      {"no-bias", {{"> light.bias.x", "> 0.0"}}, "A", "there was no bias"},
      {"negative-bias", {{"> light.bias.x", "> -light.bias.x"}}, "LAPTOKMRQ"},
      {"double-bias", {{"> light.bias.x", "> 2.0 * light.bias.x"}}, "P", "the bias was taken twice"},
      {"huge-bias", {{"> light.bias.x", "> 10.0 * light.bias.x"}}, "P", "ten times as large"},
      {"flipped-comparison", {{"? 0.0 : 1.0", "? 1.0 : 0.0"}}, "S", "the wrong way round"},
      {"flipped-depth", {{"(texel, stored)", "(texel, 1.0 - stored)"}}, "A", "counted from the far end"},
      {"stored-as-depth",
       {{"depth_from_stored(texel, stored)", "stored"}},
       "A",
       "was a depth in world units"},
      {"one-texel-right",
       {{"ivec2(floor(place))", "ivec2(floor(place)) + ivec2(1, 0)"}},
       "T",
       "one texel off to the right"},
      {"one-texel-up",
       {{"ivec2(floor(place))", "ivec2(floor(place)) + ivec2(0, 1)"}},
       "P",
       "one texel off upward"},
      {"rounded-texel", {{"floor(place)", "floor(place + 0.5)"}}, "T", "nearest corner of a texel"},
      {"no-ray-length", {{"  gap *= length(offset) / p.z;\n", ""}}, "R", "measured along the view's axis"},
      {"no-divide", {{"  view /= p.z;\n", ""}}, "K", "not divided by the depth"},
      {"no-border",
       {{"if (any(lessThan(place, vec2(0.0))) || any(" + border, "if (size < 0.0) return 1.0"}},
       "O",
       "texels were read beside the map"},
      {"dark-border",
       {{border, "greaterThanEqual(place, vec2(size)))) return 0.0"}},
       "O",
       "beside the map was in shadow"},
      {"no-right-border",
       {{" || any(greaterThanEqual(place, vec2(size)))", ""}},
       "O",
       "beside the map to the right or above was in it"},
      {"empty-is-dark",
       {{"(stored)) return 1.0", "(stored)) return 0.0"}},
       "O",
       "a texel without a caster was in shadow"},
      {"half-bias", {{"> light.bias.x", "> 0.5 * light.bias.x"}}, "T", "the bias was half as large"},
      {"one-texel-left",
       {{"ivec2(floor(place))", "ivec2(floor(place)) - ivec2(1, 0)"}},
       "T",
       "one texel off to the left"},
      {"twice-halved",
       {{"p.xy / light.extent", "0.5 * p.xy / light.extent"}},
       "A",
       "places are halved twice"},
      {"wrong-axes",
       {{"dot(light.right[face].xyz, offset), dot(light.up[face]",
         "dot(light.up[face].xyz, offset), dot(light.right[face]"}},
       "A",
       "right and up were exchanged"},
      {"upside-down", {{"dot(light.up[face].xyz", "-dot(light.up[face].xyz"}}, "A", "up was mirrored"},
      {"mirrored", {{"vec2 view = p.xy", "vec2 view = vec2(-p.x, p.y)"}}, "S", "right was mirrored"},
      {"no-origin",
       {{"position - light.origin_and_warp[face].xyz", "position"}},
       "T",
       "from where the view stands"},
      {"one-view", {{"cube_face(position - light.origin_and_size.xyz)", "0"}}, "M", "a lamp had one view"},
      {"one-layer", {{"(floor(place)), face)", "(floor(place)), 0)"}}, "M", "in the map's first layer"},
      {"half-a-map", {{"0.5) * size", "0.5) * 0.5 * size"}}, "LAPTOKMRQ"},
      {"always-lit", {{test_line, "return 1.0"}}, "SAPTOKMRQ"},
      {"always-dark", {{test_line, "return 0.0"}}, "LAPTOKMRQ"},
      {"always-half",
       {{test_line, "return 0.5"},
        {"size)))) return 1.0", "size)))) return 0.5"},
        {"(stored)) return 1.0", "(stored)) return 0.5"}},
       "SAPTOKMRQ"},
      {"half-dark", {{"? 0.0 : 1.0", "? 0.3 : 1.0"}}, "TR"},
      {"writes-nan", {{test_line, "return 0.0 / (size - size)"}}, "CSLAPTOKMRQ"},
      {"writes-two", {{"? 0.0 : 1.0", "? 0.0 : 2.0"}}, "CSLAPTOKMRQ"},
      {"does-not-compile", {{"float gap =", "flaot gap ="}}, "CSLAPTOKMRQ"},
      {"no-function", {{"float light_that_arrives", "float my_visibility"}}, "CSLAPTOKMRQ"},
      {"slow",
       {{test_line,
         "float sum = 0.0;\n  for (int i = 0; i < 2000; ++i) sum += texelFetch(depth_map, texel + ivec3(i % "
         "2, 0, 0), 0).r;\n"
         "  if (sum < -1.0) return 0.0;\n  " +
             test_line}},
       "Q"},
  };
  return all;
}

std::string with_edits(std::string text, const Fault& fault) {
  for (const Edit& edit : fault.edits) {
    const std::size_t at = text.find(edit.from);
    EXPECT_NE(at, std::string::npos) << fault.name << ": " << edit.from;
    if (at != std::string::npos) text.replace(at, edit.from.size(), edit.to);
  }
  return text;
}

std::string lost_by(const json& student) {
  std::string lost;
  for (std::size_t i = 0; i < student["checks"].size(); ++i)
    if (student["checks"][i]["points"] < student["checks"][i]["of"]) lost += letters.at(i);
  return lost;
}

std::string mistake_of(const json& student) {
  for (const json& check : student["checks"])
    if (const std::string reason = check["reason"]; reason.starts_with("drawn as if ")) return reason;
  return {};
}

class EveryFault : public Grade, public ::testing::WithParamInterface<std::size_t> {};
constexpr std::size_t classes = 2;

TEST_P(EveryFault, LosesItsPointsAndNoOthers) {
  std::vector<Fault> own;
  for (std::size_t i = GetParam(); i < faults().size(); i += classes) own.push_back(faults()[i]);
  for (const Fault& fault : own)
    hand_in(fault.name, with_edits(exercise_solution(), fault), "shadow_map.glsl");
  const ProcessResult graded = gnomon({"grade", "first-shadow-map", "class", "--json", "-", "-q"});
  ASSERT_EQ(graded.exit_code, 0) << graded.err;
  const json result = json::parse(graded.out);
  ASSERT_EQ(result["students"].size(), own.size());
  std::map<std::string, json> students;
  for (const json& student : result["students"]) students[student["name"]] = student;
  for (const Fault& fault : own) {
    const json& student = students[fault.name];
    EXPECT_EQ(lost_by(student), fault.lost) << student.dump(2);
    EXPECT_EQ(student["points"] == 20, fault.lost.empty()) << student.dump(2);
    const std::string mistake = mistake_of(student);
    EXPECT_EQ(mistake.empty(), fault.mistake.empty()) << fault.name << ": " << mistake;
    EXPECT_NE(mistake.find(fault.mistake), std::string::npos) << fault.name << ": " << mistake;
  }
}
INSTANTIATE_TEST_SUITE_P(Class, EveryFault, ::testing::Range(std::size_t{0}, classes));

// The page of a lost point shows it; a page is one file.
TEST_F(Grade, PagesAndTablesShowWhatLostPoints) {
  for (const Fault& fault : faults())
    if (fault.name == "double-bias" || fault.name == "does-not-compile")
      hand_in(fault.name, with_edits(exercise_solution(), fault), "shadow_map.glsl");
  const ProcessResult graded =
      gnomon({"grade", "first-shadow-map", "class", "--csv", "grades.csv", "-o", "pages", "-q"});
  ASSERT_EQ(graded.exit_code, 0) << graded.err;
  const std::string page = read_file(folder / "pages/double-bias.html");
  EXPECT_NE(page.find("data:image/png;base64,"), std::string::npos);
  EXPECT_NE(page.find("--shader-dir student"), std::string::npos);
  EXPECT_NE(page.find("where it is wrong, and why: <span class=\"key\">"), std::string::npos);
  EXPECT_EQ(page.find("src=\"http"), std::string::npos);
  EXPECT_NE(read_file(folder / "pages/does-not-compile.html").find("flaot gap"), std::string::npos);
  EXPECT_NE(read_file(folder / "grades.csv").find("\ndouble-bias,18,20,"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder / "pages/index.html"));
}

/// The number before " %" in a reason.
double percentage_in(const std::string& reason) {
  return std::stod(reason.substr(reason.find(": ") + 2));
}

// A pixel drawn halfway is half a false shadow or half a missed one, so that the two are what is wrong.
TEST_F(Grade, WhatIsDrawnHalfwayCountsByHalf) {
  std::string checks;
  for (const std::string measure : {"wrong", "false_shadow", "missed_shadow"})
    checks += (checks.empty() ? "" : ", ") + (R"({"name": ")" + measure) +
              R"(", "points": 1, "kind": "at_most", "at_most": "0%", "measure": ")" + measure +
              R"(", "runs": [{"scene": "thin-wall", "options": {"size": "64x36", "map-size": "64"}}]})";
  write_rubric("\"checks\": [" + checks + "]");
  const std::string skeleton = solution();
  hand_in("half", skeleton.substr(0, skeleton.find("#ifdef CUBE")) + "  return 0.5;\n}\n");
  const ProcessResult graded = gnomon({"grade", "rubric.json", "class", "--json", "-", "-q"});
  ASSERT_EQ(graded.exit_code, 0) << graded.err;
  const json checked = json::parse(graded.out)["students"][0]["checks"];
  const double wrong = percentage_in(checked[0]["reason"]), too_dark = percentage_in(checked[1]["reason"]),
               too_light = percentage_in(checked[2]["reason"]);
  EXPECT_EQ(wrong, 50.0);
  EXPECT_GT(too_dark, 1.0) << checked.dump(2);
  EXPECT_GT(too_light, 1.0) << checked.dump(2);
  EXPECT_NEAR(too_dark + too_light, wrong, 0.1) << "each is given to a tenth of a percent";
}

// With the bias of the shader itself the shadow starts where it does with the same bias as an option; and what such a
// shader draws wrong may be of any label.
TEST_F(Grade, ABiasOfTheStudentsOwnIsMeasured) {
  const std::string options = R"("options": {"size": "240x135", "map-size": "512", "bias": "0.02"})";
  const std::string runs = R"(, "runs": [{"scene": "thin-wall", )" + options + "}]}";
  write_rubric(
      R"("checks": [{"name": "start", "points": 1, "kind": "at_most", "measure": "detachment", "at_most": "0.5texel")" +
      runs +
      R"(, {"name": "label", "points": 1, "kind": "at_most", "measure": "peter_panning", "at_most": "0.1%")" +
      runs + "]");
  const auto edited = [](const std::string& name, const std::string& from, const std::string& to) {
    return with_edits(solution(), {name, {{from, to}}, ""});
  };
  hand_in("bias", edited("own-bias", "> light.bias.x", "> 20.0 * light.bias.x"));
  hand_in("beside", edited("beside", "ivec2(floor(place))", "ivec2(floor(place)) + ivec2(1, 0)"));
  hand_in("right", solution());
  const ProcessResult graded = gnomon({"grade", "rubric.json", "class", "--json", "-", "-q"});
  ASSERT_EQ(graded.exit_code, 0) << graded.err;
  const json students = json::parse(graded.out)["students"];
  EXPECT_EQ(students[1]["points"], 0) << students[1].dump(2);
  EXPECT_EQ(students[0]["checks"][0]["points"], 1) << "its edges are off, but it starts at the caster";
  EXPECT_EQ(students[2]["points"], 2) << students[2].dump(2);
  EXPECT_NE(students[1]["checks"][1]["reason"].get<std::string>().find("custom_shader"), std::string::npos);
  const ProcessResult option =
      gnomon(Words{"compare", "thin-wall", "--size", "240x135", "--map-size", "512", "--bias", "0.4",
                   "--no-report", "-o", "out", "-q", "--json", "-"});
  const double texels = json::parse(option.out)["lights"][0]["detachment"]["mean_texels"];
  const std::string reason = students[1]["checks"][0]["reason"];
  EXPECT_NEAR(std::stod(reason.substr(reason.find(": ") + 2)), texels, 0.05) << reason;
}

// A pixel that is thrown away keeps what was there before, which must not pass for an answer.
TEST_F(Grade, AShaderThatDiscardsDrawsNothing) {
  write_rubric(one_check);
  hand_in("discards", with_edits(solution(), {"discards", {{test_line, "discard;\n  return 1.0"}}, ""}));
  const ProcessResult graded = gnomon({"grade", "rubric.json", "class", "--json", "-", "-q"});
  ASSERT_EQ(graded.exit_code, 0) << graded.err;
  const json student = json::parse(graded.out)["students"][0];
  EXPECT_EQ(student["points"], 0);
  EXPECT_NE(student["checks"][0]["reason"].get<std::string>().find("writes nothing"), std::string::npos)
      << student.dump(2);
}

TEST_F(Grade, WhatIsNoShaderIsSaidPlainly) {
  write_rubric(one_check);
  hand_in("binary", std::string("\0\1\2\xff", 4));
  hand_in("empty", "");
  hand_in("utf16", std::string("\xff\xfe/\0/\0", 6));
  const ProcessResult graded = gnomon({"grade", "rubric.json", "class", "--json", "-", "-q"});
  ASSERT_EQ(graded.exit_code, 0) << graded.err;
  const json students = json::parse(graded.out)["students"];
  const std::vector<std::string> reasons = {"technique/hard.glsl: is not text (save it as UTF-8)",
                                            "technique/hard.glsl is empty",
                                            "but seems to be UTF-16 (save it as UTF-8)"};
  for (std::size_t i = 0; i < reasons.size(); ++i) {
    const std::string reason = students[i]["checks"][0]["reason"];
    EXPECT_NE(reason.find(reasons[i]), std::string::npos) << reason;
  }
}

TEST_F(Grade, NothingThatAShaderDoesReachesTheGrader) {
  // So many pixels that the loop lasts: Mesa ends a loop after 65,536 rounds.
  write_rubric(R"("limits": {"seconds": 5}, "checks": [{"name": "draws", "points": 1, "kind": "draws",
    "runs": [{"scene": "acne-floor", "options": {"size": "640x360", "map-size": "64"}}]}])");
  hand_in(
      "endless",
      with_edits(solution(),
                 {"endless",
                  {{test_line,
                    "for (int i = 0; i < 60000; ++i)\n    for (int j = 0; j < 60000; ++j)\n      stored = "
                    "texelFetch(depth_map, texel + ivec3(int(stored * 3.0) % 2, 0, 0), 0).r;\n  "
                    "if (stored < -1.0) return 0.5;\n  " +
                        test_line}},
                  ""}));
  hand_in("linked", "", "notes.txt");
  fs::create_directories(folder / "class/linked/technique");
  fs::create_symlink("/etc/passwd", folder / "class/linked/technique/hard.glsl");
  hand_in("other", solution());
  hand_in("other", "void main() {}\n", "shade.frag");
  hand_in("outside", "#include \"../../right/technique/hard.glsl\"\n");
  fs::create_directories(folder / "class/nothing");
  const ProcessResult graded = gnomon({"grade", "rubric.json", "class", "--json", "-", "-q"});
  ASSERT_EQ(graded.exit_code, 0) << graded.err;
  const std::map<std::string, std::string> reasons = {
      {"endless", "did not end within 5 s of processor time"},
      {"linked", "technique/hard.glsl is a link"},
      {"other", "shade.frag is not to be handed in"},
      {"outside", "no such shader"},
      {"nothing", "nothing was handed in: no technique/hard.glsl"}};
  const json result = json::parse(graded.out);
  ASSERT_EQ(result["students"].size(), reasons.size());
  for (const json& student : result["students"]) {
    EXPECT_EQ(student["points"], 0);
    const std::string reason = student["checks"][0]["reason"];
    EXPECT_NE(reason.find(reasons.at(student["name"])), std::string::npos) << student.dump(2);
  }
}

// What lies below the floor lights nothing that the camera sees: no shadow's edge is measured.
TEST_F(Grade, ALightThatReachesNothingLosesNoPoints) {
  write_text(folder / "below.json", R"({"schema": "gnomon/scene/1",
    "camera": {"eye": [0, 4, 6], "target": [0, 0, 0]},
    "lights": [{"name": "sun", "type": "directional", "direction": [-1, -2, -0.5]},
               {"name": "below", "type": "directional", "direction": [0.3, 1, 0.2]}],
    "materials": [{"name": "m"}],
    "meshes": [{"name": "floor", "vertices": [[-9, 0, -9], [9, 0, -9], [9, 0, 9], [-9, 0, 9]],
                "triangles": [[0, 2, 1], [0, 3, 2]]}],
    "instances": [{"mesh": "floor", "material": "m"}]})");
  write_rubric(
      R"("checks": [{"name": "edge", "points": 1, "kind": "at_most", "measure": "edge", "at_most": "100texel",
    "runs": [{"scene": "below.json", "options": {"size": "64x36", "map-size": "64"}}]}])");
  const ProcessResult own = gnomon({"grade", "rubric.json"});
  EXPECT_EQ(own.exit_code, 0) << own.err;
  EXPECT_EQ(own.out, "the program's own shader  1 of 1\n") << own.err;
}

TEST_F(Grade, KitsAreWholeAndTheirOwnShadersPass) {
  for (const std::string kit : {"first-shadow-map", "percentage-closer-filtering"}) {
    ASSERT_EQ(gnomon({"grade", "--new", kit, kit}).exit_code, 0);
    EXPECT_TRUE(fs::exists(folder / (kit + "/README.md")));
  }
  write_text(folder / "first-shadow-map/student/technique/hard.glsl", "my work\n");
  expect_one_line(gnomon({"grade", "--new", "first-shadow-map"}), 4, "is there already and differs");
  const ProcessResult own = gnomon({"grade", "percentage-closer-filtering/rubric.json"});
  EXPECT_EQ(own.out, "the program's own shader  14 of 14\n") << own.err;
  // What a student is given compiles, and is not yet an answer.
  const ProcessResult begun = gnomon({"grade", "percentage-closer-filtering/rubric.json",
                                      "percentage-closer-filtering/student", "--csv", "-"});
  EXPECT_NE(begun.out.find("\nstudent,5,14,2,2,0,0,0,1\n"), std::string::npos) << begun.out << begun.err;
}

}  // namespace
}  // namespace gnomon::app_test
