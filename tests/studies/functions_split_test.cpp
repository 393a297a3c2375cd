// What the homework's bvh_split asks for is what the program's own tree does at its root (raytrace/accel/median_bvh.h), and what the
// lesson on structures writes down.
#include <gtest/gtest.h>

#include "functions/functions.h"
#include "raytrace/accel/median_bvh.h"
#include "scene/world.h"

namespace gnomon::functions {
namespace {

/// A mesh of the question's triangles.
Scene scene_of(Numbers n) {
  Scene scene;
  scene.materials.emplace_back();
  Mesh mesh;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(n[0]); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = 1 + 9 * i + 3 * k;
      mesh.positions.emplace_back(n[at], n[at + 1], n[at + 2]);
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  scene.meshes.push_back(std::move(mesh));
  scene.instances.emplace_back();
  scene.instances.back().mesh = 0;
  return scene;
}

TEST(BvhSplit, IsThatOfTheProgramsOwnTree) {
  const Function* split = find_function("bvh_split");
  ASSERT_NE(split, nullptr);
  int compared = 0;
  for (const Question& question : questions_of(*split)) {
    // A leaf of the program has up to five; and not what rounding to its own numbers may decide.
    if (question.numbers[0] < 6.0f || question.group == picture_group || question.group == "far") continue;
    const Scene scene = scene_of(question.numbers);
    const World world = make_world(scene);
    const raytrace::CellItems items(world);
    const raytrace::MedianBvh tree = raytrace::build_median_bvh(items);
    ASSERT_EQ(tree.nodes.size(), 3u);
    int left = 0;
    for (std::uint32_t i = 0; i < tree.nodes[1].count; ++i) left |= 1 << tree.items[tree.nodes[1].first + i];
    EXPECT_EQ(left, static_cast<int>(question.right.value[0]))
        << question.group << ": " << split->words(question.numbers);
    ++compared;
  }
  EXPECT_GE(compared, 60);
}

}  // namespace
}  // namespace gnomon::functions
