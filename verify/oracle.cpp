#include "verify/cases.h"

#include "verify/quad.h"

namespace gnomon::verify {

namespace {

// How far from an edge (in barycentric units), a tangent or another hit (relative) the oracle still vouches
// for doubles. Coordinates up to 1e2 and triangles from 0.01 on leave 2^-53 * 1e4.
constexpr double margin = 1e-11;

struct Candidate {
  Quad t = 0;
  bool hit = false, doubtful = false;
};

Candidate intersect_triangle(const World& world, std::uint32_t id, const Ray& ray) {
  const auto [a, b, c] = world.corners(id);
  const QuadTriangle r = line_triangle(ray.origin, ray.direction, a, b, c);
  const Quad3 n = cross(Quad3(b) - Quad3(a), Quad3(c) - Quad3(a)), d(ray.direction);
  if (r.det == 0) {  // in the plane: a miss; beside it by less than rounding: anything
    const Quad height = magnitude(dot(n, Quad3(ray.origin) - Quad3(a)));
    return {0, false, height != 0 && height < Quad(margin) * root(dot(n, n))};
  }
  const Quad grazing = magnitude(r.det) / root(dot(n, n) * dot(d, d));
  const bool doubtful = magnitude(r.inside) * grazing < Quad(margin) || magnitude(r.t) < Quad(margin);
  return {r.t, r.inside >= 0 && r.t > 0, doubtful};
}

Candidate intersect_sphere(const Sphere& sphere, const Ray& ray) {
  const QuadRoots r = line_sphere(ray.origin, ray.direction, sphere.center, sphere.radius);
  const Quad3 o = Quad3(ray.origin) - Quad3(sphere.center);
  const bool doubtful =
      magnitude(r.discriminant) < Quad(margin) * r.a * dot(o, o) ||
      magnitude(dot(o, o) - Quad(sphere.radius) * Quad(sphere.radius)) < Quad(margin) * dot(o, o);
  if (r.discriminant < 0) return {0, false, doubtful};
  return {r.near > 0 ? r.near : r.far, r.far > 0, doubtful};
}

}  // namespace

OracleHit oracle_closest(const World& world, const Ray& ray) {
  OracleHit best;
  Quad best_t = 0;
  for (std::uint32_t id = 0; id < world.primitive_count(); ++id) {
    const Candidate c = world.is_triangle(id)
                            ? intersect_triangle(world, id, ray)
                            : intersect_sphere(std::get<Sphere>(world.shape(id).geometry), ray);
    best.doubtful = best.doubtful || c.doubtful;
    if (!c.hit) continue;
    const bool tie =
        best.primitive != no_id && magnitude(c.t - best_t) < Quad(margin) * (1 + magnitude(best_t));
    best.doubtful = best.doubtful || tie;
    if (best.primitive == no_id || c.t < best_t) best_t = c.t, best.primitive = id;
  }
  best.t = static_cast<double>(best_t);
  return best;
}

}  // namespace gnomon::verify
