// A world that keeps its instances against the same world flattened: the same bits in corners, numbers, topology, hits,
// visibility, frames and columns.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>

#include "raytrace/bvh/instance.h"
#include "raytrace/frame.h"
#include "raytrace/kernels.h"
#include "raytrace/sheets/column_sheets.h"
#include "raytrace/tracer.h"
#include "scene/light_map/light_view.h"
#include "tests/support/placements.h"

namespace gnomon {
namespace {

using namespace raytrace;  // NOLINT(google-build-using-namespace): every second word here is from that room
using test::Random;
using test::same;

struct BothWays {
  Scene scene;
  World kept, flat;
  explicit BothWays(Scene s)
      : scene(std::move(s)),
        kept(make_world(scene, InstanceChoice::keep)),
        flat(make_world(scene, InstanceChoice::flatten)) {}
  std::size_t kept_count() const {
    return static_cast<std::size_t>(
        std::count_if(kept.parts.begin(), kept.parts.end(), [](const WorldPart& p) { return p.kept(); }));
  }
};

Mesh with_normals(Mesh mesh) {
  for (const Vec3& p : mesh.positions) mesh.normals.emplace_back(Vec3f(p)), mesh.uvs.emplace_back(Vec2f(p));
  return mesh;
}

Scene placed_scene(const test::Kind& kind, int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::pair<std::uint32_t, Mat4>> placed;
  for (int i = 0; i < count; ++i)
    placed.emplace_back(i % 2, test::moved_into_box(kind.linear(random), kind.extent, random));
  return test::instances_of({with_normals(test::ball()), test::triangle_soup(30, 0.8, 0.5, 5)}, placed);
}

TEST(Instances, HaveTheBitsOfTheFlattenedWorld) {
  for (const test::Kind& kind : test::kinds) {
    Scene scene = placed_scene(kind, 20, 7);
    scene.materials.emplace_back();
    scene.meshes[1].triangle_materials.assign(scene.meshes[1].triangles.size(), 1);
    const BothWays w(std::move(scene));
    EXPECT_EQ(w.kept_count(), 20u) << kind.name;
    EXPECT_FALSE(w.flat.keeps_instances());
    ASSERT_EQ(w.kept.triangle_count(), w.flat.triangle_count());
    ASSERT_EQ(w.kept.vertex_count(), w.flat.vertex_count());
    EXPECT_EQ(w.kept.finite_bounds.min, w.flat.finite_bounds.min);
    EXPECT_EQ(w.kept.finite_bounds.max, w.flat.finite_bounds.max);
    for (std::uint32_t t = 0; t < w.flat.triangle_count(); ++t) {
      ASSERT_EQ(w.kept.corners(t), w.flat.corners(t)) << kind.name;
      ASSERT_EQ(w.kept.triangle(t), w.flat.triangle(t));
      ASSERT_EQ(w.kept.object_of(t), w.flat.object_of(t));
      ASSERT_EQ(w.kept.material_of(t), w.flat.material_of(t));
    }
    for (std::uint32_t v = 0; v < w.flat.vertex_count(); ++v) {
      ASSERT_EQ(w.kept.normal(v), w.flat.normal(v));
      ASSERT_EQ(w.kept.uv(v), w.flat.uv(v));
    }
  }
}

/// Corners that lie outside a box on their way down, as the tree's nodes come into the world.
std::uint64_t corners_outside(const Bvh& tree, const BvhInstance& at, const Vec3& center, std::uint32_t index,
                              const World& world) {
  BvhNode node;
  place_node(tree.nodes[index], at, node);
  std::uint64_t outside = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const BvhChild child = node.child[i];
    const LeafRange below =
        child.is_leaf() ? LeafRange{child.first(), child.count()} : tree.below[child.index()];
    for (std::uint32_t k = below.first; k < below.first + below.count; ++k)
      for (const Vec3& corner : world.corners(at.first_triangle + tree.ids[k]))
        for (int a = 0; a < 3; ++a) {
          const double x = corner[a] - center[a];
          const auto row = static_cast<std::size_t>(a);
          outside += static_cast<double>(node.bounds[row][i]) <= x &&
                             x <= static_cast<double>(node.bounds[3 + row][i])
                         ? 0
                         : 1;
        }
    if (!child.is_leaf()) outside += corners_outside(tree, at, center, child.index(), world);
  }
  return outside;
}

TEST(Instances, EveryBoxHoldsItsTrianglesInTheWorld) {
  for (const test::Kind& kind : test::kinds)
    for (const Vec3& away : {Vec3(0.0), Vec3(1e6, -1e7, 3e5)}) {
      Scene scene = placed_scene(kind, 40, 17);
      for (MeshInstance& instance : scene.instances)
        instance.world_from_object = test::moved(away, instance.world_from_object);
      const BothWays w(std::move(scene));
      const Bvh bvh = build_bvh(w.kept);
      ASSERT_EQ(bvh.instances.size(), w.kept_count());
      for (const BvhInstance& at : bvh.instances)
        EXPECT_EQ(corners_outside(bvh.trees[at.tree], at, bvh.center, 0, w.kept), 0u) << kind.name;
    }
}

/// Rays and visibility in a kept world against brute force over the same world flattened. Returns whether single rays had a
/// tree of their own.
bool expect_same_rays(const BothWays& w, const std::vector<Ray>& rays, const test::Kind& kind,
                      const Vec3& middle, Precision precision) {
  const Tracer kept(w.kept, Accel::bvh, precision), flat(w.flat, Accel::brute, precision);
  prepare_single_rays(kept);
  std::atomic<int> wrong = 0;
  tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t i) {
    const auto truth = flat.closest_hit(rays[i]);
    WorkCounts work;
    bool right = same(kept.closest_hit(rays[i]), truth) && same(kept.closest_hit(rays[i], work), truth) &&
                 same(counted_closest_hit(kept, rays[i], work), truth) &&
                 counted_occluded(kept, rays[i], work) == truth.has_value() &&
                 kept.occluded(rays[i]) == truth.has_value();
    if (right && truth) {
      const SurfacePoint point = flat.surface_point(rays[i], *truth);
      right = point.position == kept.surface_point(rays[i], *truth).position;
      LastBlocker last;  // of the light before, then of this one
      for (const Light& light :
           {test::point_light(middle + Vec3(2.0 * kind.extent)), test::sun(Vec3(0.3, -1.0, 0.2))})
        for (LastBlocker* from_before : {static_cast<LastBlocker*>(nullptr), &last, &last})
          right = right &&
                  kept.centre_visibility(point, light, from_before) == flat.centre_visibility(point, light);
    }
    wrong += right ? 0 : 1;
  });
  EXPECT_EQ(wrong, 0) << kind.name << " " << precision_name(precision);
  return single_ray_bytes(kept) > 0;
}

