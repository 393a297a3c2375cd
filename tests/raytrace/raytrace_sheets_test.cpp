// A texel's column and its sheets: which triangles may lie in it, and which of them hang together there, against every
// pair of triangles and on surfaces of which one can say it.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "raytrace/sheets/column_sheets.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using raytrace::Accel;
using raytrace::ColumnSheets;
using raytrace::LightVertex;
using raytrace::TexelColumn;
using raytrace::TexelKey;
using raytrace::Topology;
using raytrace::Tracer;
using test::Random;
using test::TestWorld;

/// Straight down on [-half, half]^2 of x and z.
LightView downwards(int size, double half) {
  LightView view;
  view.size = size;
  LightFace& face = view.faces[0];
  face.right = {1, 0, 0}, face.up = {0, 0, -1}, face.forward = {0, -1, 0};
  view.set_extent(Vec2(half), -10.0, 10.0);
  return view;
}

/// Makes the map off the middle and warped: rows at low y are 2.3 times as fine as those at high y.
LightView warped(int size, double half) {
  LightView view = downwards(size, 0.9 * half);
  view.faces[0].center = {0.05 * half, -0.03 * half};
  view.faces[0].warp = 0.4 / (0.9 * half);
  return view;
}

/// The cube map of a point light.
LightView around(const Vec3& position, int size) {
  Scene scene = test::scene_of({}, {test::sphere(position + Vec3(0, -1, 0), 0.1)});
  const TestWorld w(scene);
  return fit_light_view(w.world(), test::point_light(position), Camera{}, 1.0, size).value();
}

LightView spot_down(const Vec3& position, double angle, int size) {
  Light light = test::point_light(position);
  light.type = LightType::spot, light.direction = {0, -1, 0}, light.outer_angle = angle;
  const TestWorld w(test::scene_of({}, {test::sphere(position + Vec3(0, -1, 0), 0.1)}));
  return fit_light_view(w.world(), light, Camera{}, 1.0, size).value();
}

std::vector<TexelKey> all_keys(const LightView& view) {
  std::vector<TexelKey> keys;
  for (int face = 0; face < view.face_count; ++face)
    for (int row = 0; row < view.size; ++row)
      for (int column = 0; column < view.size; ++column) keys.push_back(TexelKey::pack(face, column, row));
  return keys;
}

/// The sheets of a column, independently: every triangle that may lie in it, joined pair by pair.
class PlainSheets {
 public:
  PlainSheets(const World& world, const Topology& topology, const LightView& view, TexelKey key)
      : column_(view, key.face(), key.column(), key.row()), parent_(world.triangle_count()) {
    for (std::uint32_t t = 0; t < parent_.size(); ++t) {
      parent_[t] = t;
      const auto p = world.corners(t);
      corners_.push_back({column_.vertex(p[0]), column_.vertex(p[1]), column_.vertex(p[2])});
      facing_.push_back(column_.surely_misses(corners_[t]) ? 0 : column_.facing(corners_[t]));
      if (facing_[t] != 0) inside_.push_back(t);
    }
    for (const std::uint32_t t : inside_)
      for (int k = 0; k < 3; ++k) join_across(topology, t, k);
  }
  bool same(std::uint32_t a, std::uint32_t b) const { return root(a) == root(b); }
  const std::vector<std::uint32_t>& inside() const { return inside_; }

 private:
  std::uint32_t root(std::uint32_t t) const {
    while (parent_[t] != t) t = parent_[t];
    return t;
  }
  void join_across(const Topology& topology, std::uint32_t t, int k) {
    const std::uint32_t across = topology.across(t, k);
    if (across >= Topology::non_manifold || facing_[across] != facing_[t]) return;
    const auto edge = static_cast<std::size_t>(k);
    if (!column_.surely_misses(corners_[t][edge], corners_[t][(edge + 1) % 3]))
      parent_[root(t)] = root(across);
  }

  TexelColumn column_;
  std::vector<std::uint32_t> parent_, inside_;
  std::vector<std::array<LightVertex, 3>> corners_;
  std::vector<int> facing_;
};

