// The hierarchy's builder: every primitive is in one leaf and within all boxes above it, the tree does not
// depend on the number of threads, and rays see what they see without a tree.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstring>
#include <limits>

#include "raytrace/bvh/bvh.h"
#include "raytrace/bvh/wide_tree.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using raytrace::Accel;
using raytrace::Bvh;
using raytrace::BvhChild;
using raytrace::BvhNode;
using raytrace::Tracer;
using test::Random;
using test::TestWorld;

/// The tree without the numbers of its nodes: boxes and leaves from the root on.
struct Form {
  std::vector<float> bounds;
  std::vector<std::uint32_t> leaves, ids;
  int depth = 0;
  bool operator==(const Form&) const = default;
};

void append(const Bvh& bvh, std::uint32_t index, int depth, Form& form) {
  const BvhNode& node = bvh.nodes[index];
  form.depth = std::max(form.depth, depth);
  for (std::size_t i = 0; i < 4; ++i) {
    const BvhChild child = node.child[i];
    for (const auto& row : node.bounds) form.bounds.push_back(row[i]);
    form.leaves.push_back(child.is_leaf() ? child.bits : 0);
    if (!child.is_leaf()) append(bvh, child.index(), depth + 1, form);
  }
}

Form form_of(const Bvh& bvh) {
  Form form;
  if (!bvh.nodes.empty()) append(bvh, 0, 1, form);
  form.ids.assign(bvh.ids.begin(), bvh.ids.end());
  return form;
}

/// Counts the leaves' primitives and holds each against the boxes above it.
struct Check {
  const Bvh& bvh;
  const std::vector<raytrace::BoxRef>& box_of_id;
  std::vector<int> seen;
  std::size_t outside = 0, largest_leaf = 0;

  void walk(std::uint32_t index, const raytrace::BoxRef& within) {
    const BvhNode& node = bvh.nodes[index];
    for (std::size_t i = 0; i < 4; ++i) {
      raytrace::BoxRef box = within;
      for (std::size_t a = 0; a < 3; ++a) {
        box.min[a] = std::max(box.min[a], node.bounds[a][i]);
        box.max[a] = std::min(box.max[a], node.bounds[3 + a][i]);
      }
      const BvhChild child = node.child[i];
      if (!child.is_leaf()) {
        walk(child.index(), box);
        continue;
      }
      largest_leaf = std::max<std::size_t>(largest_leaf, child.count());
      for (std::uint32_t k = 0; k < child.count(); ++k) leaf(bvh.ids[child.first() + k], box);
    }
  }
  void leaf(std::uint32_t id, const raytrace::BoxRef& box) {
    ++seen[id];
    for (std::size_t a = 0; a < 3; ++a)
      outside += box_of_id[id].min[a] < box.min[a] || box_of_id[id].max[a] > box.max[a] ? 1 : 0;
  }
};

void expect_sound(const World& world, const Bvh& bvh) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  const raytrace::FinitePrimitives finite = raytrace::finite_primitives(world);
  ASSERT_EQ(bvh.ids.size(), finite.boxes.size());
  ASSERT_EQ(bvh.primitives.size(), finite.boxes.size());
  if (finite.boxes.empty()) return;
  std::vector<raytrace::BoxRef> box_of_id(world.primitive_count());
  std::vector<int> expected(world.primitive_count());
  for (const raytrace::BoxRef& box : finite.boxes) box_of_id[box.id] = box, expected[box.id] = 1;
  Check check{bvh, box_of_id, std::vector<int>(world.primitive_count())};
  check.walk(0, {{-inf, -inf, -inf}, {inf, inf, inf}, 0});
  EXPECT_EQ(check.seen, expected);
  EXPECT_EQ(check.outside, 0U);
  EXPECT_LE(check.largest_leaf, BvhChild::max_leaf);
  EXPECT_LE(form_of(bvh).depth, Bvh::max_depth);
}

Bvh build_on(int threads, const World& world) {
  tbb::task_arena arena(threads);
  return arena.execute([&] { return raytrace::build_bvh(world); });
}

void expect_same_hits(const World& world, int rays, double half, std::uint64_t seed) {
  const Tracer bvh(world, Accel::bvh), brute(world, Accel::brute);
  Random random(seed);
  for (int i = 0; i < rays; ++i) {
    // Every other one towards a primitive, so that many hit.
    Ray ray{random.in_box(half), random.direction()};
    if (i % 2 == 0) {
      const auto [a, b, c] = world.corners(random.below(world.triangle_count()));
      ray.direction = (a + b + c) / 3.0 - ray.origin;
    }
    const auto x = bvh.closest_hit(ray), y = brute.closest_hit(ray);
    ASSERT_EQ(x.has_value(), y.has_value()) << i;
    if (!x) continue;
    ASSERT_EQ(x->primitive, y->primitive) << i;
    ASSERT_EQ(x->t, y->t) << i;
  }
}

void expect_built_well(Scene scene, int rays, double half) {
  const TestWorld w(std::move(scene));
  const Bvh one = build_on(1, w.world());
  expect_sound(w.world(), one);
  const Form form = form_of(one);
  EXPECT_EQ(form, form_of(build_on(2, w.world())));
  EXPECT_EQ(form, form_of(build_on(3, w.world())));
  expect_same_hits(w.world(), rays, half, 5);
}

