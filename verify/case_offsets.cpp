// Rays that leave a convex body do not meet it: convexity is the oracle. The gap that the ray-offset policy
// leaves is measured against the rounding of the body's place.
#include <fmt/core.h>

#include <cfloat>

#include "verify/cases.h"
#include "verify/small_world.h"

namespace gnomon::verify {

namespace {

constexpr double gap_bound = 64.0;

/// A ray onto the body from outside, then one that leaves from where it hit, half of them grazing.
void leave(const raytrace::Tracer& tracer, const Vec3& center, double radius, Random& r, Tally& tally) {
  const Vec3 from = r.direction();
  const Ray ray{center + 3.0 * radius * from, -from + 0.2 * r.direction()};
  const auto hit = tracer.closest_hit(ray);
  if (!hit) return;
  const raytrace::SurfacePoint point = tracer.surface_point(ray, *hit);
  Vec3 out = r.direction();
  if (r.coin()) out -= 0.9999 * glm::dot(out, point.normal) * point.normal;
  if (glm::dot(out, point.normal) < 0.0) out = -out;
  const Ray leaving = tracer.spawn_ray(point, out);
  tally.check(!tracer.occluded(leaving));
  const double place = std::abs(center.x) + std::abs(center.y) + std::abs(center.z) + radius;
  tally.error(glm::length(leaving.origin - point.position) / (place * DBL_EPSILON));
}

}  // namespace

void self_hits(Run& run) {
  Random random(run.seed());
  for (const double radius : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    for (const double place : {0.0, 1.0, 1e3, 1e7}) {
      const Vec3 center = place * Vec3(0.6, -0.64, 0.48);
      const auto body = [&](const char* name, const SmallWorld& w) {
        const raytrace::Tracer tracer = run.tracer(w.world());
        run.sample(
            fmt::format("{} of {:g} at {:g}", name, radius, place), run.rays(0.02),
            [&](Random& r, Tally& tally) { leave(tracer, center, radius, r, tally); },
            "roundings of the place", gap_bound);
      };
      body("sphere", SmallWorld(std::vector<Shape>{sphere(center, radius)}));
      body("box", SmallWorld(box(center - Vec3(radius) / 1.75, center + Vec3(radius) / 1.75)));
    }
  }
}

namespace {

/// Three instances of one mesh, `way` apart, whose hierarchy is in the mesh's own space and shared. Asked is what is
/// hit, and that nothing meets itself, as brute force in the world has it.
void shared_tree(Run& run, const std::string& name, Scene scene, const Vec3& way) {
  const double radius = 0.5 * glm::length(way);
  for (int i = 1; i <= 2; ++i) {
    MeshInstance next = scene.instances[0];
    next.world_from_object[3] += Vec4(static_cast<double>(i) * way, 0.0);
    scene.instances.push_back(next);
  }
  const SmallWorld w(std::move(scene));
  const raytrace::Tracer tracer = run.tracer(w.world(), raytrace::Accel::two_level);
  const raytrace::Tracer brute = run.tracer(w.world(), raytrace::Accel::brute);
  run.sample(name, run.rays(0.1), [&](Random& r, Tally& tally) {
    const Vec3 corner = w.world().position(r.below(w.world().vertex_count()));
    const double distance = r.power_of_ten(-2.0, 3.0) * radius;
    const Vec3 from = corner + distance * r.direction();
    const Ray ray{from, r.nudged(corner, 2) - from};
    const auto hit = brute.closest_hit(ray);
    bool right = same(tracer.closest_hit(ray), hit) && tracer.occluded(ray) == hit.has_value();
    if (right && hit) {
      const raytrace::SurfacePoint point = brute.surface_point(ray, *hit);
      const Ray leaving = brute.spawn_ray(point, r.direction());
      right = same(tracer.closest_hit(leaving), brute.closest_hit(leaving));
    }
    tally.check(right);
  });
}

}  // namespace

void instances(Run& run) {
  for (const double scale : {1e-4, 1.0, 1e4}) {
    Scene scene = scene_of({box(Vec3(-1.0), Vec3(1.0))});
    // Column by column: scaled, sheared, turned, then moved.
    const Mat4 turn =
        Mat4(Vec4(0.36, 0.48, -0.8, 0), Vec4(-0.8, 0.6, 0, 0), Vec4(0.48, 0.64, 0.6, 0), Vec4(0, 0, 0, 1));
    const Mat4 shear(Vec4(1, 0, 0, 0), Vec4(0.7, 1, 0.2, 0), Vec4(-0.4, 0.5, 1, 0), Vec4(0, 0, 0, 1));
    Mat4 move(1.0), stretch(1.0);
    for (int a = 0; a < 3; ++a) stretch[a][a] = a == 1 ? 0.01 * scale : scale;
    move[3] = Vec4(3.0, -5.0, 11.0, 1.0);
    scene.instances[0].world_from_object = move * turn * shear * stretch;
    const SmallWorld w(scene);
    const raytrace::Tracer tracer = run.tracer(w.world());
    const Vec3 center(3.0, -5.0, 11.0);
    const double radius = 0.5 * w.world().finite_bounds.diagonal();
    run.sample(
        fmt::format("scale {:g}", scale), run.rays(0.1),
        [&](Random& r, Tally& tally) { leave(tracer, center, radius, r, tally); }, "roundings of the place",
        gap_bound);
    // Also where the world's corners are so coarse that they show: a millionth of the mesh.
    for (const double place : {0.0, 1e10}) {
      Scene moved = scene;
      moved.instances[0].world_from_object[3] += Vec4(place * radius * Vec3(0.6, -0.64, 0.48), 0.0);
      shared_tree(run, fmt::format("one tree for three of {:g}{}", scale, place > 0.0 ? ", far away" : ""),
                  std::move(moved), 2.0 * radius * Vec3(1, 0, 0));
    }
  }
}

}  // namespace gnomon::verify