/// A world, its topology, and the columns of a map.
struct Columns {
  const World& world;
  LightView view;
  Topology topology;
  Columns(const World& w, const LightView& v) : world(w), view(v), topology(w) {}
  ColumnSheets sheets(TexelKey key) const { return ColumnSheets(world, topology, view, key); }
  TexelKey key_at(const Vec3& p) const {
    const TexelCoordinate t = project_to_texel(view, p);
    return TexelKey::pack(t.face, t.column(), t.row());
  }
  ColumnSheets sheets_at(const Vec3& p) const { return sheets(key_at(p)); }
};

/// The first hits along a ray.
std::vector<raytrace::Hit> hits_on(const Tracer& tracer, Ray ray, int most) {
  std::vector<raytrace::Hit> hits;
  while (static_cast<int>(hits.size()) < most) {
    const auto hit = tracer.closest_hit(ray);
    if (!hit) break;
    hits.push_back(*hit);
    ray.t.min = std::nextafter(hit->t, infinity);
  }
  return hits;
}

/// y = waves(x, z) over [-half, half]^2; a slope of at most 1.3.
Mesh waves(int steps, double half) {
  Mesh mesh;
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i <= steps; ++i) {
      const double x = half * (2.0 * i / steps - 1.0), z = half * (2.0 * j / steps - 1.0);
      mesh.positions.emplace_back(x, 0.3 * std::sin(3.0 * x) * std::cos(2.0 * z), z);
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (steps + 1) + i); };
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < steps; ++i) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      mesh.triangles.push_back({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  return mesh;
}

TEST(Topology, WeldsByPositionAndFindsNeighbours) {
  Mesh split =
      test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});  // the second triangle on vertices of its own, one at -0
  split.positions.insert(split.positions.end(), {{-0.0, 0, 0}, {1, 1, 0}, {0, 1, -0.0}});
  split.triangles = {{0, 1, 2}, {4, 5, 6}};
  const TestWorld w(test::scene_of({split}));
  const Topology t(w.world());
  EXPECT_EQ(t.across(0, 2), 1U);
  EXPECT_EQ(t.across(1, 0), 0U);
  EXPECT_EQ(t.across(0, 0), Topology::boundary);
  EXPECT_EQ(t.welded(0, 0), t.welded(1, 0));
  EXPECT_NE(t.welded(0, 1), t.welded(1, 1));
}

TEST(Topology, NonManifoldAndInconsistentEdgesAreSaid) {
  Mesh fan;
  fan.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}};
  fan.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  const TestWorld w(test::scene_of({fan}));
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(Topology(w.world()).across(i, 0), Topology::non_manifold);
  fan.triangles = {{0, 1, 2}, {0, 1, 3}};
  const TestWorld w2(test::scene_of({fan}));
  EXPECT_EQ(Topology(w2.world()).across(0, 0), Topology::non_manifold);
}

TEST(TexelColumn, MissesNoTriangleThatOneOfItsRaysMeets) {
  const TestWorld w(test::scene_of({test::triangle_soup(400, 2.0, 0.5, 41)}));
  const Tracer brute(w.world(), Accel::brute);
  Random random(42);
  for (const LightView& view : {downwards(32, 3.0), warped(32, 3.0), around({0.3, 0.2, -0.1}, 16),
                                spot_down({0.1, 6, 0.2}, 0.6, 32)}) {
    int met = 0;
    for (int i = 0; i < 20000; ++i) {
      const auto face = static_cast<int>(random.below(static_cast<std::uint32_t>(view.face_count)));
      const double u = random.uniform(0.0, view.size), v = random.uniform(0.0, view.size);
      const TexelColumn column(view, face, static_cast<int>(u), static_cast<int>(v));
      for (const raytrace::Hit& hit : hits_on(brute, texel_ray(view, face, u, v), 4)) {
        const auto p = w.world().corners(hit.primitive);
        ASSERT_FALSE(column.surely_misses({column.vertex(p[0]), column.vertex(p[1]), column.vertex(p[2])}));
        ++met;
      }
    }
    EXPECT_GT(met, 5000);
  }
}

