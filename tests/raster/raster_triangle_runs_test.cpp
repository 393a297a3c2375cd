// Which triangles are drawn by which calls: blocks that may be seen, joined where they follow each other and share all
// state.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "raster/world/triangle_runs.h"

namespace gnomon::test {
namespace {

constexpr std::uint32_t blocks = 5, count = blocks * TriangleBlock::most;

/// A row of triangles along x, block b from b to b + 1.
Mesh row() {
  Mesh mesh;
  const double step = 1.0 / TriangleBlock::most;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec2 p : {Vec2(0.1, 0.0), Vec2(0.9, 0.0), Vec2(0.5, 1.0)})
      mesh.positions.emplace_back(step * (i + p.x), p.y, 0.0);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

struct Rows {
  Scene scene;
  World world;
  raster::StoredMeshes meshes;
  raster::TriangleRuns runs;
  explicit Rows(Scene given, const raster::SceneFeatures& features = {})
      : scene(std::move(given)), world(make_world(scene)), meshes(world), runs(world, meshes, features) {}

  /// From x = `from` to `to`.
  std::vector<raster::TriangleRun> shown(double from, double to) const {
    return runs.within(raster::ClipSides(glm::ortho(from, to, -2.0, 2.0), Vec3(0.0)), false);
  }
};

Scene two_rows() {
  Scene scene;
  scene.materials.resize(2);
  scene.meshes = {row()};
  scene.instances.push_back({"near", 0, Mat4(1.0), 0});
  scene.instances.push_back({"far", 0, glm::translate(Mat4(1.0), Vec3(100.0, 0.0, 0.0)), 0});
  return scene;
}

void expect_run(const raster::TriangleRun& run, std::uint32_t first, std::uint32_t end) {
  EXPECT_EQ(run.first, first);
  EXPECT_EQ(run.count, end - first);
}

TEST(TriangleRuns, AreOneWhereAllIsShown) {
  const Rows rows(two_rows());
  const auto all = rows.shown(-1.0, 200.0);
  ASSERT_EQ(all.size(), 1u);
  expect_run(all[0], 0, 2 * count);
}

TEST(TriangleRuns, LeaveOutBlocksBesideTheView) {
  const Rows rows(two_rows());
  const auto some = rows.shown(1.5, 3.5);
  ASSERT_EQ(some.size(), 1u);
  expect_run(some[0], TriangleBlock::most, 4 * TriangleBlock::most);
  const auto ends = rows.shown(4.5, 100.5);
  ASSERT_EQ(ends.size(), 1u);  // the last of one part and the first of the next follow each other
  expect_run(ends[0], 4 * TriangleBlock::most, 6 * TriangleBlock::most);
  EXPECT_TRUE(rows.shown(10.0, 20.0).empty());
}

TEST(TriangleRuns, EndWhereTheStateChanges) {
  Scene scene = two_rows();
  scene.materials[1].alpha_mode = AlphaMode::mask;
  auto& of_triangles = scene.meshes[0].triangle_materials;
  of_triangles.assign(count, 0);
  std::fill(of_triangles.begin() + 100, of_triangles.begin() + 2000, 1u);
  raster::SceneFeatures features;
  features.alpha_mask = true;
  const Rows rows(std::move(scene), features);
  const auto seen = rows.shown(-1.0, 10.0);
  ASSERT_EQ(seen.size(), 3u);
  expect_run(seen[0], 0, 100);
  expect_run(seen[1], 100, 2000);
  expect_run(seen[2], 2000, count);
  EXPECT_FALSE(seen[0].masked);
  EXPECT_TRUE(seen[1].masked);
  EXPECT_EQ(Rows(two_rows(), features).shown(-1.0, 10.0).size(), 1u);
}

}  // namespace
}  // namespace gnomon::test
