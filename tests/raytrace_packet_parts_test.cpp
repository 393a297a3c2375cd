// What packets of floats are made of: the cells' lists and their order, the treelets, pages of memory; for
// every instruction set that this machine has.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "every_target.h"
#include "raytrace/bvh/bvh.h"
#include "raytrace/packets/bin_cover.h"
#include "raytrace/packets/passes.h"
#include "raytrace/tiles.h"
#include "raytrace_support.h"

namespace gnomon {
namespace {

using raytrace::Accel;
using raytrace::Tracer;
using test::for_each_target;
using test::TestWorld;

TEST(LightBins, RanksAreAStableSorts) {
  test::Random random(6);
  for (const std::size_t count : {1, 2, 15, 16, 17, 40, 333}) {
    std::vector<float> numbers(count + raytrace::packet_rays);
    for (float& n : numbers) n = random.below(3) == 0 ? 0.25f : static_cast<float>(random.uniform(-1.0, 1.0));
    numbers[count / 2] = std::numeric_limits<float>::infinity();
    std::vector<std::uint32_t> order(count);
    for (std::uint32_t i = 0; i < count; ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return numbers[a] > numbers[b]; });
    for_each_target([&] {
      std::vector<std::uint32_t> rank(numbers.size());
      raytrace::rank_falling(numbers.data(), count, rank.data());
      for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(rank[order[i]], i) << count;
    });
  }
}

// Lists of all lengths: nearest first, of equals the first leaf; those of one thread are those of three.
TEST(LightBins, ListsAreInOrderOnAnyNumberOfThreads) {
  Mesh mesh = test::triangle_soup(30000, 0.05, 0.03, 7);
  const Mesh wide = test::triangle_soup(4000, 1.0, 0.1, 8);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), wide.positions.begin(), wide.positions.end());
  for (const auto& t : wide.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  mesh.triangles.insert(mesh.triangles.end(), 50, mesh.triangles.front());  // equals
  Scene scene = test::scene_of({mesh});
  scene.camera = {{0.3, 0.4, 3.0}, {0, 0, 0}, {0.1, 1, 0.05}, 0.8};
  const TestWorld w(scene);
  const Tracer tracer(w.world(), Accel::bvh);
  const View view = make_view(scene.camera, {160, 120});
  raytrace::HugeArray<raytrace::QuantisedTile> tiles(raytrace::TileGrid{view.size}.count());
  primary_pass(tracer, view, edge_setup_of_eye(tracer, view),
               {.hits = {}, .receivers = nullptr, .quantised = {tiles.data(), tiles.size()}});
  const Light light = test::point_light(scene.camera.eye);
  const auto cells_on = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return sight_of_light(tracer, light, {tiles.data(), tiles.size()}); });
  };
  const raytrace::Sight one = cells_on(1), three = cells_on(3);
  ASSERT_TRUE(one.by_bins && three.by_bins);
  const raytrace::LightBins &a = one.bins, &b = three.bins;
  ASSERT_EQ(a.first, b.first);
  std::size_t longest = 0;
  for (std::size_t cell = 0; cell + 1 < a.first.size(); ++cell) {
    longest = std::max<std::size_t>(longest, a.first[cell + 1] - a.first[cell]);
    for (std::uint32_t i = a.first[cell]; i < a.first[cell + 1]; ++i) {
      ASSERT_EQ(a.nearest[i], b.nearest[i]);
      ASSERT_EQ(a.leaf[i], b.leaf[i]);
      ASSERT_EQ(a.box[i], b.box[i]);
      if (i == a.first[cell]) continue;
      ASSERT_GE(a.nearest[i - 1], a.nearest[i]);
      ASSERT_TRUE(a.nearest[i - 1] > a.nearest[i] || a.leaf[i - 1] < a.leaf[i]);
    }
  }
  EXPECT_GT(longest, 500U);
}

TEST(Treelets, TheTreeIsThatOfEveryInstructionSet) {
  Mesh mesh = test::triangle_soup(20000, 1.0, 0.03, 9);
  mesh.triangles.insert(mesh.triangles.end(), 50, mesh.triangles.front());  // equals
  const TestWorld w(test::scene_of({mesh}));
  const auto build = [&] {
    tbb::task_arena arena(1);  // on several threads the nodes' numbers may differ
    return arena.execute([&] { return raytrace::build_bvh(w.world()); });
  };
  const raytrace::Bvh first = build();
  for_each_target([&] {
    const raytrace::Bvh tree = build();
    ASSERT_EQ(tree.ids, first.ids) << raytrace::packet_target();
    ASSERT_EQ(tree.nodes.size(), first.nodes.size());
    EXPECT_EQ(
        std::memcmp(tree.nodes.data(), first.nodes.data(), tree.nodes.size() * sizeof(raytrace::BvhNode)), 0)
        << raytrace::packet_target();
  });
}

TEST(HugeArrays, PagesAreUsedAgain) {
  constexpr std::size_t count = std::size_t{3} << 20;
  const double* before = nullptr;
  {
    raytrace::HugeArray<double> array(count);
    array[0] = array[count - 1] = 1.0;
    before = array.data();
  }
  const raytrace::HugeArray<double> again(count - 1000), other(count);
  EXPECT_EQ(again.data(), before);
  EXPECT_NE(other.data(), before);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(other.data()) % 64, 0U);
}

}  // namespace
}  // namespace gnomon
