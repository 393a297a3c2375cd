// What packets of floats are made of: the order of a batch, the treelets, pages of memory; for every instruction set
// that this machine has.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "raytrace/bvh/bvh.h"
#include "raytrace/packets/packet_grid.h"
#include "raytrace/packets/passes.h"
#include "tests/support/every_target.h"
#include "tests/support/places.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using test::for_each_target;
using test::TestWorld;

TEST(PacketGrid, RanksAreAStableSorts) {
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
  if (test::address_sanitizer) GTEST_SKIP() << "the sanitizer keeps freed memory back";
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
