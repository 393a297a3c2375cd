// Closed meshes are watertight. The oracle is topology: a ray from inside a closed surface must meet it.
#include <fmt/core.h>

#include "verify/cases.h"
#include "verify/small_world.h"

namespace gnomon::verify {

namespace {

constexpr int mesh_rings = 16;

/// From near the middle at a corner, or at a point of an edge, nudged by up to 4 representable numbers.
Ray inside_out(const World& world, const Vec3& center, bool at_edge, Random& random) {
  const auto corners = world.corners(random.below(world.triangle_count()));
  const double s = at_edge ? random.uniform(0.0, 1.0) : 0.0;
  const Vec3 aim = random.nudged(corners[0] + s * (corners[1] - corners[0]), 4);
  const Vec3 origin = center + random.in_box(0.3);
  return {origin, aim - origin};
}

}  // namespace

void shared_edges(Run& run) {
  Random random(run.seed());
  for (const Vec3& center : {Vec3(0.0), Vec3(3e3), Vec3(148376.0, 1234.0, -223423.0)}) {
    const SmallWorld w(in_floats(round_mesh(center, 1.0, mesh_rings, mesh_rings, 0.05, random)));
    const raytrace::Tracer tracer = run.tracer(w.world());
    for (const bool at_edge : {false, true}) {
      run.sample(fmt::format("{} at {:g}", at_edge ? "edges" : "vertices", glm::length(center)),
                 run.rays(0.5), [&](Random& r, Tally& tally) {
                   tally.check(tracer.closest_hit(inside_out(w.world(), center, at_edge, r)).has_value());
                 });
    }
  }
  triangles_by_rationals(run);
  shadows_by_rationals(run);
}

void light_inside(Run& run) {
  Random random(run.seed());
  const Vec3 center(0.0, 2.0, 0.0);
  const SmallWorld w({in_floats(round_mesh(center, 1.0, mesh_rings, mesh_rings, 0.05, random))},
                     {plane(Vec3(0.0), Vec3(0.0, 1.0, 0.0))});
  const raytrace::Tracer tracer = run.tracer(w.world());
  const World& world = w.world();
  run.sample("lit outside", run.rays(0.3), [&](Random& r, Tally& tally) {
    const Light light = point_light(center + r.in_box(0.3));
    Vec3 foot{r.uniform(-5.0, 5.0), 0.0, r.uniform(-5.0, 5.0)};
    // Mostly straight behind a corner, seen from the light.
    const Vec3 d = world.position(r.below(world.vertex_count())) - light.position;
    if (d.y < -0.05) foot = light.position - d * (light.position.y / d.y), foot.y = 0.0;
    const auto point = seen(tracer, foot + Vec3(0.0, 0.01, 0.0), foot);
    tally.check(tracer.centre_visibility(point, light) != raytrace::PointVisibility::lit);
  });
}

}  // namespace gnomon::verify
