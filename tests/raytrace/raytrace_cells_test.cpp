// A light's blocks (raytrace/packets/shadow_block.h) where the bounds are tight: receivers exactly on the lines of a
// grid before the light and on their crossings, triangles whose corners and edges lie there too, triangles that touch
// a cell in one point, slivers, triangles that reach through the light's plane; lights near and far. Every
// visibility is held against brute force in double, for every instruction set that this machine has.
#include <gtest/gtest.h>

#include "raytrace/packets/light_setup.h"
#include "raytrace/packets/shadow_pass.h"
#include "raytrace/precision/ray_offset.h"
#include "raytrace/tiles.h"
#include "scene/light.h"
#include "tests/support/every_target.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using namespace raytrace;  // NOLINT(google-build-using-namespace): every second word here is from that room
using test::Random;
using test::TestWorld;

constexpr ImageSize size{96, 96};
constexpr double half_patch = 1.0;  // receivers lie on the floor, at most so far from the middle
constexpr double floor_reach = 64.0;

struct Setting {
  const char* name;
  Light light;
  double ceiling;  ///< triangles are below it
};

/// The floor is the first triangle.
Mesh floor_mesh() {
  Mesh mesh;
  const double l = floor_reach;
  mesh.positions = {{-l, 0, -l}, {-l, 0, 3 * l}, {3 * l, 0, -l}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

/// Keeps the world's bounds the same whatever triangles are added.
Mesh corner_posts(double ceiling) {
  const double far = 3.0 * floor_reach, top = 2.0 * ceiling;
  Mesh mesh;
  mesh.positions = {{far, top, far},    {far - 1, top, far},   {far, top, far - 1},
                    {-far, -top, -far}, {1 - far, -top, -far}, {-far, -top, 1 - far}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  return mesh;
}

SurfacePoint floor_point(double x, double z) {
  const Mesh mesh = floor_mesh();
  const std::array<Vec3, 3> corners{mesh.positions[0], mesh.positions[1], mesh.positions[2]};
  SurfacePoint point;
  point.barycentric = Vec2(z + floor_reach, x + floor_reach) / (4.0 * floor_reach);
  point.position = triangle_point(corners, point.barycentric, point.position_error);
  point.normal = Vec3(0, 1, 0);
  point.primitive = 0;
  return point;
}

/// The plane of (u, v) before the light, and lines in it.
class LightPlane {
 public:
  explicit LightPlane(const EdgeSetup& setup) : origin_(setup.origin), directional_(setup.directional) {
    std::copy(std::begin(setup.axes), std::end(setup.axes), axes_.begin());
    u_ = {infinity, -infinity}, v_ = u_;
    for (const double x : {-half_patch, half_patch})
      for (const double z : {-half_patch, half_patch}) {
        double u = 0.0, v = 0.0;
        EXPECT_TRUE(project_point(setup, {x, 0.0, z}, u, v));
        u_ = {std::min(u_.low, u), std::max(u_.high, u)}, v_ = {std::min(v_.low, v), std::max(v_.high, v)};
      }
  }
  double u_line(int i) const { return u_.low + i * u_width(); }
  double v_line(int i) const { return v_.low + i * v_width(); }
  double u_width() const { return (u_.high - u_.low) / lines; }
  double v_width() const { return (v_.high - v_.low) / lines; }
  static int columns() { return lines; }
  static int rows() { return lines; }

  /// Where the ray of (u, v) has this height; a point's ray is followed backwards too.
  Vec3 at_height(double u, double v, double height) const {
    const Vec3 across = u * axes_[0] + v * axes_[1];
    if (directional_) {
      const Vec3 p = origin_ + across;
      return p + (height - p.y) / axes_[2].y * axes_[2];
    }
    const Vec3 d = across + axes_[2];
    return origin_ + (height - origin_.y) / d.y * d;
  }

 private:
  struct Range {
    double low = 0.0, high = 0.0;
  };
  static constexpr int lines = 64;
  Vec3 origin_;
  bool directional_;
  std::array<Vec3, 3> axes_;
  Range u_, v_;
};

/// 0, or so little that floats just tell it, or do not.
double whisker(Random& random, double width) {
  constexpr std::array<double, 7> steps{0.0, 0.0, 0x1p-30, 0x1p-24, 0x1p-22, 0x1p-18, 0x1p-12};
  const double step = steps[random.below(static_cast<std::uint32_t>(steps.size()))];
  return (random.below(2) == 0 ? step : -step) * width;
}

struct Places {
  double u, v;
};

/// A crossing of lines, a point of a line, or anywhere in a cell.
Places place_in(const LightPlane& plane, int column, int row, Random& random) {
  const auto kind = random.below(4);
  double u = plane.u_line(column), v = plane.v_line(row);
  if (kind == 1 || kind == 3) u += random.uniform(0.0, 1.0) * plane.u_width();
  if (kind == 2 || kind == 3) v += random.uniform(0.0, 1.0) * plane.v_width();
  u += whisker(random, plane.u_width());
  return {u, v + whisker(random, plane.v_width())};
}

/// Tiles of receivers on the floor, each tile a square of it, its corners among them.
struct Receivers {
  Image<SurfacePoint> points{size, SurfacePoint{}};
  HugeArray<QuantisedTile> tiles{TileGrid{size}.count()};

  double edge(int pixel) const { return half_patch * (2.0 * pixel / size.width - 1.0); }

  explicit Receivers(const LightPlane* plane, std::uint64_t seed) {
    for_each_tile(TileGrid{size}, [&](std::size_t i, int x0, int y0, int x1, int y1) {
      Random random(seed + i);
      TileDraft draft;
      tiles[i].clear();
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
          const bool corner = (x == x0 || x == x1 - 1) && (y == y0 || y == y1 - 1);
          SurfacePoint& point = points.at(x, y);
          if (corner)
            point = floor_point(edge(x == x0 ? x0 : x1), edge(y == y0 ? y0 : y1));
          else if (plane != nullptr)
            point = receiver(*plane, {edge(x0), edge(y0)}, {edge(x1), edge(y1)}, random);
          if (point.primitive != no_id) tiles[i].put(tile_lane(x - x0, y - y0), point, draft);
        }
      tiles[i].finish(draft, Vec3(0.0, 3.0, 0.0));
      publish_receivers();
    });
  }

 private:
  /// Makes a receiver of a random cell's; the next try follows when it is not in the tile's square.
  static SurfacePoint receiver(const LightPlane& plane, const Vec2& lo, const Vec2& hi, Random& random) {
    for (int tries = 0; tries < 4000; ++tries) {
      const auto column = random.below(static_cast<std::uint32_t>(plane.columns())),
                 row = random.below(static_cast<std::uint32_t>(plane.rows()));
      const Places p = place_in(plane, static_cast<int>(column), static_cast<int>(row), random);
      const Vec3 foot = plane.at_height(p.u, p.v, 0.0);
      if (foot.x > lo.x && foot.x < hi.x && foot.z > lo.y && foot.z < hi.y)
        return floor_point(foot.x, foot.z);
    }
    return floor_point(0.5 * (lo.x + hi.x), 0.5 * (lo.y + hi.y));
  }
};

class Occluders {
 public:
  Occluders(const LightPlane& plane, const Setting& setting, std::uint64_t seed)
      : plane_(plane), setting_(setting), random_(seed) {}

  Mesh make(int count) {
    for (int i = 0; i < count; ++i) add(i % 6, i < 18);
    return std::move(mesh_);
  }

 private:
  int column() { return static_cast<int>(random_.below(static_cast<std::uint32_t>(plane_.columns()))); }
  int row() { return static_cast<int>(random_.below(static_cast<std::uint32_t>(plane_.rows()))); }
  /// Below the ceiling, now and then very near to the floor, or beyond the light.
  double height(bool through) {
    if (through && random_.below(2) == 0) return setting_.ceiling * random_.uniform(1.0, 1.9);
    return setting_.ceiling * (random_.below(8) == 0 ? 1e-3 : random_.uniform(0.02, 0.95));
  }
  Vec3 at(double u, double v, double h) const { return plane_.at_height(u, v, h); }
  /// On these lines, but for a whisker.
  Vec3 near(double u, double v, double h) {
    const double near_u = u + whisker(random_, plane_.u_width());
    return at(near_u, v + whisker(random_, plane_.v_width()), h);
  }
  void put(const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
    mesh_.positions.insert(mesh_.positions.end(), {a, b, c});
    mesh_.triangles.push_back({first, first + 1, first + 2});
  }

  void add(int kind, bool through) {
    const int i = column(), j = row(), reach = 1 + static_cast<int>(random_.below(3));
    const double u = plane_.u_line(i), v = plane_.v_line(j), du = plane_.u_width(), dv = plane_.v_width();
    const auto some = [&](double width) { return width * (static_cast<double>(random_.below(7)) - 3.0); };
    switch (kind) {
      case 0: {  // corners on crossings
        const auto crossing = [&] {
          const double a = some(du), b = some(dv);
          return near(u + a, v + b, height(false));
        };
        const Vec3 first = near(u, v, height(false)), second = crossing();
        return put(first, second, crossing());
      }
      case 1: {  // touches a crossing with a corner, the rest in one quadrant
        const double su = random_.below(2) == 0 ? -du : du, sv = random_.below(2) == 0 ? -dv : dv;
        const auto in_quadrant = [&] {
          const double a = su * random_.uniform(0.1, 2.0), b = sv * random_.uniform(0.1, 2.0);
          return at(u + a, v + b, height(false));
        };
        const Vec3 first = near(u, v, height(false)), second = in_quadrant();
        return put(first, second, in_quadrant());
      }
      case 2: {  // an edge through a crossing, aslant, the rest on one side
        const double a = random_.uniform(0.5, 2.5) * du, b = random_.uniform(0.5, 2.5) * dv;
        const double h = height(false);
        const double su = whisker(random_, du), sv = whisker(random_, dv);
        return put(at(u + a + su, v - b + sv, h), at(u - a + su, v + b + sv, h),
                   at(u + reach * a, v + reach * b, h));
      }
      case 3: {  // an edge along a line
        const double h = height(false), uu = u + whisker(random_, du);
        const Vec3 second = at(uu, v + reach * dv, height(false));
        const double a = random_.uniform(-2.0, 2.0) * du, b = random_.uniform(-1.0, 2.0) * dv;
        return put(at(uu, v, h), second, at(u + a, v + b, h));
      }
      case 4: {  // sliver
        const double h = height(false), s = random_.uniform(0.0, 1.0), a = some(du), b = some(dv);
        const Vec3 first = near(u, v, h);
        return put(first, at(u + a, v + b, h), near(u + s * a, v + s * b, h));
      }
      default: {  // through the light's plane (only few: they hide much), or just large
        const double a = some(du), b = 0.5 * some(dv), c = 0.5 * some(du);
        const Vec3 first = near(u, v, height(through)), second = at(u + a, v + b, height(through));
        return put(first, second, near(u + c, v, height(false)));
      }
    }
  }

  const LightPlane& plane_;
  const Setting& setting_;
  Random random_;
  Mesh mesh_;
};

Scene scene_with(const Setting& setting, Mesh occluders) {
  std::vector<Mesh> meshes{floor_mesh(), corner_posts(setting.ceiling)};
  if (!occluders.triangles.empty()) meshes.push_back(std::move(occluders));
  Scene scene = test::scene_of(std::move(meshes));
  scene.lights = {setting.light};
  return scene;
}

LightPlane plane_of(const Setting& setting) {
  const TestWorld w(scene_with(setting, {}));
  const Tracer tracer(w.world(), Accel::bvh);
  Aabb patch;
  patch.grow(Vec3(-half_patch, 0.0, -half_patch)), patch.grow(Vec3(half_patch, 0.0, half_patch));
  return LightPlane(edge_setup_of_light(tracer, setting.light, patch));
}

Image<PointVisibility> one_by_one(const Tracer& tracer, const Light& light, const Receivers& receivers) {
  Image<PointVisibility> out(size, PointVisibility::lit);
  for_each_pixel(TileGrid{size}, [&](int x, int y, std::size_t) {
    const SurfacePoint& p = receivers.points.at(x, y);
    out.at(x, y) = light_cannot_reach(light, p.position, p.normal) ? PointVisibility::shadowed
                                                                   : tracer.centre_visibility(p, light);
  });
  return out;
}

Image<PointVisibility> by_blocks(const Tracer& tracer, const Light& light, const Receivers& receivers) {
  Image<PointVisibility> out(size, PointVisibility::lit);
  shadow_pass({.tracer = tracer,
               .size = size,
               .stored = &receivers.points,
               .view = nullptr,
               .hits = {},
               .quantised = {receivers.tiles.data(), receivers.tiles.size()}},
              light, out);
  return out;
}

std::array<std::uint64_t, 3> counts_of(const Image<PointVisibility>& visibility) {
  std::array<std::uint64_t, 3> counts{};
  for (const PointVisibility v : visibility.data) ++counts[static_cast<std::size_t>(v)];
  return counts;
}

/// False, and nothing is checked, where nearly all is lit or nearly all is dark: large triangles can hide everything.
bool check(const Setting& setting, int triangles, std::uint64_t seed) {
  SCOPED_TRACE(setting.name);
  const LightPlane plane = plane_of(setting);
  const TestWorld w(scene_with(setting, Occluders(plane, setting, seed).make(triangles)));
  const Tracer tracer(w.world(), Accel::bvh);
  const Receivers receivers(&plane, seed + 1000);
  const Image<PointVisibility> truth = one_by_one(Tracer(w.world(), Accel::brute), setting.light, receivers);
  const auto counts = counts_of(truth);
  const auto few = [&](PointVisibility v) {
    return counts[static_cast<std::size_t>(v)] <= truth.data.size() / 100;
  };
  if (few(PointVisibility::shadowed) || few(PointVisibility::lit)) return false;
  // Single rays do not know of blocks, but have hierarchies to leave something out.
  for (const Accel accel : {Accel::bvh, Accel::two_level})
    EXPECT_EQ(one_by_one(Tracer(w.world(), accel), setting.light, receivers).data, truth.data);
  test::for_each_target([&] {
    const Image<PointVisibility> found = by_blocks(tracer, setting.light, receivers);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < found.data.size(); ++i) wrong += found.data[i] == truth.data[i] ? 0 : 1;
    EXPECT_EQ(wrong, 0u) << packet_target();
  });
  return true;
}

std::vector<Setting> settings() {
  return {{"above", test::point_light({0.1, 2.5, -0.2}), 2.0},
          {"near", test::point_light({0.0, 0.76, 0.0}), 0.7},
          {"aslant", test::point_light({2.5, 2.2, 0.7}), 1.5},
          {"far", test::point_light({300.0, 1000.0, -200.0}), 1.5},
          {"very far", test::point_light({2e5, 1e6, 1e5}), 1.5},
          {"straight down", test::sun({0, -1, 0}), 1.5},
          {"sun aslant", test::sun({0.4, -1, -0.2}), 1.5},
          {"low sun", test::sun({1, -0.05, 0.1}), 0.1}};
}

TEST(ShadowBlocks, VerdictsOnTheLinesAreThoseOfBruteForce) {
  std::uint64_t seed = 61;
  for (const Setting& setting : settings())
    for (const int triangles : {60, 500, 3000}) {
      int tries = 1;
      while (!check(setting, triangles, ++seed) && tries < 20) ++tries;
      EXPECT_LT(tries, 20) << setting.name << ' ' << triangles;
    }
}

}  // namespace
}  // namespace gnomon