TEST(Instances, RaysFindTheSame) {
  for (const test::Kind& kind : test::kinds)
    for (const double extents : {0.0, 30.0, 3000.0, 3e6}) {
      const Vec3 away = extents * kind.extent * Vec3(0.2, -1.0, 0.1);
      Scene scene = placed_scene(kind, 40, 11);
      scene.meshes.push_back(test::triangle_soup(30, 1.0, 0.5, 6));  // not kept, for it stands once
      scene.instances.push_back({"once", 2, test::scaling(Vec3(kind.extent)), 0});
      for (MeshInstance& instance : scene.instances)
        instance.world_from_object = test::moved(away, instance.world_from_object);
      const BothWays w(std::move(scene));
      const std::vector<Ray> rays = test::aimed_rays(w.flat, 500, kind.extent, away, 12);
      // The textbook's floats find hits outside a triangle's own box, so there the boxes do matter.
      for (const Precision precision : {Precision::robust, Precision::exact})
        EXPECT_TRUE(expect_same_rays(w, rays, kind, away, precision)) << kind.name;
    }
}

/// Each ray from further back, up to 4,000 extents: over the whole way, over what it was, or over the first part of that.
std::vector<Ray> from_afar(std::vector<Ray> rays, double extent) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Ray& ray = rays[i];
    const double one = extent / glm::length(ray.direction);
    const double back = one * std::exp2(static_cast<double>(i % 25) * 0.5);
    ray.origin -= back * ray.direction;
    ray.t.max = i % 3 == 2 ? back + 0.3 * one * static_cast<double>(i % 11) : ray.t.max + back;
    ray.t.min = i % 3 == 0 ? 0.0 : ray.t.min + back;
  }
  return rays;
}

