// The wide tree as something that is made: what it reserves, when it is made after all, and what its queries count.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include "raytrace/bvh/wide_tree.h"
#include "raytrace/tracer.h"
#include "scene/base/parallel.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using namespace raytrace;  // NOLINT(google-build-using-namespace): every second word here is from that room
using test::TestWorld;

TEST(Wide, ReservesFewTimesWhatItNeeds) {
  const TestWorld w(test::scene_of({test::uv_sphere(Vec3(0.0), 1.0, 64, 96, 0.05, 19)}));
  const Bvh bvh = build_bvh(w.world());
  const auto tree = collapse_bvh(bvh, w.world());
  ASSERT_NE(tree, nullptr);
  EXPECT_LE(2 * tree->nodes.capacity(), bvh.primitives.size());
  EXPECT_LE(2 * tree->leaves.capacity(), bvh.primitives.size());
}

TEST(Wide, IsMadeLaterWhereItWasGivenUp) {
  const TestWorld w(test::scene_of({test::uv_sphere(Vec3(0.0), 1.0, 64, 96, 0.05, 19)}));
  const Bvh bvh = build_bvh(w.world());
  WideOnDemand wide;
  tbb::task_group_context work;
  tbb::parallel_for(
      0, 1,
      [&](int) {
        work.cancel_group_execution();
        EXPECT_THROW(wide.collapse(bvh, w.world()), GivenUp);
      },
      work);
  EXPECT_EQ(wide.bytes(), 0u);
  wide.collapse(bvh, w.world());
  EXPECT_GT(wide.bytes(), 0u);
}

/// At 1e7 the textbook's floats hit triangles outside their boxes, and either tree finds others of these hits.
TEST(Wide, TextbooksTestIsTheSameWhateverRaysCameBefore) {
  const Vec3 place(1e7, -3e6, 2e7);
  Mesh mesh = test::triangle_soup(2000, 20.0, 6.0, 27);
  for (Vec3& p : mesh.positions) p += place;
  const TestWorld w(test::scene_of({mesh}));
  const Tracer tracer(w.world(), Accel::bvh, Precision::fast);
  test::Random random(28);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 from = place + random.in_box(60.0);
    rays.push_back({from, w.world().position(random.below(w.world().vertex_count())) - from});
  }
  const auto hits = [&] {
    std::vector<std::optional<Hit>> found;
    for (const Ray& ray : rays) found.push_back(tracer.closest_hit(ray));
    return found;
  };
  const auto first = hits(), second = hits();
  std::size_t differ = 0, met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    differ += test::same(first[i], second[i]) ? 0 : 1, met += first[i] ? 1 : 0;
  EXPECT_EQ(differ, 0u);
  EXPECT_GT(met, 5000u);
}

TEST(Wide, PlanesAreCountedAsInAnyOtherStructure) {
  const TestWorld w(test::scene_of({test::quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0})},
                                   {test::plane({0, -3, 0}, {0, 1, 0}), test::plane({0, -4, 0}, {0, 1, 0})}));
  const Ray past{{5, 1, 5}, {0, 1, 0}};  // away from the planes, and beside the triangles
  for (const Accel accel : {Accel::bvh, Accel::kdtree, Accel::grid}) {
    const Tracer tracer(w.world(), accel);
    prepare_single_rays(tracer);
    WorkCounts closest, any, wide_closest, wide_any;
    EXPECT_FALSE(tracer.closest_hit(past, closest) || tracer.occluded(past, any));
    EXPECT_FALSE(counted_closest_hit(tracer, past, wide_closest) || counted_occluded(tracer, past, wide_any));
    for (const WorkCounts& work : {closest, any, wide_closest, wide_any}) EXPECT_EQ(work.primitives, 2u);
  }
}

}  // namespace
}  // namespace gnomon
