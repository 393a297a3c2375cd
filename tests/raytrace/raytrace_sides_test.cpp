// Backs of single-sided materials: what sees goes through them, in every structure and arithmetic, and finds what lies
// behind; shadows are cast by both sides.
#include <gtest/gtest.h>

#include "raytrace/kernels.h"
#include "tests/support/raytrace_support.h"

namespace gnomon {
namespace {

using namespace raytrace;  // NOLINT(google-build-using-namespace): every second word here is from that room
using test::Random;
using test::same;
using test::TestWorld;

constexpr std::array<Accel, 10> every_structure{
    Accel::bvh,  Accel::bvh_median,    Accel::kdtree, Accel::kdtree_cyclic, Accel::octree,
    Accel::grid, Accel::grid_textbook, Accel::bsp,    Accel::two_level,     Accel::brute};

/// Every other triangle has one side.
Scene half_single_sided(Mesh mesh) {
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) mesh.triangle_materials.push_back(i % 2);
  Scene scene = test::scene_of({std::move(mesh)});
  scene.materials.resize(2);
  scene.materials[1].double_sided = false;
  return scene;
}

bool lets_through(const World& world, const Ray& ray, std::uint32_t triangle) {
  const auto [a, b, c] = world.corners(triangle);
  return triangle % 2 == 1 && glm::dot(ray.direction, glm::cross(b - a, c - a)) > 0.0;
}

/// Each triangle asked alone: the nearest that does not let the ray through.
class OneByOne {
 public:
  explicit OneByOne(const World& world) : world_(world) {
    for (std::uint32_t i = 0; i < world.triangle_count(); ++i) {
      Mesh mesh;
      for (const Vec3& corner : world.corners(i)) mesh.positions.push_back(corner);
      mesh.triangles = {{0, 1, 2}};
      alone_.push_back(std::make_unique<TestWorld>(std::move(mesh)));
      tracers_.emplace_back(alone_.back()->world(), Accel::brute);
    }
  }
  std::optional<Hit> operator()(const Ray& ray) const {
    std::optional<Hit> best;
    for (std::uint32_t i = 0; i < tracers_.size(); ++i) {
      auto hit = tracers_[i].closest_hit(ray);
      if (!hit || lets_through(world_, ray, i) || (best && best->t <= hit->t)) continue;
      best = hit, best->primitive = i;
    }
    return best;
  }

 private:
  const World& world_;
  std::vector<std::unique_ptr<TestWorld>> alone_;
  std::vector<Tracer> tracers_;
};

std::vector<Ray> rays_through(double extent, std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<Ray> rays;
  const auto place = [&] {
    return Vec3{random.uniform(-extent, extent), random.uniform(-extent, extent),
                random.uniform(-extent, extent)};
  };
  for (int i = 0; i < count; ++i) {
    const Vec3 from = 2.0 * place();
    rays.push_back({from, glm::normalize(place() - from)});
  }
  return rays;
}

TEST(Sides, EveryStructureSeesThroughTheSameBacks) {
  const TestWorld w(half_single_sided(test::triangle_soup(150, 1.0, 0.6, 7)));
  const TestWorld both(test::triangle_soup(150, 1.0, 0.6, 7));
  const OneByOne truth(w.world());
  const std::vector<Ray> rays = rays_through(1.0, 11, 400);
  std::vector<std::optional<Hit>> seen;
  std::size_t through = 0;
  const Tracer plain(both.world(), Accel::brute);
  for (const Ray& ray : rays) {
    seen.push_back(truth(ray));
    through += same(seen.back(), plain.closest_hit(ray)) ? 0 : 1;
  }
  EXPECT_GT(through, 50U);
  for (const Accel accel : every_structure) {
    const Tracer tracer(w.world(), accel);
    std::size_t wrong = 0, shadows = 0, counted = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      WorkCounts work;
      wrong += same(tracer.closest_seen(rays[i]), seen[i]) ? 0 : 1;
      counted += same(tracer.closest_seen(rays[i], work), seen[i]) ? 0 : 1;
      shadows += tracer.occluded(rays[i]) == plain.occluded(rays[i]) &&
                         same(tracer.closest_hit(rays[i]), plain.closest_hit(rays[i]))
                     ? 0
                     : 1;
    }
    EXPECT_EQ(wrong, 0U) << static_cast<int>(accel);
    EXPECT_EQ(counted, 0U) << static_cast<int>(accel);
    EXPECT_EQ(shadows, 0U) << static_cast<int>(accel) << ": both sides cast shadows";
  }
  for (const Precision precision : {Precision::exact, Precision::fast}) {
    const Tracer tracer(w.world(), Accel::bvh, precision);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto hit = tracer.closest_seen(rays[i]);
      wrong += (hit ? hit->primitive : no_id) == (seen[i] ? seen[i]->primitive : no_id) ? 0 : 1;
    }
    EXPECT_EQ(wrong, 0U) << precision_name(precision);
  }
}