TEST(Instances, RaysFromAfarFindTheSame) {
  for (const test::Kind& kind : test::kinds) {
    const BothWays w(placed_scene(kind, 40, 11));
    const std::vector<Ray> rays =
        from_afar(test::aimed_rays(w.flat, 1500, kind.extent, Vec3(0.0), 12), kind.extent);
    EXPECT_TRUE(expect_same_rays(w, rays, kind, Vec3(0.0), Precision::robust)) << kind.name;
  }
}

TEST(Instances, EveryStructureFindsTheSame) {
  const BothWays w(placed_scene(test::kinds[0], 12, 21));
  const Tracer flat(w.flat, Accel::brute);
  const std::vector<Ray> rays = test::aimed_rays(w.flat, 200, 6.0, Vec3(0.0), 22);
  for (const Accel accel : {Accel::bvh_median, Accel::kdtree, Accel::kdtree_cyclic, Accel::octree,
                            Accel::grid, Accel::grid_textbook, Accel::bsp, Accel::two_level, Accel::brute}) {
    const Tracer kept(w.kept, accel);
    for (const Ray& ray : rays) EXPECT_TRUE(same(kept.closest_hit(ray), flat.closest_hit(ray)));
  }
}

/// Instances, a flattened ground, masks, shapes; a mesh seen through mirrors.
Scene garden(std::uint64_t seed) {
  Random random(seed);
  std::vector<std::pair<std::uint32_t, Mat4>> placed;
  for (int i = 0; i < 30; ++i)
    placed.emplace_back(i % 2,
                        test::moved_into_box(test::kinds[random.below(4)].linear(random), 4.0, random));
  Mesh ground = test::quad(Vec3(-8, -4, -8), Vec3(16, 0, 0), Vec3(0, 0, 16));
  placed.emplace_back(2, Mat4(1.0));
  Scene scene =
      test::instances_of({with_normals(test::ball()), test::triangle_soup(200, 1.5, 0.3, 5), ground}, placed);
  Material holes, mirror;
  holes.alpha_mode = AlphaMode::mask, holes.alpha = 0.2f, mirror.mirror = 0.5f;
  scene.materials.push_back(holes), scene.materials.push_back(mirror);
  scene.instances[4].material = 1, scene.instances[6].material = 2;
  scene.shapes = {test::plane(Vec3(0, -5, 0), Vec3(0, 1, 0)), test::sphere(Vec3(1, 1, 1), 0.7)};
  scene.lights = {test::point_light(Vec3(2.0, 6.0, 1.0)), test::sun(Vec3(0.2, -1.0, 0.1))};
  scene.camera.eye = Vec3(0, 1, 12);
  return scene;
}

