// Spheres against the textbook quadratic in 128 bits, on the same ray.
#include <fmt/core.h>

#include "raytrace/precision/error_bounds.h"
#include "verify/cases.h"
#include "verify/quad.h"
#include "verify/small_world.h"

namespace gnomon::verify {

using raytrace::unit_roundoff;

void distant_sphere(Run& run) {
  const SmallWorld w(std::vector<Shape>{sphere(Vec3(0.0), 1.0)});
  const raytrace::Tracer tracer = run.tracer(w.world());
  for (double distance = 10.0; distance < 2e7; distance *= 10.0) {
    // Rounding of the closest point to the centre: a few units in the last place of the distance. Rays that
    // pass so close to the silhouette may go either way.
    constexpr double allowed = 16.0;
    run.sample(
        fmt::format("distance {:g}", distance), run.rays(1.0 / 7.0, 1'000'000),
        [&](Random& r, Tally& tally) {
          const Vec3 origin = distance * r.direction();
          const Vec3 towards = r.direction();
          const Ray ray{origin, towards * r.uniform(0.9, 1.1) - origin};
          const QuadRoots truth = line_sphere(ray.origin, ray.direction, Vec3(0.0), 1.0);
          const bool hits = truth.discriminant >= 0;
          if (hits == tracer.closest_hit(ray).has_value()) return tally.check(true);
          // b^2 - a c = a (1 - p^2), p the distance at which the ray passes the centre.
          const double margin = std::abs(static_cast<double>(truth.discriminant / truth.a)) / 2.0;
          const double roundings = margin / (distance * unit_roundoff);
          tally.check(roundings <= allowed);
          tally.error(roundings);
        },
        "roundings of the distance", allowed);
  }
}

void tangent_ray(Run& run) {
  run.sample(
      "b = r +- 64 ulp", run.rays(0.1, 1'000'000),
      [&](Random& r, Tally& tally) {
        const double radius = r.power_of_ten(-3.0, 3.0);
        const SmallWorld w(std::vector<Shape>{sphere(Vec3(0.0), radius)});
        const raytrace::Tracer tracer = run.tracer(w.world(), raytrace::Accel::brute);
        const int axis = r.integer(0, 2), across = (axis + r.integer(1, 2)) % 3, steps = r.integer(-64, 64);
        double b = radius;
        for (int i = 0; i < std::abs(steps); ++i) b = std::nextafter(b, steps < 0 ? 0.0 : infinity);
        Vec3 origin(0.0), d(0.0);
        origin[axis] = -5.0 * radius, origin[across] = r.coin() ? b : -b, d[axis] = 1.0;
        const bool right = tracer.occluded({origin, d}) == (b <= radius);
        const double units = std::abs(b - radius) / (radius * unit_roundoff);
        tally.check(right || units <= 2.0);
        if (!right) tally.error(units);
      },
      "roundings of the radius", 2.0);
}

void inside_sphere(Run& run) {
  const Vec3 center(0.1, -0.2, 0.3);
  constexpr double radius = 1.25;
  const SmallWorld w(std::vector<Shape>{sphere(center, radius)});
  const raytrace::Tracer tracer = run.tracer(w.world());
  const auto leave = [&](const Vec3& origin, Random& r, Tally& tally) {
    const Ray ray{origin, r.direction()};
    const QuadRoots truth = line_sphere(origin, ray.direction, center, radius);
    const auto hit = tracer.closest_hit(ray);
    tally.check(hit.has_value());
    if (!hit) return;
    // A grazing exit magnifies rounding by the radius over half the chord.
    const double half_chord = std::sqrt(static_cast<double>(truth.discriminant / truth.a));
    const double condition = 1.0 + radius / half_chord;
    const double error = static_cast<double>(magnitude(Quad(hit->t) - truth.far));
    tally.error(error / (unit_roundoff * radius * condition));
  };
  constexpr const char* unit = "roundings of the radius x condition";
  run.sample(
      "inside", run.rays(0.1, 1'000'000),
      [&](Random& r, Tally& tally) {
        const double distance = r.uniform(0.0, 1.2);
        leave(center + distance * r.direction(), r, tally);
      },
      unit, 16.0);
  run.sample(
      "just inside", run.rays(0.1, 1'000'000),
      [&](Random& r, Tally& tally) {
        const double distance = radius * (1.0 - r.power_of_ten(-12.0, -1.0));
        leave(center + distance * r.direction(), r, tally);
      },
      unit, 16.0);
}

void nested_spheres(Run& run) {
  const SmallWorld w(std::vector<Shape>{sphere(Vec3(0.0), 1.0), sphere(Vec3(0.0), 1.0 + 4e-5)});
  const raytrace::Tracer tracer = run.tracer(w.world());
  run.sample("both met", run.rays(), [&](Random& r, Tally& tally) {
    const Vec3 origin = 3.0 * r.direction();
    const Ray ray{origin, glm::normalize(0.9 * r.direction() - origin)};
    const auto outer = tracer.closest_hit(ray);
    if (!outer || outer->primitive != 1) return tally.check(false);
    const auto inner = tracer.closest_hit(tracer.spawn_ray(tracer.surface_point(ray, *outer), ray.direction));
    tally.check(inner && inner->primitive == 0);
  });
}

}  // namespace gnomon::verify
