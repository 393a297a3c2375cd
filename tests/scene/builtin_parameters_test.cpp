// The check of generators' parameters: every wrong name, type, size, range and combination is an error that
// names it.
#include <gtest/gtest.h>

#include <set>

#include "scene/generate/generate.h"
#include "tests/scene/mesh_checks.h"

namespace gnomon {
namespace {

void expect_refused(std::string_view kind, const Parameters& parameters, std::string_view field,
                    std::string_view words) {
  const Expected<GeneratedModel> m = generate(kind, parameters);
  ASSERT_FALSE(m) << kind << " took a bad " << field;
  EXPECT_EQ(m.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(m.error().field, field);
  EXPECT_NE(m.error().reason.find(words), std::string::npos) << m.error().reason;
}

TEST(GeneratorParameters, WrongOnesAreNamed) {
  expect_refused("fnece", {}, "kind", "fnece");
  expect_refused("fnece", {}, "kind", "column, fence, floor");
  expect_refused("box", {{"siz", 3.0}}, "siz", "(allowed size, bevel)");
  expect_refused("fence", {{"lenght", 3.0}}, "lenght", "no such parameter (allowed ");
  expect_refused("fence", {{"length", -1.0}}, "length", "got -1");
  expect_refused("fence", {{"length", std::string("long")}}, "length", "a string");
  expect_refused("fence", {{"length", std::nan("")}}, "length", "out of range");
  expect_refused("fence", {{"top", std::string("spiky")}}, "top", "pointed, round, flat");
  expect_refused("box", {{"size", std::vector{1.0, 2.0}}}, "size", "got 2, allowed 3");
  expect_refused("box", {{"size", std::vector{1.0, 0.0, 1.0}}}, "size", "out of range");
  expect_refused("teapot", {{"divisions", 2.5}}, "divisions", "whole");
  expect_refused("arcade", {{"first_column", 1.0}}, "first_column", "true or false");
}

TEST(GeneratorParameters, WrongCombinationsAreNamed) {
  expect_refused("box", {{"bevel", 0.5}}, "bevel", "half");
  expect_refused("fence", {{"length", 0.12}}, "length", "room");
  expect_refused("fence", {{"bevel", 0.01}}, "bevel", "half");
  expect_refused("fence", {{"top_height", 1.2}}, "top_height", "less");
  expect_refused("fence", {{"bevel", 0.006}, {"rail_height", 0.01}}, "bevel", "rails");
  expect_refused("fence", {{"height", 0.1}, {"jitter", 4.0}}, "top_height", "lowest");
  expect_refused("fence", {{"top", std::string("round")}, {"top_height", 0.001}}, "bevel", "tops");
  EXPECT_TRUE(generate("fence", {{"top", std::string("flat")}, {"height", 0.05}}));
  expect_refused("column", {{"height", 0.5}}, "height", "six times");
  expect_refused("arcade", {{"arch_radius", 1.2}}, "arch_radius", "room");
  expect_refused("arcade", {{"height", 3.7}}, "height", "crown");
  expect_refused("arcade", {{"column_height", 0.5}}, "column_height", "six times");
  expect_refused("balustrade", {{"length", 0.5}}, "length", "room");
  expect_refused("window", {{"width", 0.2}}, "width", "shutters");
  expect_refused("paving", {{"joint", 0.5}}, "joint", "nothing");
  expect_refused("paving", {{"joint", 0.06}, {"size", std::vector{1.0, 0.05}}}, "joint", "nothing");
  expect_refused("paving", {{"thickness", 0.005}}, "thickness", "bevel");
  expect_refused("lathe", {{"profile", std::vector{0.0, 0.0, 1.0, 0.0, 1.0}}}, "profile", "even");
  expect_refused("lathe", {{"profile", std::vector{0.0, 0.0, -1.0, 0.0}}}, "profile", "negative");
  expect_refused("lathe", {{"profile", std::vector{1.0, 0.0, 1.0, 0.0}}}, "profile", "twice");
  expect_refused("lathe", {{"profile", std::vector{0.0, 0.0, 0.0, 1.0}}}, "profile", "axis");
  expect_refused("lathe", {{"creases", std::vector{9.0}}}, "creases", "lacks");
}

void expect_sound(const GeneratorInfo& info, const ParameterInfo& parameter, double value) {
  SCOPED_TRACE(std::string(info.kind) + "." + std::string(parameter.name) + " = " + std::to_string(value));
  const Expected<GeneratedModel> m = generate(info.kind, {{std::string(parameter.name), value}});
  if (!m) {
    EXPECT_FALSE(m.error().field.empty());
    return;
  }
  for (const GeneratedPart& part : m->parts) {
    if (part.mesh.triangles.size() > 100000) continue;  // long fences: more of the same pieces, only slower
    const test::MeshReport r = test::inspect(part.mesh);
    EXPECT_TRUE(std::isfinite(r.area)) << part.name;
    if (test::is_open(info.kind, part.name)) continue;
    EXPECT_EQ(r.open_edges, 0u) << part.name;
    EXPECT_GT(r.volume, 0.0) << part.name;
  }
}

// The smallest and the largest value of every numeric parameter, the others at their defaults, makes sound
// geometry or is refused by name: nothing turns inside out. Upper bounds of counts are left out where they
// would only cost time.
TEST(GeneratorParameters, EndsOfEveryRangeAreSound) {
  for (const GeneratorInfo& info : generators()) {
    for (const ParameterInfo& p : info.parameters) {
      if (!std::holds_alternative<double>(p.default_value)) continue;
      expect_sound(info, p, p.min);
      if (!p.whole || p.name == "seed" || p.max <= 64.0) expect_sound(info, p, p.max);
    }
  }
}

TEST(GeneratorParameters, TablesAreWellFormed) {
  std::string_view last;
  for (const GeneratorInfo& info : generators()) {
    EXPECT_LT(last, info.kind) << "sorted, no kind twice";
    last = info.kind;
    EXPECT_FALSE(info.description.empty());
    std::set<std::string_view> names;
    for (const ParameterInfo& p : info.parameters) {
      EXPECT_TRUE(names.insert(p.name).second) << info.kind << '.' << p.name << " twice";
      EXPECT_FALSE(p.description.empty()) << info.kind << '.' << p.name;
      EXPECT_LE(p.min, p.max);
      EXPECT_NE(p.name, "kind");
    }
  }
}

}  // namespace
}  // namespace gnomon
