// Which surface a texel stores, found by a ray at the stored depth: on drawn maps against brute force, and on stored
// numbers that were put there.
#include <algorithm>

#include "compare/truth/columns.h"
#include "compare/truth/stored_surface.h"
#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

using compare::stored_surface;
using compare::StoredSurface;
using raster::Cull;
using raster::Technique;
using raytrace::TexelKey;
using raytrace::Tracer;

/// All triangles on a ray, nearest first.
std::vector<ReferenceHit> all_hits(const World& world, const Ray& ray) {
  std::vector<ReferenceHit> hits;
  for (std::uint32_t i = 0; i < world.triangle_count(); ++i)
    if (const double t = hit_triangle(ray, world.corners(i)); t >= ray.t.min && t < infinity)
      hits.push_back({t, i});
  std::sort(hits.begin(), hits.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  return hits;
}

bool is_left(const World& world, const Ray& ray, const ReferenceHit& hit, Cull cull) {
  const auto [a, b, c] = world.corners(hit.primitive);
  const bool clockwise = glm::dot(glm::cross(b - a, c - a), ray.direction) > 0.0;
  const bool shows_front = clockwise == world.part_of(hit.primitive).is_inside_out();
  return cull == Cull::none || shows_front == (cull == Cull::back);
}

/// Away from edges: the ray through the texel's centre where all of the texel meets the same triangles.
std::optional<std::vector<ReferenceHit>> hits_of_texel(const World& world, const LightView& view,
                                                       TexelKey key) {
  const auto at = [&](double u, double v) {
    return all_hits(world, texel_ray(view, key.face(), key.column() + u, key.row() + v));
  };
  auto hits = at(0.5, 0.5);
  for (const Vec2 corner : {Vec2(0.25, 0.25), Vec2(0.75, 0.25), Vec2(0.25, 0.75), Vec2(0.75, 0.75)})
    if (at(corner.x, corner.y) != hits) return std::nullopt;
  return hits;
}

Scene boxes(const Light& light) {
  Scene scene = still_life();
  scene.shapes.clear();
  scene.instances.push_back({"above", 0, placed(Vec3(-0.5, 1.9, 0.0), 0.7), 1});
  scene.instances.push_back({"beside", 0, placed(Vec3(0.9, 0.4, 0.3), 0.8), 1});
  scene.instances.back().world_from_object[0] *= -1.0;  // mirrored
  scene.lights = {light};
  return scene;
}

class StoredSurfaces : public testing::TestWithParam<Cull> {};

TEST_P(StoredSurfaces, AreTheFirstThatCullingLeaves) {
  for (const Light& light :
       {sun({-0.5, -1.0, -0.6}), lamp(LightType::spot, {0.2, 4.2, 1.2}, {0.0, 0.0, 0.0})}) {
    raster::RasterOptions options = small_options(96);
    options.map.cull = GetParam();
    const Drawn drawn = draw(boxes(light), options);
    const Tracer tracer(*drawn.world, raytrace::Accel::bvh);
    const LightView& view = drawn.light().map.view;
    int stored = 0, later = 0, empty = 0;
    for (int row = 0; row < view.size; ++row) {
      for (int column = 0; column < view.size; ++column) {
        const TexelKey key = TexelKey::pack(0, column, row);
        const auto hits = hits_of_texel(*drawn.world, view, key);
        if (!hits) continue;
        const Ray ray = texel_ray(view, 0, column + 0.5, row + 0.5);
        const auto wanted = std::find_if(hits->begin(), hits->end(), [&](const ReferenceHit& hit) {
          return is_left(*drawn.world, ray, hit, GetParam());
        });
        const StoredSurface found = stored_surface(tracer, drawn.light(), drawn.frame.options.map, key);
        if (wanted == hits->end()) {
          ASSERT_EQ(found.primitive, no_id) << column << ", " << row;
          ++empty;
          continue;
        }
        ASSERT_EQ(found.primitive, wanted->primitive) << column << ", " << row;
        ASSERT_NEAR(found.depth, depth_of(view, 0, ray, wanted->t), 1e-9);
        const Vec3 place = compare::caster_ray(*drawn.world, view, 0, column + 0.5, row + 0.5).at(found.t);
        ASSERT_LT(glm::distance(place, ray.at(wanted->t)), 1e-9);
        ++stored, later += wanted != hits->begin() ? 1 : 0;
      }
    }
    EXPECT_GT(stored, 100);
    EXPECT_GT(empty, 100);
    EXPECT_EQ(later > 100, GetParam() == Cull::front);
  }
}

INSTANTIATE_TEST_SUITE_P(Culling, StoredSurfaces, testing::Values(Cull::none, Cull::back, Cull::front));

/// Two squares, one under the other, and the texel in the middle of their map.
class TwoSquares : public testing::Test {
 protected:
  void make(double apart) {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes = {square_mesh(1.0)};
    scene.instances.push_back({"upper", 0, placed(Vec3(0.0, 1.0, 0.0), 1.0), 0});
    scene.instances.push_back({"lower", 0, placed(Vec3(0.0, 1.0 - apart, 0.0), 1.0), 0});
    scene.instances.push_back({"ground", 0, placed(Vec3(0.0), 2.0), 0});
    scene.camera.eye = Vec3(1.5, 2.5, 5.0);
    scene.lights = {sun({0.1, -1.0, 0.05})};
    drawn_ = draw(scene, small_options(64));
    record_ = drawn_.light();
    tracer_.emplace(*drawn_.world, raytrace::Accel::bvh);
    hits_ = all_hits(*drawn_.world, texel_ray(record_.map.view, 0, 32.5, 32.5));
    ASSERT_EQ(hits_.size(), 3u);
  }
  double depth(std::size_t hit) const {
    return depth_of(record_.map.view, 0, texel_ray(record_.map.view, 0, 32.5, 32.5), hits_[hit].t);
  }
  void store(double depth) { put(stored_from_depth(record_.map.view, 0, 32.5, depth)); }
  void put(double number) {
    record_.map.depth[record_.map.texel_index(0, 32, 32)] = static_cast<float>(number);
  }
  StoredSurface found(Technique technique = Technique::hard) const {
    raster::MapOptions map = drawn_.frame.options.map;
    map.technique = technique;
    return stored_surface(*tracer_, record_, map, TexelKey::pack(0, 32, 32));
  }
  std::uint32_t id(std::size_t hit) const { return hits_[hit].primitive; }

  Drawn drawn_;
  raster::LightRecord record_;
  std::optional<Tracer> tracer_;
  std::vector<ReferenceHit> hits_;
};

TEST_F(TwoSquares, TheNearestToTheStoredDepthIsStored) {
  make(0.5);
  store(depth(1));
  EXPECT_EQ(found().primitive, id(1));
  EXPECT_NEAR(found().depth, depth(1), 1e-12);
  store(0.6 * depth(0) + 0.4 * depth(1));
  EXPECT_EQ(found().primitive, id(0));
  store(0.4 * depth(0) + 0.6 * depth(1));
  EXPECT_EQ(found().primitive, id(1));
  EXPECT_EQ(found(Technique::midpoint).primitive, id(0));
  put(1.0);
  EXPECT_EQ(found().primitive, no_id);
}

// Where a step of the stored numbers is as wide as the squares are apart, the map stored the first of them.
TEST_F(TwoSquares, WithinRoundingTheFirstIsStored) {
  make(1e-5);
  store(depth(1));
  EXPECT_EQ(found().primitive, id(1));
  record_.rounding.stored_step = 0x1p-16;
  EXPECT_EQ(found().primitive, id(0));
  make(1e-7);
  store(depth(1));
  EXPECT_EQ(found().primitive, id(0));  // positions are rounded, too
}

}  // namespace
}  // namespace gnomon::test
