// Expressions: what they mean, and that every mistake is told with its place.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/files/formats.h"
#include "scene/shapes/expression.h"
#include "scene/shapes/solid.h"

namespace gnomon {
namespace {

double at(const char* text, double x, double y = 0.0, double z = 0.0) {
  const auto e = parse_expression(text);
  EXPECT_TRUE(e) << text << ": " << (e ? "" : e.error().reason);
  return e ? evaluate(*e, x, y, z) : std::nan("");
}

TEST(Expression, MeansWhatPeopleMean) {
  EXPECT_EQ(at("1 + 2 * 3", 0), 7.0);
  EXPECT_EQ(at("8 / 4 / 2", 0), 1.0);
  EXPECT_EQ(at("5 - 3 - 1", 0), 1.0);
  EXPECT_EQ(at("-x^2", 3), -9.0);
  EXPECT_EQ(at("2^3^2", 0), 512.0);
  EXPECT_EQ(at("x^-2", 2), 0.25);
  EXPECT_EQ(at("-2 * -x", 3), 6.0);
  EXPECT_EQ(at("(x + y) * z", 1, 2, 3), 9.0);
  EXPECT_EQ(at("max(x, min(y, z))", 1, 5, 3), 3.0);
  EXPECT_EQ(at("abs(x) + sqrt(y)", -2, 9), 5.0);
  EXPECT_DOUBLE_EQ(at("pow(x, 0.5)", 2), std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(at("x^y", 2, 1.5), std::pow(2.0, 1.5));
  EXPECT_DOUBLE_EQ(at("sin(pi * x) + cos(0) + exp(log(y))", 0.5, 7), 9.0);
  EXPECT_EQ(at("1.5e2 + .5", 0), 150.5);
}

TEST(Expression, EqualPartsAreWorkedOutOnce) {
  const auto e = parse_expression("(x^2 + y^2) * (x^2 + y^2) - 2 * 3");
  ASSERT_TRUE(e);
  EXPECT_EQ(e->steps.size(), 8u);  // x, x^2, y, y^2, +, *, 6, -
}

TEST(Expression, GradientsAreDerivatives) {
  using Number = Differential<double, Vec3>;
  const char* texts[] = {"x*y/z + x^3",           "sin(x*y) - cos(z)", "exp(x) * log(y + 2)",
                         "sqrt(x^2 + y^2 + z^2)", "pow(y, x) + y^-3",  "min(x*y, z)",
                         "max(x, y*z)",           "abs(x - z)"};
  const Vec3 p(0.7, 1.3, 0.4);
  for (const char* text : texts) {
    const auto e = parse_expression(text);
    ASSERT_TRUE(e);
    const auto g = evaluate(*e, Number(p.x, {1, 0, 0}), Number(p.y, {0, 1, 0}), Number(p.z, {0, 0, 1}));
    for (int a = 0; a < 3; ++a) {
      Vec3 q = p, r = p;
      q[a] += 1e-6, r[a] -= 1e-6;
      EXPECT_NEAR(g.change[a], (evaluate(*e, q.x, q.y, q.z) - evaluate(*e, r.x, r.y, r.z)) / 2e-6, 1e-8)
          << text;
    }
  }
}

TEST(Expression, MistakesHaveAPlace) {
  struct Mistake {
    const char* text;
    int column;
    const char* reason;
  };
  const Mistake mistakes[] = {
      {"", 1, "is empty"},
      {"   ", 1, "is empty"},
      {"x +", 4, "ends too early"},
      {"x + * y", 5, "unexpected character"},
      {"2 x", 3, "unexpected character"},
      {"(x + 1", 7, "\")\" is missing"},
      {"x)", 2, "unexpected character"},
      {"foo(x)", 1, "unknown name (got \"foo\""},
      {"w", 1, "unknown name (got \"w\""},
      {"min(x)", 6, "min needs two arguments"},
      {"sin(x, y)", 6, "sin has one argument"},
      {"1e999", 1, "number out of range"},
      {"x + 1/0", 6, "has no finite value"},
      {"log(-1) + x", 1, "has no finite value"},
      {"x^100", 2, "exponent out of range (got 100"},
      {"x $ y", 3, "unexpected character (got \"$\""},
      {"x + \x01", 5, "unexpected character (got \"\\x01\""},
      {".", 1, "is not a number"},
  };
  for (const Mistake& m : mistakes) {
    const auto e = parse_expression(m.text);
    ASSERT_FALSE(e) << m.text;
    EXPECT_EQ(e.error().column, m.column) << m.text << ": " << e.error().reason;
    EXPECT_EQ(e.error().reason.find(m.reason), 0u) << m.text << ": " << e.error().reason;
  }
}

TEST(Expression, DepthAndSizeAreCapped) {
  const std::string deep = std::string(100000, '(') + "x" + std::string(100000, ')');
  EXPECT_NE(parse_expression(deep).error().reason.find("too deeply nested"), std::string::npos);
  EXPECT_NE(parse_expression(std::string(100000, '-') + "x").error().reason.find("too deeply nested"),
            std::string::npos);
  std::string powers = "x";
  for (int i = 0; i < 10000; ++i) powers += "^y";
  EXPECT_NE(parse_expression(powers).error().reason.find("too deeply nested"), std::string::npos);
  std::string sum = "x";
  for (int i = 0; i < 10000; ++i) sum += " + " + std::to_string(i) + " * x";
  EXPECT_NE(parse_expression(sum).error().reason.find("too many operations"), std::string::npos);
}

// ---- in a scene ----

std::string complete_notes(const Scene& scene) {
  std::string all;
  for (const std::string& note : scene.notes) all += note;
  return all;
}

std::string message_on_shape(const std::string& shape) {
  const auto scene = load_json_scene(
      "{\"schema\": \"gnomon/scene/1\", \"materials\": [{\"name\": \"m\"}],\n\"shapes\": [{\"material\": "
      "\"m\", " +
          shape + "}]}",
      "s.json", ".", {});
  return scene ? "loaded" : scene.error().message();
}

TEST(SolidsInScenes, AreRead) {
  for (const char* shape :
       {R"("ellipsoid": {"center": [0,0,0], "radii": [1,2,3], "rotate": {"axis": [1,0,0], "degrees": 30}})",
        R"("cylinder": {"base": [0,0,0], "axis": [1,1,0], "radius": 1, "height": 2, "closed": false})",
        R"("cone": {"base": [0,0,0], "radius": 1, "height": 2})",
        R"("paraboloid": {"base": [0,0,0], "radius": 1, "height": 2})",
        R"("hyperboloid": {"center": [0,0,0], "radius": 1, "waist": 0.5, "height": 2})",
        R"("hyperboloid": {"center": [0,0,0], "radius": 1, "gap": 0.5, "height": 2})",
        R"("torus": {"center": [0,0,0], "major_radius": 1, "minor_radius": 0.25})",
        R"("implicit": {"function": "x^2+y^2+z^2-1", "box": [[-1,-1,-1],[1,1,1]]})"})
    EXPECT_EQ(message_on_shape(shape), "loaded") << shape;
}

TEST(SolidsInScenes, OpenGlassIsNoted) {
  const auto notes_of = [](const std::string& geometry, const std::string& more = "") {
    const auto scene = load_json_scene(
        R"({"schema": "gnomon/scene/1", "materials": [{"name": "m", "transmission": 1)" + more + R"(}],
            "camera": {"eye": [0,0,5], "target": [0,0,0]}, "lights": [{"type": "directional", "direction": [0,-1,0]}], )" +
            geometry + "}",
        "s.json", ".", {});
    EXPECT_TRUE(scene) << scene.error().message();
    return scene ? complete_notes(*scene) : std::string();
  };
  const std::string tetrahedron =
      R"("vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], "triangles": [[0,2,1],[0,1,3],[1,2,3])";
  const std::string instance = R"(}], "instances": [{"mesh": "t", "material": "m"}])";
  EXPECT_EQ(notes_of(R"("meshes": [{"name": "t", )" + tetrahedron + ",[0,3,2]]" + instance), "");
  EXPECT_EQ(notes_of(R"("meshes": [{"name": "t", )" + tetrahedron + "]" + instance),
            "The glass mesh 't' is not closed (3 open edges): it has no inside to refract in.");
  const std::string pipe = R"("shapes": [{"name": "pipe", "material": "m",
              "cylinder": {"base": [0,0,0], "radius": 1, "height": 1, "closed": false}}])";
  EXPECT_EQ(notes_of(pipe), "The glass shape 'pipe' is open: it has no inside to refract in.");
  // A thin sheet refracts nothing, and needs no inside.
  EXPECT_EQ(notes_of(R"("meshes": [{"name": "t", )" + tetrahedron + "]" + instance, R"(, "thin": true)"), "");
  EXPECT_EQ(notes_of(pipe, R"(, "thin": true)"), "");
}