// A triangle over half the map: it misses the texels beyond its slanted side.
TEST(TexelColumn, IsTight) {
  const std::array<Vec3, 3> p{Vec3(-1, 0, -1), Vec3(-1, 0, 1), Vec3(1, 0, -1)};
  const LightView view = downwards(64, 1.0);
  unsigned kept = 0;
  for (const TexelKey key : all_keys(view)) {
    const TexelColumn column(view, 0, key.column(), key.row());
    kept += column.surely_misses({column.vertex(p[0]), column.vertex(p[1]), column.vertex(p[2])}) ? 0 : 1;
  }
  EXPECT_LE(kept, 64U * 65U / 2U + 2U * 64U);
  EXPECT_GE(kept, 64U * 65U / 2U);
}

TEST(Sheets, AreThoseOfAllPairsOfTriangles) {
  const TestWorld w(
      test::scene_of({waves(24, 2.0), test::uv_sphere({0.3, 0.5, 0.2}, 0.6, 14, 18, 0.05, 43),
                      test::box({-1.5, 0.2, -1}, {-0.7, 1.1, 0}), test::triangle_soup(60, 1.5, 0.6, 44)}));
  Random random(45);
  std::mt19937 order(45);
  for (const LightView& view : {downwards(12, 2.0), warped(12, 2.0), around({0.2, 2.5, -0.1}, 8),
                                spot_down({0.1, 6, 0.2}, 0.3, 12)}) {
    const Columns columns(w.world(), view);
    const std::vector<TexelKey> keys = all_keys(view);
    int joined = 0, apart = 0;
    for (int n = 0; n < 150; ++n) {
      const TexelKey key = keys[random.below(static_cast<std::uint32_t>(keys.size()))];
      const PlainSheets plain(w.world(), columns.topology, view, key);
      ColumnSheets sheets = columns.sheets(key);
      std::vector<std::array<std::uint32_t, 2>> pairs;
      for (const std::uint32_t a : plain.inside())
        for (const std::uint32_t b : plain.inside()) pairs.push_back({a, b});
      std::shuffle(pairs.begin(), pairs.end(),
                   order);  // sheets are found in part, then others, then the rest
      for (const auto& [a, b] : pairs) {
        ASSERT_EQ(sheets.same(a, b), plain.same(a, b)) << a << ", " << b;
        (plain.same(a, b) ? joined : apart) += 1;
      }
    }
    EXPECT_GT(joined, 1000);
    EXPECT_GT(apart, 1000);
  }
}

TEST(Sheets, AWavyHeightFieldIsOneHoweverItIsCut) {
  Random random(46);
  for (const int steps : {8, 40, 200}) {
    const TestWorld w(test::scene_of({waves(steps, 2.0)}));
    const Tracer tracer(w.world(), Accel::bvh);
    for (const LightView& view : {downwards(16, 1.5), warped(16, 1.3), spot_down({0.1, 7, 0.2}, 0.2, 16)}) {
      const Columns columns(w.world(), view);
      for (const TexelKey key : all_keys(view)) {
        ColumnSheets sheets = columns.sheets(key);
        std::vector<std::uint32_t> met;
        for (int i = 0; i < 4; ++i) {
          const double u = key.column() + random.uniform(0.0, 1.0), v = key.row() + random.uniform(0.0, 1.0);
          const auto hits = hits_on(tracer, texel_ray(view, 0, u, v), 2);
          ASSERT_EQ(hits.size(), 1U);
          met.push_back(hits[0].primitive);
        }
        for (const std::uint32_t other : met) ASSERT_TRUE(sheets.same(met[0], other)) << steps;
      }
    }
  }
}

TEST(Sheets, AClosedSphereHasTwo) {
  const TestWorld w(test::scene_of({test::uv_sphere({0, 0, 0}, 1.0, 40, 60, 0.0, 1)}, {}));
  const Tracer tracer(w.world(), Accel::bvh);
  for (const LightView& view :
       {downwards(32, 1.2), warped(32, 1.4), around({0, 4, 0}, 32), spot_down({0.0, 4, 0.0}, 0.3, 32)}) {
    const Columns columns(w.world(), view);
    const TexelKey key = columns.key_at({0.31, 0, 0.17});
    const auto hits_at = [&](double du, double dv) {
      return hits_on(tracer, texel_ray(view, key.face(), key.column() + du, key.row() + dv), 3);
    };
    const auto one = hits_at(0.1, 0.2), other = hits_at(0.9, 0.8);
    ASSERT_EQ(one.size(), 2U);
    ASSERT_EQ(other.size(), 2U);
    ColumnSheets sheets = columns.sheets(key);
    EXPECT_TRUE(sheets.same(one[0].primitive, other[0].primitive));
    EXPECT_TRUE(sheets.same(one[1].primitive, other[1].primitive));
    EXPECT_FALSE(sheets.same(one[0].primitive, one[1].primitive));
    EXPECT_FALSE(sheets.same(other[1].primitive, one[0].primitive));
  }
}

