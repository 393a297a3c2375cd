// Every generator's geometry: closed where it promises, wound outwards, no triangle without area, sizes as
// asked for.
#include <gtest/gtest.h>

#include "scene/generate/generate.h"
#include "tests/scene/mesh_checks.h"

namespace gnomon {
namespace {

using test::inspect;
using test::is_open;
using test::MeshReport;

GeneratedModel model(std::string_view kind, const Parameters& parameters = {}) {
  Expected<GeneratedModel> m = generate(kind, parameters);
  if (!m) ADD_FAILURE() << kind << ": " << m.error().message();
  return m ? std::move(*m) : GeneratedModel{};
}

const Mesh& part(const GeneratedModel& m, std::string_view name) {
  for (const GeneratedPart& p : m.parts) {
    if (p.name == name) return p.mesh;
  }
  ADD_FAILURE() << "no part " << name;
  static const Mesh none;
  return none;
}

void expect_promises_kept(const GeneratorInfo& info, const Parameters& parameters) {
  const GeneratedModel m = model(info.kind, parameters);
  EXPECT_FALSE(m.parts.empty()) << info.kind;
  for (const GeneratedPart& p : m.parts) {
    SCOPED_TRACE(std::string(info.kind) + "/" + p.name);
    EXPECT_NE(std::find(info.parts.begin(), info.parts.end(), p.name), info.parts.end())
        << "part not announced";
    ASSERT_FALSE(p.mesh.triangles.empty());
    ASSERT_EQ(p.mesh.normals.size(), p.mesh.positions.size());
    ASSERT_EQ(p.mesh.uvs.size(), p.mesh.positions.size());
    const MeshReport r = inspect(p.mesh);
    EXPECT_EQ(r.degenerate, 0u);
    EXPECT_EQ(r.duplicates, 0u);
    EXPECT_EQ(r.wrong_normals, 0u);
    EXPECT_GT(r.least_area, 1e-9 * r.area / static_cast<double>(p.mesh.triangles.size()));
    if (is_open(info.kind, p.name)) continue;
    EXPECT_EQ(r.open_edges, 0u) << "not closed";
    EXPECT_EQ(r.repeated_edges, 0u) << "not a manifold";
    EXPECT_GT(r.volume, 0.0) << "wound inwards";
  }
}

TEST(Generators, EveryOneKeepsItsPromises) {
  ASSERT_GE(generators().size(), 16u);
  for (const GeneratorInfo& info : generators()) expect_promises_kept(info, {});
}

TEST(Generators, KeepTheirPromisesWithOtherParameters) {
  const std::vector<std::pair<std::string_view, Parameters>> variants{
      {"fence", {{"top", std::string("round")}, {"jitter", 4.0}}},
      {"fence", {{"top", std::string("flat")}, {"bevel", 0.0}, {"rails", std::vector<double>{}}}},
      {"fence", {{"first_post", false}, {"last_post", false}, {"length", 7.3}}},
      {"box", {{"size", std::vector{0.3, 20.0, 5.0}}, {"bevel", 0.149}}},
      {"lathe",
       {{"profile", std::vector{0.5, 0.0, 0.5, 1.0, 0.4, 1.0, 0.4, 0.0, 0.5, 0.0}}, {"segments", 3.0}}},
      {"bush", {{"shape", std::string("box")}, {"size", std::vector{9.0, 1.5, 0.8}}, {"flowers", 20.0}}},
      {"tree", {{"levels", 1.0}, {"seed", 5.0}}},
      {"tree", {{"levels", 4.0}, {"spread", 1.5}, {"leaves", 10.0}}},
      {"arcade", {{"bays", 1.0}, {"segments", 6.0}, {"arch_segments", 5.0}, {"end", 0.0}}},
      {"arcade", {{"bay", 6.0}, {"arch_radius", 2.7}, {"height", 7.0}, {"depth", 1.0}}},
      {"column", {{"height", 0.5}, {"radius", 0.05}, {"segments", 7.0}}},
      {"stairs", {{"steps", 1.0}}},
      {"stairs", {{"steps", 30.0}, {"rise", 0.2}, {"nosing", 0.05}}},
      {"balustrade", {{"length", 20.0}, {"pedestal_spacing", 2.0}, {"segments", 5.0}}},
      {"stairs", {{"rise", 0.5}, {"tread", 0.02}}},
      {"balustrade", {{"height", 5.0}, {"pedestal_width", 0.05}}},
      {"stepping_stones", {{"rise", 1.0}}},
      {"window", {{"shutters", false}, {"width", 2.0}}},
      {"bench", {{"length", 3.0}}},
      {"paving", {{"jitter", 3.0}, {"seed", 9.0}, {"size", std::vector{3.0, 3.0}}}},
      {"stepping_stones", {{"count", 40.0}, {"seed", 3.0}}},
      {"sphere", {{"subdivisions", 0.0}}},
      {"teapot", {{"divisions", 9.0}}},  // coarser, and the true normals leave the facets behind
      {"teapot", {{"divisions", 40.0}, {"height", 3.0}}},
  };
  for (const auto& [kind, parameters] : variants) {
    const auto all = generators();
    const auto info = std::ranges::find(all, kind, &GeneratorInfo::kind);
    ASSERT_NE(info, all.end()) << kind;
    expect_promises_kept(*info, parameters);
  }
}

TEST(Generators, AreDeterministic) {
  for (const GeneratorInfo& info : generators()) {
    const GeneratedModel a = model(info.kind), b = model(info.kind);
    ASSERT_EQ(a.parts.size(), b.parts.size());
    for (std::size_t i = 0; i < a.parts.size(); ++i) {
      EXPECT_EQ(a.parts[i].mesh.positions, b.parts[i].mesh.positions) << info.kind;
      EXPECT_EQ(a.parts[i].mesh.triangles, b.parts[i].mesh.triangles) << info.kind;
    }
  }
}

TEST(Generators, SeedsMakeVariations) {
  for (const GeneratorInfo& info : generators()) {
    const bool seeded = std::any_of(info.parameters.begin(), info.parameters.end(),
                                    [](const ParameterInfo& p) { return p.name == "seed"; });
    if (!seeded) continue;
    const GeneratedModel a = model(info.kind), b = model(info.kind, {{"seed", 2.0}});
    EXPECT_NE(a.parts.back().mesh.positions == b.parts.back().mesh.positions &&
                  a.parts.front().mesh.positions == b.parts.front().mesh.positions,
              true)
        << info.kind;
  }
}

TEST(Generators, FloorFacesUpWithMetresAsTextureCoordinates) {
  const GeneratedModel m =
      model("floor", {{"size", std::vector{6.0, 4.0}}, {"divisions", std::vector{3.0, 2.0}}});
  const Mesh& mesh = part(m, "floor");
  EXPECT_EQ(mesh.triangles.size(), 12u);
  const MeshReport r = inspect(mesh);
  EXPECT_DOUBLE_EQ(r.area, 24.0);
  EXPECT_EQ(r.bounds.min, Vec3(-3, 0, -2));
  EXPECT_EQ(r.bounds.max, Vec3(3, 0, 2));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_EQ(mesh.uvs[i], Vec2f(Vec2(mesh.positions[i].x, mesh.positions[i].z)));
  }
}

TEST(Generators, BoxHasTheVolumeOfABox) {
  const GeneratedModel sharp = model("box", {{"size", std::vector{2.0, 3.0, 4.0}}});
  EXPECT_EQ(part(sharp, "box").triangles.size(), 12u);
  const MeshReport r = inspect(part(sharp, "box"));
  EXPECT_NEAR(r.volume, 24.0, 1e-12);
  EXPECT_NEAR(r.area, 52.0, 1e-12);
  EXPECT_EQ(r.bounds.min, Vec3(-1, 0, -2));
  // A chamfer of width b takes b^2/2 per length off each edge: of the 4 (a+b+c) of edges, the corners'
  // overlap aside.
  const double b = 0.1;
  const MeshReport c =
      inspect(part(model("box", {{"size", std::vector{2.0, 3.0, 4.0}}, {"bevel", b}}), "box"));
  const double edges = 4.0 * (2.0 - 2 * b + 3.0 - 2 * b + 4.0 - 2 * b) * b * b / 2.0;
  // At each corner a cube of side b keeps the tetrahedron-like sixth that lies inside all three chamfers'
  // planes.
  EXPECT_NEAR(c.volume, 24.0 - edges - 8.0 * (1.0 - 1.0 / 6.0) * b * b * b, 1e-12);
}

TEST(Generators, LatheTurnsACylinder) {
  const GeneratedModel m = model("lathe", {{"profile", std::vector{0.0, 0.0, 0.5, 0.0, 0.5, 2.0, 0.0, 2.0}},
                                           {"creases", std::vector{1.0, 2.0}},
                                           {"segments", 96.0}});
  const MeshReport r = inspect(part(m, "lathe"));
  // The regular 96-gon's area against the circle's.
  const double polygon = 0.5 * 96.0 * std::sin(2.0 * pi / 96.0) * 0.25;
  EXPECT_NEAR(r.volume, 2.0 * polygon, 1e-12);
  EXPECT_EQ(part(m, "lathe").triangles.size(), 4u * 96u);
}

TEST(Generators, SphereConvergesToTheSphere) {
  const MeshReport r = inspect(part(model("sphere", {{"radius", 1.5}, {"subdivisions", 5.0}}), "sphere"));
  const double exact = 4.0 / 3.0 * pi * 1.5 * 1.5 * 1.5;
  EXPECT_LT(r.volume, exact);  // the corners lie on the sphere, so the body lies inside
  EXPECT_NEAR(r.volume, exact, 2e-3 * exact);
  EXPECT_NEAR(r.bounds.min.y, 0.0, 1e-3);
}

TEST(Generators, FenceHasThePicketsThatFit) {
  const GeneratedModel m =
      model("fence", {{"length", 4.0}, {"picket_width", 0.1}, {"gap", 0.1}, {"jitter", 0.0}});
  // 20 pickets of 0.1 with 19 gaps are 3.9 long. A bevelled pentagonal prism has 4 rings: 3 * 5 quads, two
  // caps of 3 triangles.
  EXPECT_EQ(part(m, "picket").triangles.size(), 20u * (3u * 5u * 2u + 2u * 3u));
  const MeshReport pickets = inspect(part(m, "picket")), posts = inspect(part(m, "post")),
                   rails = inspect(part(m, "rail"));
  EXPECT_NEAR(pickets.bounds.max.y, 1.05, 1e-12);
  EXPECT_NEAR(pickets.bounds.min.x + pickets.bounds.max.x, 4.0, 1e-12);
  EXPECT_GT(rails.bounds.min.x, 0.0);  // a rail's end is hidden in its post
  EXPECT_LT(rails.bounds.max.x, 4.0);
  EXPECT_LT(posts.bounds.min.z, rails.bounds.min.z);
}

TEST(Generators, StairsReachTheirHeight) {
  const GeneratedModel m = model("stairs", {{"steps", 5.0}, {"rise", 0.2}, {"tread", 0.3}, {"width", 2.0}});
  const MeshReport treads = inspect(part(m, "tread")), risers = inspect(part(m, "riser"));
  EXPECT_NEAR(treads.bounds.max.y, 1.0, 1e-12);
  EXPECT_LT(risers.bounds.max.y, 1.0);  // hidden in the topmost tread
  EXPECT_NEAR(risers.bounds.min.z, -1.5, 1e-12);
}

TEST(Generators, ArcadeLeavesOutTheColumnsOfItsNeighbours) {
  const auto columns = [](bool first, bool last) {
    const GeneratedModel m = model("arcade", {{"bays", 3.0}, {"first_column", first}, {"last_column", last}});
    return part(m, "column").triangles.size();
  };
  const std::size_t one = columns(true, true) / 4;
  EXPECT_EQ(columns(true, true), 4 * one);
  EXPECT_EQ(columns(false, true), 3 * one);
  EXPECT_EQ(columns(false, false), 2 * one);
}

TEST(Generators, LeavesAndBladesAreCounted) {
  EXPECT_EQ(part(model("tree", {{"leaves", 500.0}}), "leaf").triangles.size(), 1000u);
  EXPECT_EQ(part(model("bush", {{"leaves", 300.0}, {"flowers", 7.0}}), "leaf").triangles.size(), 600u);
  EXPECT_EQ(part(model("bush", {{"flowers", 7.0}}), "flower").triangles.size(), 35u);
  EXPECT_EQ(part(model("grass", {{"blades", 123.0}}), "blade").triangles.size(), 369u);
  EXPECT_EQ(model("tree", {{"leaves", 0.0}}).parts.size(), 1u);  // no empty part
}

}  // namespace
}  // namespace gnomon