Mesh all_of(const std::vector<Mesh>& meshes) {
  Mesh sum;
  for (const Mesh& mesh : meshes) {
    const auto first = static_cast<std::uint32_t>(sum.positions.size());
    sum.positions.insert(sum.positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const auto& t : mesh.triangles) sum.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return sum;
}

Mesh scaled(Mesh mesh, double factor, const Vec3& offset) {
  for (Vec3& p : mesh.positions) p = factor * p + offset;
  return mesh;
}

TEST(Builder, SoupsOfAllSizes) {
  for (const int count : {1, 2, 3, 4, 5, 7, 15, 16, 17, 40, 255, 257, 1000, 5000})
    expect_built_well(test::scene_of({test::triangle_soup(count, 1.0, 0.3, 21)}), 100, 2.0);
}

TEST(Builder, ManySharesOfTheGrid) {
  expect_built_well(test::scene_of({test::triangle_soup(60000, 1.0, 0.02, 22)}), 40, 1.5);
}

TEST(Builder, CoincidentTriangles) {
  for (const std::size_t count : {std::size_t{3}, std::size_t{16}, std::size_t{40}, std::size_t{3000}}) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles.assign(count, {0, 1, 2});
    expect_built_well(test::scene_of({mesh}), 20, 1.0);
    // Beside others: their cell is the only one that holds many.
    expect_built_well(test::scene_of({all_of({mesh, test::triangle_soup(2000, 3.0, 0.2, 23)})}), 60, 3.0);
  }
}

TEST(Builder, EqualCentroidsOfDifferentSizes) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const double size = 1.0 + i;
    mesh.positions.insert(mesh.positions.end(),
                          {{-size, -size, 0}, {size, -size, 0}, {0, size, 0.5 * (i % 7)}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  expect_built_well(test::scene_of({mesh}), 100, 100.0);
}

TEST(Builder, SmallAndLargeTogether) {
  // A dense model in a vast surrounding, and a few triangles that reach across everything.
  const Mesh model = test::uv_sphere({0, 0, 0}, 1.0, 60, 60, 0.01, 24);
  const Mesh far = scaled(test::triangle_soup(3000, 1.0, 0.1, 25), 1e6, Vec3(0.0));
  const Mesh across = test::triangle_soup(20, 1e6, 1e6, 26);
  expect_built_well(test::scene_of({all_of({model, far, across})}), 100, 3.0);
}

TEST(Builder, EachTwiceAsLargeAndAsFar) {
  Mesh mesh;  // in every power of two more of them than a treelet holds, over and over
  double size = 1e-12;
  for (int step = 0; step < 40; ++step, size *= 4.0) {
    Mesh some = scaled(test::triangle_soup(300, 1.0, 0.2, 27), 0.1 * size, Vec3(size, 0.0, 0.0));
    mesh = all_of({std::move(mesh), std::move(some)});
  }
  expect_built_well(test::scene_of({mesh}), 100, 10.0);
}

TEST(Builder, HugeExtents) {
  Mesh mesh = scaled(test::triangle_soup(700, 1.0, 0.5, 28), 1e37, Vec3(0.0));
  expect_built_well(test::scene_of({mesh}), 100, 2e37);
  mesh = scaled(test::triangle_soup(700, 1.0, 0.5, 28), 1e60, Vec3(0.0));  // beyond floats
  const TestWorld w(test::scene_of({mesh}));
  expect_sound(w.world(), raytrace::build_bvh(w.world()));
}

TEST(Builder, BrokenTrianglesAreDropped) {
  Mesh mesh = test::triangle_soup(20000, 1.0, 0.05, 29);
  std::uint64_t broken = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 7, ++broken) {
    const auto& t = mesh.triangles[i];
    if (i % 3 == 0)
      mesh.positions[t[0]].y = std::numeric_limits<double>::quiet_NaN();
    else if (i % 3 == 1)
      mesh.positions[t[1]].x = infinity;
    else
      mesh.positions[t[2]] = mesh.positions[t[1]];
  }
  const TestWorld w(test::scene_of({mesh}));
  EXPECT_EQ(raytrace::build_bvh(w.world()).dropped, broken);
  expect_built_well(test::scene_of({std::move(mesh)}), 0, 1.0);
}

// An error in another thread skips the loops of this one: what they did not make is not gone on with.
TEST(Builder, LeavesWorkThatWasGivenUp) {
  const TestWorld w(test::scene_of({test::triangle_soup(60000, 1.0, 0.05, 32)}));
  const Bvh whole = raytrace::build_bvh(w.world());
  for (const bool wide : {false, true}) {
    bool went_on = false;
    tbb::task_group_context work;
    tbb::parallel_for(
        0, 1,
        [&](int) {
          work.cancel_group_execution();
          if (wide)
            raytrace::collapse_bvh(whole, w.world(), false);
          else
            raytrace::build_bvh(w.world());
          went_on = true;
        },
        work);
    EXPECT_FALSE(went_on) << (wide ? "wide tree" : "hierarchy");
  }
}

TEST(Builder, ShapesAmongTriangles) {
  std::vector<Shape> shapes;
  Random random(30);
  for (int i = 0; i < 600; ++i) shapes.push_back(test::some_sphere(random, 1.0, {0.001, 0.3}));
  expect_built_well(test::scene_of({test::triangle_soup(900, 1.0, 0.2, 31)}, std::move(shapes)), 200, 2.0);
}

}  // namespace
}  // namespace gnomon
