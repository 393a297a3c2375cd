// Where shadow rays start and end. Oracles: closed forms on axis-parallel scenes whose numbers are exact.
#include <fmt/core.h>

#include "raytrace/precision/error_bounds.h"
#include "scene/light.h"
#include "verify/cases.h"
#include "verify/quad.h"
#include "verify/small_world.h"

namespace gnomon::verify {

using raytrace::Accel;
using raytrace::PointVisibility;
using raytrace::SurfacePoint;
using raytrace::Tracer;

void light_in_plane(Run& run) {
  const SmallWorld w(quad({-8, 0, -8}, {0, 0, 16}, {16, 0, 0}));
  const Tracer bvh = run.tracer(w.world()), brute = run.tracer(w.world(), Accel::brute);
  run.sample("unlit", run.rays(0.3), [&](Random& r, Tally& tally) {
    const Vec3 foot{r.uniform(-8.0, 8.0), 0.0, r.uniform(-8.0, 8.0)};
    for (const Tracer* tracer : {&bvh, &brute}) {
      const SurfacePoint p = seen(*tracer, foot + Vec3(0.0, 1.0, 0.0), foot);
      const Light lamp = point_light({r.uniform(-20.0, 20.0), p.position.y, r.uniform(-20.0, 20.0)});
      const double turn = r.uniform(0.0, 2.0 * pi);
      Light far = sun({1.0, 0.0, 0.0});
      far.direction = {std::cos(turn), r.coin() ? 0.0 : -0.0, std::sin(turn)};
      tally.check(light_cannot_reach(lamp, p.position, p.normal) &&
                  light_cannot_reach(far, p.position, p.normal));
    }
  });
}

void light_at_vertex(Run& run) {
  const SmallWorld w({box({-1, 2, -1}, {1, 3, 1})}, {plane(Vec3(0.0), Vec3(0.0, 1.0, 0.0))});
  const Light light = point_light({1.0, 2.0, 1.0});
  const Tracer bvh = run.tracer(w.world()), brute = run.tracer(w.world(), Accel::brute);
  run.sample("lit", run.rays(0.1), [&](Random& r, Tally& tally) {
    const Vec3 foot{r.uniform(1.5, 4.0), 0.0, r.uniform(1.5, 4.0)};
    for (const Tracer* tracer : {&bvh, &brute}) {
      const SurfacePoint p = seen(*tracer, foot + Vec3(0.0, 0.5, 0.0), foot);
      tally.check(tracer->centre_visibility(p, light) == PointVisibility::lit);
    }
  });
}

void occluder_at_end(Run& run) {
  const SmallWorld w({quad({-64, -64, 0}, {128, 0, 0}, {0, 128, 0})}, {plane({0, 0, -4}, {0, 0, 1})});
  const Tracer tracer = run.tracer(w.world());
  run.sample("inside or out", run.rays(), [&](Random& r, Tally& tally) {
    // Heights are multiples of 1/1024, so that t is exact.
    const double height = r.integer(1, 1 << 20) / 1024.0;
    const Vec3 origin{r.uniform(-60.0, 60.0), r.uniform(-60.0, 60.0), height};
    const bool second = r.coin();
    const double t = second ? height + 4.0 : height, below = std::nextafter(t, 0.0),
                 above = std::nextafter(t, infinity);
    const double start = second ? height : 0.0;
    const auto occluded = [&](double lo, double hi) {
      return tracer.occluded({origin, {0.0, 0.0, -1.0}, {lo, hi}});
    };
    tally.check(!occluded(start, t) && !occluded(start, below) && occluded(start, above) &&
                occluded(below, above) && !occluded(t, std::nextafter(above, infinity)));
  });
}

void coplanar_duplicates(Run& run) {
  const Vec3 corner(-1.1, 0.3, -0.9), a(0.1, 0.2, 2.2), b(2.1, -0.3, 0.2);
  const Mesh twin = quad(corner, a, b);
  const SmallWorld w({twin, twin, twin}, {});
  Mesh backwards = twin;  // the same triangles in the other order
  std::swap(backwards.triangles[0], backwards.triangles[1]);
  const SmallWorld v({backwards, twin, twin}, {});
  const Tracer tracer = run.tracer(w.world()), other = run.tracer(v.world());
  run.sample("ties", run.rays(0.3), [&](Random& r, Tally& tally) {
    const double s = r.uniform(0.05, 0.95), t = r.uniform(0.05, 0.95);
    const Vec3 target = corner + s * a + t * b;
    const Ray ray{target + Vec3(0.0, 3.0, 0.0), {0.0, -1.0, 0.0}};
    const auto hit = tracer.closest_hit(ray), again = other.closest_hit(ray);
    if (!hit || !again || hit->t != again->t) return tally.check(false);
    // On the diagonal both halves are met; elsewhere the first mesh's own half, whatever its number.
    const bool swapped = hit->primitive + again->primitive == 1;
    tally.check(hit->primitive < 2 && again->primitive < 2 && (swapped || std::abs(s - t) < 1e-9));
  });
  run.sample("twins lit", run.rays(0.1), [&](Random& r, Tally& tally) {
    const double u = r.uniform(0.05, 0.95), v = r.uniform(0.05, 0.95);
    const Vec3 target = corner + u * a + v * b;
    const SurfacePoint p = seen(tracer, target + Vec3(0.0, 3.0, 0.0), target);
    tally.check(tracer.centre_visibility(p, point_light({r.uniform(-3.0, 3.0), 4.0, 0.0})) ==
                PointVisibility::lit);
  });
}

void contact_gap(Run& run) {
  // Light at 45 degrees slips under the box by the height of the gap; where the box stands on the ground the
  // shadow starts at its foot on the far side.
  const Light light = sun({1.0, -1.0, 0.0});
  for (const double gap : {0.0, 1e-7, 1e-4}) {
    const SmallWorld w({box({-1, gap, -1}, {1, 1, 1})}, {plane(Vec3(0.0), Vec3(0.0, 1.0, 0.0))});
    const Tracer tracer = run.tracer(w.world());
    const double edge = gap > 0.0 ? -1.0 + gap : 1.0, eye_height = gap > 0.0 ? 0.5 * gap : 1e-3;
    run.sample(
        fmt::format("gap {:g}", gap), run.rays(0.01, 100'000),
        [&](Random& r, Tally& tally) {
          const double z = r.uniform(-0.9, 0.9);
          const auto shadowed = [&](double x) {
            const Vec3 foot(x, 0.0, z);
            return tracer.centre_visibility(seen(tracer, foot + Vec3(0.0, eye_height, 0.0), foot), light) ==
                   PointVisibility::shadowed;
          };
          tally.check(shadowed(edge + 0.25) && !shadowed(2.0 + 1e-9) && !shadowed(-1.0 - 1e-9));
          // The first surely shadowed place, by bisection.
          double lit = gap > 0.0 ? -1.5 : 1.0, dark = edge + 0.25;
          for (int i = 0; i < 60; ++i) (shadowed(0.5 * (lit + dark)) ? dark : lit) = 0.5 * (lit + dark);
          tally.error(std::abs(dark - edge) / raytrace::unit_roundoff);
        },
        "roundings of the foot", 256.0);
  }
}

void smooth_normals(Run& run) {
  Random random(run.seed());
  Mesh mesh = in_floats(round_mesh(Vec3(0.0), 1.0, 6, 8, 0.0, random));
  for (const Vec3& p : mesh.positions) mesh.normals.emplace_back(Vec3f(glm::normalize(p)));
  const SmallWorld w(mesh);
  const Tracer tracer = run.tracer(w.world());
  run.sample("lit as the facet faces", run.rays(0.3), [&](Random& r, Tally& tally) {
    const Vec3 eye = 3.0 * r.direction(), target = 0.5 * r.direction();
    const SurfacePoint p = seen(tracer, eye, target);
    if (p.primitive == no_id) return;
    const Light light = point_light(5.0 * r.direction());
    const auto corners = w.world().corners(p.primitive);
    const Quad3 n = cross(Quad3(corners[1]) - Quad3(corners[0]), Quad3(corners[2]) - Quad3(corners[0]));
    const double facing = static_cast<double>(dot(n, Quad3(light.position) - Quad3(corners[0])));
    if (std::abs(facing) < 1e-12) return;  // the light in the facet's plane, but for the point's rounding
    const bool reached = !light_cannot_reach(light, p.position, p.normal);
    tally.check(reached == (facing > 0.0) &&
                (!reached || tracer.centre_visibility(p, light) == PointVisibility::lit));
  });
}

}  // namespace gnomon::verify
