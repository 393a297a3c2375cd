// Thin triangles, triangles without area, and rays in a triangle's plane. Oracles: closed forms, and whole
// numbers that make a plane's membership exact.
#include "verify/cases.h"
#include "verify/small_world.h"

namespace gnomon::verify {

namespace {

Vec3 whole_numbers(Random& random, int most) {
  Vec3 v;
  for (int a = 0; a < 3; ++a) v[a] = random.integer(-most, most);
  return v;
}

}  // namespace

void sliver(Run& run) {
  constexpr double length = 1e6, distance = 1e3, tilt = 0.5 * pi / 180.0;
  // Each weight of a triangle 1e6 long and 1 wide, seen at 0.5 degrees, carries 2^-53 * 1e6 / sin(tilt); the
  // weights move the hit by the triangle's length.
  constexpr double bound = 0.013;
  Mesh mesh;
  mesh.positions = {{0.0, 0.0, 0.0}, {length, 0.0, 0.0}, {length / 2, 1.0, 0.0}};
  mesh.triangles = {{0, 1, 2}};
  const SmallWorld w(mesh);
  const raytrace::Tracer tracer = run.tracer(w.world());
  run.sample(
      "hits", run.rays(),
      [&](Random& r, Tally& tally) {
        const double height = r.uniform(0.01, 0.9);  // the triangle is this far from its edges, and more
        const double half = length / 2 * (1.0 - height) * 0.9;
        const Vec3 target(length / 2 + r.uniform(-half, half), height, 0.0);
        const double turn = r.uniform(0.0, 2.0 * pi);
        const Vec3 d(std::cos(tilt) * std::cos(turn), std::cos(tilt) * std::sin(turn), -std::sin(tilt));
        const Ray ray{target - distance * d, d};
        const auto hit = tracer.closest_hit(ray);
        if (!hit) return tally.check(false);
        double low = infinity, high = -infinity;
        for (const Vec3& corner : mesh.positions) {
          const double t = glm::dot(corner - ray.origin, d);
          low = std::min(low, t), high = std::max(high, t);
        }
        tally.check(hit->t >= low && hit->t <= high);
        tally.error(std::abs(hit->t - distance));
      },
      "world units", bound);
}

void degenerate_triangles(Run& run) {
  Random random(run.seed());
  Mesh mesh;  // corners on whole numbers: exactly collinear, or the same
  for (std::uint32_t i = 0; i < 64; ++i) {
    const Vec3 a = whole_numbers(random, 9), step = whole_numbers(random, 3);
    const double far = i % 4 == 0 ? 0.0 : 3.0;
    mesh.positions.insert(mesh.positions.end(), {a, a + step, a + far * step});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const SmallWorld w(mesh);
  for (const auto accel : {raytrace::Accel::bvh, raytrace::Accel::brute}) {
    const raytrace::Tracer tracer = run.tracer(w.world(), accel);
    run.sample(accel == raytrace::Accel::bvh ? "bvh" : "brute", run.rays(0.1), [&](Random& r, Tally& tally) {
      const auto& p = mesh.positions[r.below(static_cast<std::uint32_t>(mesh.positions.size()))];
      const Vec3 origin = r.in_box(20.0);
      tally.check(!tracer.closest_hit({origin, p - origin}));
    });
  }
}

void coplanar_ray(Run& run) {
  const SmallWorld w(
      std::vector<Mesh>{quad({-4, -4, 2}, {8, 0, 0}, {0, 8, 0}), quad({-4, 1, -4}, {0, 0, 8}, {8, 0, 0}),
                        quad({3, -4, -4}, {0, 8, 0}, {0, 0, 8})},
      {});
  const raytrace::Tracer bvh = run.tracer(w.world()), brute = run.tracer(w.world(), raytrace::Accel::brute);
  run.sample("in the plane", run.rays(0.5), [&](Random& r, Tally& tally) {
    // Only the ray's own quad is in reach: the interval ends before the others.
    const int a = r.integer(0, 2);
    const std::array<double, 3> height{3.0, 1.0, 2.0};
    Vec3 origin = r.in_box(0.5), d = r.direction();
    origin[a] = height[static_cast<std::size_t>(a)], d[a] = r.coin() ? 0.0 : -0.0;
    const Ray ray{origin, d, {0.0, 0.4}};
    tally.check(!bvh.closest_hit(ray) && !brute.closest_hit(ray) && !bvh.occluded(ray) &&
                !brute.occluded(ray));
  });
  run.sample("the same in every structure", run.rays(0.2), [&](Random& r, Tally& tally) {
    // A point of a triangle and a direction between two others: in its plane but for rounding.
    const auto [a, b, c] = w.world().corners(r.below(w.world().triangle_count()));
    const double u = r.uniform(-1.0, 1.0), v = r.uniform(-1.0, 1.0);
    const Vec3 d = u * (b - a) + v * (c - a);
    const Ray ray{r.nudged(a - 3.0 * d, 1), r.nudged(d, 1)};
    tally.check(same(bvh.closest_hit(ray), brute.closest_hit(ray)));
  });
}

}  // namespace gnomon::verify