TEST(Instances, FramesAreTheSame) {
  for (const bool masks : {false, true}) {
    Scene scene = garden(3);
    if (!masks) scene.instances[4].material = 0;
    const BothWays w(std::move(scene));
    RaytraceOptions options;
    options.size = {160, 96};
    const std::array<std::uint32_t, 2> lights{0, 1};
    const EffectPlan plan = plan_effects(w.scene);
    for (const Precision precision : {Precision::robust, Precision::exact, Precision::fast}) {
      const auto frame = [&](const World& world, bool records) {
        options.records = records;
        return trace_frame(Tracer(world, Accel::bvh, precision), plan, w.scene.camera, lights, options);
      };
      const RayTracedFrame truth = frame(w.flat, true), kept = frame(w.kept, true);
      EXPECT_EQ(kept.color.data, truth.color.data) << precision_name(precision);
      EXPECT_EQ(frame(w.kept, false).color.data, frame(w.flat, false).color.data);
      for (std::size_t i = 0; i < truth.receiver.data.size(); ++i) {
        const SurfacePoint &a = kept.receiver.data[i], &b = truth.receiver.data[i];
        ASSERT_TRUE(a.primitive == b.primitive && a.position == b.position && a.normal == b.normal &&
                    a.position_error == b.position_error && a.barycentric == b.barycentric);
      }
      for (std::size_t l = 0; l < lights.size(); ++l)
        EXPECT_EQ(kept.lights[l].centre.data, truth.lights[l].centre.data) << precision_name(precision);
    }
  }
}

/// A cube of eight corners.
Mesh cube() {
  return test::box(Vec3(0.0), Vec3(1.0));
}

void expect_same_topology(const World& kept, const World& flat) {
  const Topology a(kept), b(flat);
  for (std::uint32_t t = 0; t < flat.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(a.across(t, k), b.across(t, k)) << t;
      ASSERT_EQ(a.welded(t, k), b.welded(t, k)) << t;
    }
}

TEST(Instances, TopologyIsTheSame) {
  for (const test::Kind& kind : test::kinds) {
    const BothWays w(placed_scene(kind, 20, 31));
    expect_same_topology(w.kept, w.flat);
  }
  const BothWays g(garden(5));
  expect_same_topology(g.kept, g.flat);
}

TEST(Instances, ThatTouchAreWeldedToEachOther) {
  std::vector<std::pair<std::uint32_t, Mat4>> placed;
  for (int i = 0; i < 4; ++i) placed.emplace_back(0, test::moved(Vec3(i, 0, 0), Mat4(1.0)));  // side by side
  for (int i = 0; i < 3; ++i) placed.emplace_back(0, test::moved(Vec3(3 * i, 9, 0), Mat4(1.0)));  // apart
  placed.emplace_back(0, test::moved(Vec3(1e17, 0, 0), Mat4(1.0)));  // its own corners come together
  placed.emplace_back(1, Mat4(1.0));  // a corner of the last one that stands apart
  const BothWays w(
      test::instances_of({cube(), test::quad(Vec3(7, 10, 1), Vec3(1, 0, 0), Vec3(0, 1, 0))}, placed));
  EXPECT_GE(w.kept_count(), 7u);
  expect_same_topology(w.kept, w.flat);
  const Topology topology(w.kept);
  const std::uint32_t cubes = cube().triangles.size();
  std::uint32_t other = 0;
  for (std::uint32_t t = 0; t < cubes; ++t)
    for (int k = 0; k < 3; ++k) other += topology.across(t, k) == Topology::non_manifold ? 1 : 0;
  EXPECT_GT(other, 0u);  // the edges that two cubes share
}

/// Along each axis a row of cubes, every second one of which touches the next, and a long box beside it that touches the
/// first and the last; and one that touches nothing but what is flattened, for it has no length.
TEST(Instances, ThatTouchAreFoundAlongEachAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 along(0.0), aside(0.0), length(1.0), flat(1.0);
    along[axis] = 1.0, aside[(axis + 1) % 3] = 1.0, length[axis] = 149.0, flat[axis] = 0.0;
    std::vector<std::pair<std::uint32_t, Mat4>> placed{
        {0, test::moved(aside + 0.5 * along, test::scaling(length))}};
    for (int i = 0; i < 100; ++i)
      placed.emplace_back(0, test::moved((1.5 * i + 0.5 * (i % 2 == 0)) * along, Mat4(1.0)));
    for (const Vec3& scale : {Vec3(1.0), flat})
      placed.emplace_back(0, test::moved(-3.0 * along, test::scaling(scale)));
    const BothWays w(test::instances_of({cube()}, placed));
    EXPECT_EQ(w.kept_count(), placed.size() - 1);
    expect_same_topology(w.kept, w.flat);
    const Topology topology(w.kept);
    std::uint32_t joined = 0;
    for (std::uint32_t t = 0; t < w.kept.triangle_count(); ++t)
      for (int k = 0; k < 3; ++k) joined += topology.welded(t, k) < w.kept.part_of(t).first_vertex ? 1 : 0;
    EXPECT_GT(joined, 50u);
  }
}