TEST(SolidsInScenes, MistakesAreOneLine) {
  const std::pair<const char*, const char*> mistakes[] = {
      {R"("ellipsoid": {"center": [0,0,0], "radii": [1,-2,3]})",
       "s.json:2:75: shapes[0].ellipsoid.radii[1]: out of range (got -2, allowed a number in (0, 1e+15])"},
      {R"("cylinder": {"base": [0,0,0], "radius": -1, "height": 2})",
       "s.json:2:70: shapes[0].cylinder.radius: out of range (got -1, allowed a number in (0, 1e+15])"},
      {R"("cylinder": {"base": [0,0,0], "radius": 1, "height": 0})",
       "s.json:2:83: shapes[0].cylinder.height: out of range (got 0"},
      {R"("cylinder": {"base": [0,0,0], "axis": [0,0,0], "radius": 1, "height": 1})",
       "s.json:2:68: shapes[0].cylinder.axis: "},
      {R"("cone": {"base": [0,0,0], "radius": 0, "height": 1})",
       "s.json:2:38: shapes[0].cone: the cone has no width"},
      {R"("hyperboloid": {"center": [0,0,0], "radius": 1, "waist": 1, "height": 1})",
       "s.json:2:87: shapes[0].hyperboloid.waist: out of range (got 1, allowed a number in [0, 1))"},
      {R"("hyperboloid": {"center": [0,0,0], "radius": 1, "height": 1})",
       "s.json:2:45: shapes[0].hyperboloid: "},
      {R"("torus": {"center": [0,0,0], "major_radius": 1, "minor_radius": 1})",
       "s.json:2:94: shapes[0].torus.minor_radius: out of range (got 1, allowed a number in (0, 1))"},
      {R"("torus": {"center": [0,0,0], "major_radius": NaN, "minor_radius": 1})", "s.json:2:75: "},
      {R"("implicit": {"function": "x +", "box": [[-1,-1,-1],[1,1,1]]})",
       "s.json:2:55: shapes[0].implicit.function: at character 4 of \"x +\": ends too early"},
      {R"("implicit": {"function": "x", "box": [[-1,-1,-1],[1,-1,1]]})",
       "s.json:2:67: shapes[0].implicit.box: is empty (needs two corners"},
      {R"("implicit": {"function": 3, "box": [[-1,-1,-1],[1,1,1]]})",
       "s.json:2:55: shapes[0].implicit.function: wrong type"},
      {R"("torsu": {})", "s.json:2:30: shapes[0].torsu: unknown key"},
  };
  for (const auto& [shape, start] : mistakes) {
    const std::string message = message_on_shape(shape);
    EXPECT_EQ(message.find(start), 0u) << shape << "\n  " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace gnomon
