// Triangles a million times as long as wide, of which two lie so close together that the mean of the corners'
// depths does not know which comes first.
#include "raytrace/precision/exact.h"
#include "verify/cases.h"
#include "verify/rational.h"
#include "verify/small_world.h"

namespace gnomon::verify {

namespace {

using raytrace::Accel;
using raytrace::Precision;

constexpr double sheet_length = 1e6;

struct TwoSheets {
  SmallWorld world;
  double gap;
  Vec3 up, along, across;
};

/// Two rectangles, sheet_length x 1, the second `gap` above the first, in a frame turned by `turn`.
TwoSheets two_sheets(double gap, double turn) {
  const Vec3 along = glm::normalize(Vec3(std::cos(turn), 0.3 * std::sin(turn), std::sin(turn)));
  const Vec3 across = glm::normalize(glm::cross(along, Vec3(0.0, 1.0, 0.0)));
  const Vec3 up = glm::cross(across, along), corner = -0.5 * sheet_length * along - 0.5 * across;
  return {SmallWorld({quad(corner, sheet_length * along, across),
                      quad(corner + gap * up, sheet_length * along, across)},
                     {}),
          gap, up, along, across};
}

/// Rays from above to a place of the upper sheet that is far enough from its border for the lower one to be
/// met behind it.
void nearer_sheet(Run& run, const std::string& name, double gap, double turn) {
  const TwoSheets s = two_sheets(gap, turn);
  const auto bvh = run.tracer(s.world.world()), brute = run.tracer(s.world.world(), Accel::brute);
  const auto octree = run.tracer(s.world.world(), Accel::octree),
             kd = run.tracer(s.world.world(), Accel::kdtree);
  run.sample("the nearer of two sheets, " + name, run.rays(0.1), [&](Random& r, Tally& tally) {
    const double u = 0.4 * sheet_length * r.uniform(-1.0, 1.0), v = r.uniform(-0.4, 0.4);
    const Vec3 target = u * s.along + v * s.across + s.gap * s.up;
    const double height = r.power_of_ten(0.0, 6.0), along = sheet_length * r.uniform(-1.0, 1.0);
    const Vec3 way = height * s.up + along * s.along + r.uniform(-1.0, 1.0) * s.across;
    const Ray ray{target + way, -way};
    const auto hit = bvh.closest_hit(ray);
    tally.check((!hit || hit->primitive >= 2) && same(hit, brute.closest_hit(ray)) &&
                same(hit, octree.closest_hit(ray)) && same(hit, kd.closest_hit(ray)));
  });
}

/// A triangle and a copy whose corners are moved by a few representable numbers, and a line through both.
struct ClosePair {
  std::array<std::array<Vec3, 3>, 2> corners;
  Vec3 origin, direction;
};

ClosePair close_pair(Random& r) {
  ClosePair p;
  auto& [one, other] = p.corners;
  const double width = r.power_of_ten(-6.0, 0.0);
  one = {r.in_box(1.0), r.in_box(1.0), {}};
  const double share = r.uniform(0.0, 1.0);
  one[2] = one[0] + share * (one[1] - one[0]) + width * r.in_box(1.0);
  for (std::size_t i = 0; i < 3; ++i) other[i] = r.nudged(one[i], 1);
  p.origin = r.in_box(10.0);
  const double u = r.uniform(0.2, 0.4), v = r.uniform(0.2, 0.4);
  p.direction = (1.0 - u - v) * one[0] + u * one[1] + v * one[2] - p.origin;
  return p;
}

/// Which of the two the exact kernel calls the nearest; no_id where it meets none.
std::uint32_t nearest_of(const ClosePair& pair) {
  World world;
  raytrace::Structures s;
  s.world = &world;
  std::array<raytrace::LeafPrimitive, 2> primitives{};
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t i = 0; i < 9; ++i) primitives[k].v[i] = pair.corners[k][i / 3][static_cast<int>(i % 3)];
  s.bvh.primitives = raytrace::LeafPrimitives(primitives);
  s.bvh.ids = {0, 1};
  const auto frame = raytrace::make_ray_frame({pair.origin, pair.direction});
  if (!frame) return no_id;
  const auto hit = raytrace::closest_reported<false, raytrace::ExactArithmetic>(
      s, *frame, no_id, [](const raytrace::RayFrame&, const auto& visit) { visit(0), visit(1); });
  return hit ? hit->primitive : no_id;
}

void order_by_rationals(Run& run) {
  run.sample("the order of two triangles one rounding apart", run.rays(1.0), [&](Random& r, Tally& tally) {
    const ClosePair pair = close_pair(r);
    const auto& [one, other] = pair.corners;
    if (!rational_triangle(pair.origin, pair.direction, one).meets ||
        !rational_triangle(pair.origin, pair.direction, other).meets)
      return;
    const int order = rational_order(pair.origin, pair.direction, one, other);
    tally.check(nearest_of(pair) == (order <= 0 ? 0u : 1u));
  });
}

}  // namespace

void stretched_triangles(Run& run) {
  nearer_sheet(run, "axis-parallel", 1e-6, 0.0);
  nearer_sheet(run, "turned", 1e-6, 0.7);
  nearer_sheet(run, "turned, 1e-5 apart", 1e-5, 2.1);
  if (run.precision() == Precision::exact) order_by_rationals(run);
}

}  // namespace gnomon::verify