// Two triangles to a quad: 0 and 1 below, 2 and 3 above.
TEST(Sheets, OfParallelQuadsAreTwo) {
  const TestWorld w(test::scene_of(
      {test::quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}), test::quad({-2, 1, -2}, {0, 0, 4}, {4, 0, 0})}));
  const Columns columns(w.world(), downwards(9, 1.0));
  ColumnSheets diagonal = columns.sheets_at({0.0, 0.0, 0.0});
  EXPECT_TRUE(diagonal.same(0, 1));
  EXPECT_TRUE(diagonal.same(2, 3));
  for (const std::uint32_t lower : {0U, 1U})
    for (const std::uint32_t upper : {2U, 3U}) EXPECT_FALSE(diagonal.same(lower, upper));
  // Away from the edge that they share, a quad's triangles do not hang together.
  EXPECT_FALSE(columns.sheets_at({0.6, 0.0, -0.6}).same(0, 1));
}

// Two triangles share an edge that ends before the column, and both reach into it.
TEST(Sheets, JoinOverEdgesThatCrossTheColumnAlone) {
  Mesh wedge;
  wedge.positions = {{0, 0, 0}, {0, 0, 5}, {-2, 0, -5}, {2, 0, -5}};
  wedge.triangles = {{0, 2, 1}, {0, 1, 3}};
  const TestWorld w(test::scene_of({wedge}));
  const Columns columns(w.world(), downwards(11, 5.5));
  EXPECT_FALSE(columns.sheets_at({0, 0, -1}).same(0, 1));
  EXPECT_TRUE(columns.sheets_at({0, 0, 2}).same(0, 1));
}

// Two quads meet at x = 0, and a fin stands on the seam.
TEST(Sheets, EndAtNonManifoldEdges) {
  const Mesh left = test::quad({-1, 0, -1}, {0, 0, 2}, {1, 0, 0}),
             right = test::quad({0, 0, -1}, {0, 0, 2}, {1, 0, 0}),
             fin = test::quad({0, 0, -1}, {0.2, 1, 0}, {0, 0, 2});
  const auto joined = [](const std::vector<Mesh>& parts) {
    Mesh all;
    for (const Mesh& more : parts) {
      const auto base = static_cast<std::uint32_t>(all.positions.size());
      all.positions.insert(all.positions.end(), more.positions.begin(), more.positions.end());
      for (const auto& t : more.triangles) all.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    }
    return all;
  };
  const auto any_over_seam = [](const Mesh& mesh) {
    const TestWorld w(test::scene_of({mesh}));
    const Columns columns(w.world(), downwards(10, 1.05));
    ColumnSheets sheets = columns.sheets_at({0.0, 0, 0.3});
    bool any = false;
    for (const std::uint32_t a : {0U, 1U})
      for (const std::uint32_t b : {2U, 3U}) any = any || sheets.same(a, b);
    return any;
  };
  EXPECT_TRUE(any_over_seam(joined({left, right})));
  EXPECT_FALSE(any_over_seam(joined({left, right, fin})));
}

TEST(Sheets, EdgeOnTrianglesHangTogetherWithNothing) {
  const TestWorld w(test::scene_of({test::quad({0.1, -1, -2}, {0, 2, 0}, {0, 0, 4})}));
  ColumnSheets sheets = Columns(w.world(), downwards(8, 1.0)).sheets_at({0.1, 0, 0.1});
  EXPECT_FALSE(sheets.same(0, 1));
  EXPECT_TRUE(sheets.same(0, 0));
}

}  // namespace
}  // namespace gnomon
