#include "verify/adversarial.h"

#include "verify/rational.h"

namespace gnomon::verify {

namespace {

Vec3 any_size(Random& r) {
  Vec3 v;
  for (int a = 0; a < 3; ++a) {
    const double sign = r.coin() ? 1.0 : -1.0;
    v[a] = sign * r.power_of_ten(-8.0, 8.0);
  }
  if (r.below(8) == 0) v[r.integer(0, 2)] = r.coin() ? 0.0 : -0.0;
  return v;
}

std::vector<Mesh> shadow_scene(std::uint64_t seed) {
  Random random(seed);
  return {quad({-64, 0, -64}, {0, 0, 128}, {128, 0, 0}),
          in_floats(round_mesh({0.0, 1.5, 0.0}, 1.0, 4, 5, 0.1, random))};
}

}  // namespace

AimedTriangle aimed_triangle(Random& r) {
  AimedTriangle t;
  if (r.coin()) {  // every coordinate of its own size
    for (Vec3& corner : t.corners) corner = any_size(r);
  } else {  // a well-shaped triangle somewhere
    const double size = r.power_of_ten(-8.0, 8.0);
    const Vec3 place = r.coin() ? Vec3(0.0) : any_size(r);
    for (Vec3& corner : t.corners) corner = place + r.in_box(size);
  }
  const double s = r.uniform(0.0, 1.0);
  Vec3 aim = t.corners[0];
  switch (r.below(4)) {
    case 0:
      break;
    case 1:
      aim += s * (t.corners[1] - t.corners[0]);
      break;
    case 2:
      aim = (t.corners[0] + t.corners[1] + t.corners[2]) / 3.0;
      break;
    default:
      aim += 0.25 * r.integer(0, 4) * (t.corners[2] - t.corners[0]);
      break;
  }
  aim = r.nudged(aim, 4);
  const Vec3 away = r.direction();
  t.origin = r.coin() ? any_size(r) : aim + away * r.power_of_ten(-4.0, 4.0);
  t.direction = aim - t.origin;
  // Kernels scale a direction by a power of two, which subnormal components do not survive whole.
  for (int a = 0; a < 3; ++a)
    if (std::abs(t.direction[a]) < 1e-300) t.direction[a] = 0.0;
  return t;
}

AdversarialShadows::AdversarialShadows(std::uint64_t seed)
    : world_(shadow_scene(seed), {}),
      finder_(world_.world(), raytrace::Accel::bvh, raytrace::Precision::robust),
      light_(point_light({0.7, 6.0, -0.4})) {}

std::optional<raytrace::SurfacePoint> AdversarialShadows::receiver(Random& r) const {
  constexpr std::uint32_t floor_triangles = 2;
  const std::uint32_t mesh = world().triangle_count() - floor_triangles;
  const auto corners = world().corners(floor_triangles + r.below(mesh));
  const double s = r.below(3) == 0 ? 0.0 : r.uniform(0.0, 1.0);
  const Vec3 d = corners[0] + s * (corners[1] - corners[0]) - light_.position;
  Vec3 foot = r.nudged(light_.position - d * (light_.position.y / d.y), 4);
  foot.y = 0.0;
  const auto point = seen(finder_, foot + Vec3(0.0, 0.01, 0.0), foot);
  if (point.primitive >= floor_triangles) return std::nullopt;
  return point;
}

bool AdversarialShadows::shadowed(const raytrace::SurfacePoint& point) const {
  return rationally_shadowed(world(), point, light_.position);
}

}  // namespace gnomon::verify
