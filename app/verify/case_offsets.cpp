// Rays that leave a convex body do not meet it: convexity is the oracle. The gap that the ray-offset policy
// leaves is measured against the rounding of the body's place.
#include <fmt/format.h>

#include <cfloat>

#include "app/verify/cases.h"
#include "app/verify/small_world.h"

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
    const SmallWorld w(std::move(scene));
    const raytrace::Tracer tracer = run.tracer(w.world());
    const Vec3 center(3.0, -5.0, 11.0);
    const double radius = 0.5 * w.world().finite_bounds.diagonal();
    run.sample(
        fmt::format("scale {:g}", scale), run.rays(0.1),
        [&](Random& r, Tally& tally) { leave(tracer, center, radius, r, tally); }, "roundings of the place",
        gap_bound);
  }
}

}  // namespace gnomon::verify