TEST(Instances, SheetsAreTheSame) {
  const BothWays w(garden(9));
  const LightView view = fit_light_view(w.flat, w.scene.lights[0], w.scene.camera, 1.0, 64).value();
  const Topology kept(w.kept), flat(w.flat);
  const Tracer tracer(w.flat, Accel::bvh);
  int joined = 0, apart = 0;
  for (int face = 0; face < view.face_count; ++face)
    for (int i = 0; i < 64 * 64; ++i) {
      const int x = i % 64, y = i / 64;
      const TexelKey key = TexelKey::pack(face, x, y);
      ColumnSheets of_kept(w.kept, kept, view, key), of_flat(w.flat, flat, view, key);
      const auto a = tracer.closest_hit(texel_ray(view, face, x + 0.2, y + 0.3));
      const auto b = tracer.closest_hit(texel_ray(view, face, x + 0.8, y + 0.7));
      if (!a || !b || !w.flat.is_triangle(a->primitive) || !w.flat.is_triangle(b->primitive)) continue;
      const bool same = of_flat.same(a->primitive, b->primitive);
      ASSERT_EQ(of_kept.same(a->primitive, b->primitive), same) << face << ": " << x << ", " << y;
      (same ? joined : apart) += 1;
    }
  EXPECT_GT(joined, 50);
  EXPECT_GT(apart, 5);
}

TEST(Instances, AreKeptWhereFlatteningThemWouldTakeMuchMemory) {
  std::vector<std::pair<std::uint32_t, Mat4>> placed;
  for (int i = 0; i < 40; ++i) placed.emplace_back(0, test::moved(Vec3(3 * i, 0, 0), Mat4(1.0)));
  const Scene few = test::instances_of({test::ball()}, placed);
  EXPECT_FALSE(plan_instances(few).keep);
  EXPECT_FALSE(make_world(few).keeps_instances());
  const Scene many = test::instances_of({test::uv_sphere(Vec3(0.0), 1.0, 200, 200, 0.0, 1)}, placed);
  const InstancePlan plan = plan_instances(many);
  EXPECT_TRUE(plan.keep);
  EXPECT_EQ(plan.instances, 40u);
  EXPECT_EQ(plan.meshes, 1u);
  EXPECT_EQ(plan.triangles, 40u * many.meshes[0].triangles.size());
  EXPECT_TRUE(make_world(many).keeps_instances());
}

TEST(Instances, WhoseTrianglesLoseTheirAreaAreFlattened) {
  const BothWays w(test::instances_of(
      {test::ball()}, {{0, Mat4(1.0)},
                       {0, test::scaling({1.0, 0.0, 1.0})},
                       {0, test::scaling(Vec3(0.0))},
                       {0, test::moved(Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0), Mat4(1.0))},
                       {0, test::moved(Vec3(0, 3e15, 0), Mat4(1.0))}}));
  EXPECT_TRUE(w.kept.parts[0].kept());
  EXPECT_TRUE(w.kept.parts[1].kept());  // as flat as can be, but each triangle has its area
  for (std::size_t i = 2; i < 5; ++i) EXPECT_FALSE(w.kept.parts[i].kept()) << i;
}

}  // namespace
}  // namespace gnomon