Scene single_sided_ball(const Mat4& world_from_object) {
  Scene scene = test::scene_of({test::uv_sphere(Vec3(0.0), 1.0, 12, 16, 0.0, 1)});
  scene.materials[0].double_sided = false;
  scene.instances[0].world_from_object = world_from_object;
  return scene;
}

// From outside it has no hole, where edges and corners are aimed at either; from inside it is not there. So it is
// where the instance is a mirror image, whose winding is turned round.
TEST(Sides, AClosedBodyIsSeenFromOutsideAlone) {
  for (const bool mirrored : {false, true}) {
    const TestWorld w(
        single_sided_ball(glm::dmat4(glm::dmat3(mirrored ? -1.0 : 1.0, 0, 0, 0, 1, 0, 0, 0, 1))));
    const Tracer tracer(w.world(), Accel::bvh);
    const Vec3 inside(0.01, 0.02, 0.03), outside(0.3, 0.4, 5.0);
    std::size_t wrong = 0;
    for (std::uint32_t t = 0; t < w.world().triangle_count(); ++t)
      for (int corner = 0; corner < 3; ++corner) {
        const auto corners = w.world().corners(t);
        const Vec3 a = corners[static_cast<std::size_t>(corner)],
                   b = corners[static_cast<std::size_t>((corner + 1) % 3)];
        for (const Vec3& target : {a, 0.5 * (a + b)}) {
          wrong += tracer.closest_seen({inside, target - inside}) ? 1 : 0;
          const Ray ray{outside, 0.9 * target - outside};
          const auto hit = tracer.closest_seen(ray);
          wrong += hit && same(hit, tracer.closest_hit(ray)) ? 0 : 1;
          wrong += tracer.occluded({inside, target - inside}) ? 0 : 1;
        }
      }
    EXPECT_EQ(wrong, 0U) << (mirrored ? "mirrored" : "as it is");
  }
}

TEST(Sides, GlassIsSeenFromInsideWhateverItsMaterialSays) {
  Scene scene = single_sided_ball(Mat4(1.0));
  scene.materials[0].transmission = 1.0f;
  const TestWorld glass(scene);
  EXPECT_TRUE(Tracer(glass.world(), Accel::bvh).closest_seen({Vec3(0.1), {0, 0, 1}}));
  scene.materials[0].thin = true;
  const TestWorld sheet(std::move(scene));
  EXPECT_FALSE(Tracer(sheet.world(), Accel::bvh).closest_seen({Vec3(0.1), {0, 0, 1}}));
}

TEST(Sides, TheFacingOfAnEyeIsThatOfEveryRayFromIt) {
  Random random(3);
  const Mesh mesh = test::triangle_soup(300, 1.0, 0.5, 9);
  const TestWorld w(mesh);
  std::size_t doubtful = 0, wrong = 0;
  for (std::uint32_t i = 0; i < w.world().triangle_count(); ++i) {
    const auto corners = w.world().corners(i);
    const Vec3 eye{random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0)};
    const std::array<double, 9> v{corners[0].x, corners[0].y, corners[0].z, corners[1].x, corners[1].y,
                                  corners[1].z, corners[2].x, corners[2].y, corners[2].z};
    const Facing facing = facing_of(v.data(), eye);
    const Vec3 inner = (corners[0] + corners[1] + corners[2]) / 3.0;
    doubtful += facing == Facing::ambiguous ? 1 : 0;
    wrong += (facing == Facing::back) != is_back(w.world(), inner - eye, i) ? 1 : 0;
    // In the triangle's plane nothing can be said.
    wrong += facing_of(v.data(), corners[0]) == Facing::ambiguous ? 0 : 1;
  }
  EXPECT_EQ(doubtful + wrong, 0U);
}

}  // namespace
}  // namespace gnomon
