// Rays that are badly scaled, nearly parallel to a plane, or no rays at all. Oracles: exact scaling by powers
// of two, the plane's closed form in 128 bits.
#include <limits>

#include "raytrace/precision/error_bounds.h"
#include "verify/cases.h"
#include "verify/quad.h"
#include "verify/small_world.h"

namespace gnomon::verify {

namespace {

std::vector<Shape> spheres(int count, Random& random) {
  std::vector<Shape> shapes;
  for (int i = 0; i < count; ++i) {
    const Vec3 center = random.in_box(4.0);
    shapes.push_back(sphere(center, random.uniform(0.05, 0.8)));
  }
  return shapes;
}

/// Returns a number of either sign; 0 once in 16 times.
double slope_or_height(Random& r, double least_power, double most_power) {
  const double sign = r.coin() ? 1.0 : -1.0;
  return sign * (r.below(16) == 0 ? 0.0 : r.power_of_ten(least_power, most_power));
}

}  // namespace

void direction_length(Run& run) {
  Random random(run.seed());
  const Mesh triangles = soup(300, 4.0, 1.0, random);
  const SmallWorld w({triangles}, spheres(20, random));
  const raytrace::Tracer tracer = run.tracer(w.world());
  run.sample("powers of two", run.rays(0.3), [&](Random& r, Tally& tally) {
    const Vec3 origin = r.in_box(6.0), d = r.direction();
    const double scale = std::ldexp(1.0, r.integer(-900, 900));
    const auto plain = tracer.closest_hit({origin, d}), scaled = tracer.closest_hit({origin, d * scale});
    const bool found = plain.has_value() == scaled.has_value();
    tally.check(found &&
                (!plain || (plain->t == scaled->t * scale && plain->primitive == scaled->primitive)));
  });
  run.sample(
      "1e-20 and 1e20", run.rays(0.3),
      [&](Random& r, Tally& tally) {
        const Vec3 origin = r.in_box(6.0), middle = w.world().finite_bounds.center();
        // At the middle of a triangle, so that rounding of the scaled direction cannot turn hit into miss.
        const auto [a, b, c] = w.world().corners(r.below(w.world().triangle_count()));
        const Vec3 d = (a + b + c) / 3.0 - origin;
        const double scale = r.coin() ? 1e20 : 1e-20;
        const auto hit = tracer.closest_hit({origin, d * scale});
        tally.check(hit && hit->t * scale <= 1.0 + 1e-9);
        if (!hit || !w.world().is_triangle(hit->primitive)) return;
        const auto corners = w.world().corners(hit->primitive);
        const QuadTriangle truth = line_triangle(origin, d * scale, corners[0], corners[1], corners[2]);
        const double size = glm::length(origin - middle) + 10.0;
        const Vec3 n = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double cosine = std::abs(glm::dot(n, d)) / (glm::length(n) * glm::length(d));
        const double error = std::abs(static_cast<double>(Quad(hit->t) - truth.t)) * scale * glm::length(d);
        tally.error(error * cosine * cosine / (size * raytrace::unit_roundoff));
      },
      "roundings of the scene / cos^2", 64.0);
  run.sample("zero", run.rays(0.01), [&](Random& r, Tally& tally) {
    const Ray ray{r.in_box(6.0), Vec3(r.coin() ? 0.0 : -0.0)};
    tally.check(!tracer.closest_hit(ray) && !tracer.occluded(ray));
  });
}

void steep_plane(Run& run) {
  const SmallWorld w(std::vector<Shape>{plane(Vec3(0.0), Vec3(0.0, 1.0, 0.0))});
  const raytrace::Tracer tracer = run.tracer(w.world());
  run.sample(
      "slopes 1e-320 to 1", run.rays(0.3),
      [&](Random& r, Tally& tally) {
        const double slope = slope_or_height(r, -320.0, 0.0), height = slope_or_height(r, -3.0, 300.0);
        const auto hit = tracer.closest_hit({{0.0, height, 0.0}, {1.0, slope, 0.0}});
        if (!hit) {
          const Quad t = slope == 0.0 ? Quad(0) : -Quad(height) / Quad(slope);
          return tally.check(
              !(t > 0 && t < Quad(1e307)));  // met within reach of a double: must not be missed
        }
        tally.check(std::isfinite(hit->t) && hit->t > 0.0 && slope != 0.0);
        if (std::abs(slope) < 1e-305) return;  // a subnormal loses places when the direction is scaled
        const Quad error = magnitude(Quad(hit->t) * Quad(slope) + Quad(height)) / magnitude(Quad(height));
        tally.error(static_cast<double>(error) / raytrace::unit_roundoff);
      },
      "roundings of t", 8.0);
}

void invalid_rays(Run& run) {
  Random random(run.seed());
  const Mesh triangles = soup(300, 4.0, 1.0, random);
  const SmallWorld w({triangles}, spheres(20, random));
  const raytrace::Tracer tracer = run.tracer(w.world());
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  run.sample("work done", run.rays(0.1), [&](Random& r, Tally& tally) {
    Ray ray{r.in_box(4.0), r.direction()};
    const double poison = r.coin() ? nan : (r.coin() ? infinity : -infinity);
    switch (r.below(5)) {
      case 0:
        ray.origin[r.integer(0, 2)] = poison;
        break;
      case 1:
        ray.direction[r.integer(0, 2)] = poison;
        break;
      case 2:
        ray.direction = Vec3(0.0);
        break;
      case 3:
        ray.t = {nan, infinity};
        break;
      default:
        ray.t = {2.0, 1.0};
        break;
    }
    raytrace::WorkCounts work;
    const bool hit = tracer.closest_hit(ray, work) || tracer.occluded(ray, work);
    tally.check(!hit && work.boxes + work.primitives == 0);
  });
}

}  // namespace gnomon::verify
