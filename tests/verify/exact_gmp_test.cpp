// Precision::exact's test of a triangle against rational numbers (GMP), which share nothing with it:
// Moeller and Trumbore's formulas without rounding. The triangles and rays are made to be hard.
//   exact_gmp_test [COUNT [SEED]]     COUNT triangles of all kinds together; 2e5 unless told, 1e7 takes
//   minutes
// Prints a line for each kind: how many were tried, how many are met, how many of the robust kernel's answers
// rounding has turned (no error of that kernel's, but a sign that the triangles are hard), and how many of
// the exact ones are wrong. Fails when any is, or when a kind is not hard or never met.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cstdlib>

#include "raytrace/precision/error_bounds.h"
#include "verify/adversarial.h"
#include "verify/rational.h"

namespace gnomon::verify {
namespace {

using raytrace::Precision;

constexpr double least_subnormal = 4.9406564584124654e-324;

Vec3 whole(Random& r, int reach) {
  Vec3 v;
  for (int a = 0; a < 3; ++a) v[a] = r.integer(-reach, reach);
  return v;
}

/// A point of the first edge, a corner or a point inside, as a sum of quarters: exact for whole numbers.
Vec3 quarter_point(Random& r, const std::array<Vec3, 3>& c) {
  const std::size_t k = r.below(3);
  const Vec3 u = c[(k + 1) % 3] - c[k], v = c[(k + 2) % 3] - c[k];
  const double s = 0.25 * r.integer(-1, 5), t = r.below(3) == 0 ? 0.25 * r.integer(0, 4) : 0.0;
  return c[k] + s * u + t * v;
}

/// Kernels scale a direction by a power of two, which components far below the largest do not survive whole.
void aim_at(AimedTriangle& t, const Vec3& aim) {
  t.direction = aim - t.origin;
  const double largest = raytrace::max_component(glm::abs(t.direction));
  for (int a = 0; a < 3; ++a)
    if (std::abs(t.direction[a]) < 1e-290 * largest) t.direction[a] = 0.0;
}

Vec3 near_quarter_point(Random& r, const std::array<Vec3, 3>& c) {
  const Vec3 point = quarter_point(r, c);
  return r.nudged(point, r.coin() ? 0 : 1);
}

AimedTriangle corners_and_edges(Random& r) {
  AimedTriangle t;
  for (Vec3& corner : t.corners) corner = 4.0 * whole(r, 8);
  t.origin = whole(r, 50);
  aim_at(t, near_quarter_point(r, t.corners));
  return t;
}

AimedTriangle coplanar(Random& r) {
  AimedTriangle t;
  for (Vec3& corner : t.corners) corner = 4.0 * whole(r, 8);
  const Vec3 u = t.corners[1] - t.corners[0], v = t.corners[2] - t.corners[0];
  const double along_u = r.integer(-3, 3), along_v = r.integer(-3, 3);
  t.origin = t.corners[0] + along_u * u + along_v * v;
  if (r.coin()) t.origin = r.nudged(t.origin, 1);
  aim_at(t, near_quarter_point(r, t.corners));
  return t;
}

AimedTriangle sliver(Random& r) {
  AimedTriangle t;
  const double size = r.power_of_ten(-3.0, 3.0);
  t.corners[0] = r.in_box(size), t.corners[1] = r.in_box(size);
  t.corners[2] = r.nudged(t.corners[0] + r.uniform(-0.2, 1.2) * (t.corners[1] - t.corners[0]), 3);
  t.origin = r.in_box(10.0 * size);
  aim_at(t, r.nudged(quarter_point(r, t.corners), 2));
  return t;
}

/// Makes a triangle as many units in the last place wide as others are units.
AimedTriangle far_away(Random& r) {
  constexpr double place = 0x1p45, unit = 0x1p-7;
  AimedTriangle t = r.coin() ? corners_and_edges(r) : coplanar(r);
  const Vec3 offset = place * (Vec3(1.0) + 0.125 * whole(r, 4));
  const Vec3 aim = t.origin + t.direction;
  for (Vec3& corner : t.corners) corner = offset + unit * corner;
  t.origin = offset + unit * t.origin;
  aim_at(t, offset + unit * aim);
  return t;
}

AimedTriangle scaled(AimedTriangle t, int exponent) {
  const double scale = std::ldexp(1.0, exponent);
  const Vec3 aim = scale * (t.origin + t.direction);
  for (Vec3& corner : t.corners) corner *= scale;
  t.origin *= scale;
  aim_at(t, aim);
  return t;
}

AimedTriangle any_of(Random& r) {
  switch (r.below(3)) {
    case 0:
      return corners_and_edges(r);
    case 1:
      return coplanar(r);
    default:
      return sliver(r);
  }
}

/// Down to where every product, and at last every difference, is subnormal.
AimedTriangle tiny(Random& r) {
  const AimedTriangle t = any_of(r);
  return scaled(t, -r.integer(100, 1060));
}

AimedTriangle huge(Random& r) {
  const AimedTriangle t = any_of(r);
  return scaled(t, r.integer(100, 330));
}

/// Makes a triangle of ordinary size, but for zeros that are not quite: a few of the least subnormal numbers.
AimedTriangle nearly_zero(Random& r) {
  AimedTriangle t;
  const auto blur = [&](Vec3 p) {
    for (int a = 0; a < 3; ++a)
      if (p[a] == 0.0) p[a] = r.integer(-3, 3) * least_subnormal;
    return p;
  };
  const int flat = r.integer(0, 2);  // all in a plane through the origin, but for that
  const auto point = [&](int reach) {
    Vec3 p = 4.0 * whole(r, reach);
    p[flat] = 0.0;
    return p;
  };
  for (Vec3& corner : t.corners) corner = point(2);
  t.origin = point(2);
  if (r.coin()) t.origin[flat] = r.integer(-2, 2);
  const Vec3 aim = quarter_point(r, t.corners);
  for (Vec3& corner : t.corners) corner = blur(corner);
  t.origin = blur(t.origin);
  aim_at(t, blur(aim));
  return t;
}

struct Kind {
  const char* name;
  AimedTriangle (*make)(Random&);
};
constexpr std::array<Kind, 8> kinds{{{"coordinates of all sizes", aimed_triangle},
                                     {"corners and edges", corners_and_edges},
                                     {"rays in the plane", coplanar},
                                     {"slivers", sliver},
                                     {"far from the origin", far_away},
                                     {"tiny", tiny},
                                     {"huge", huge},
                                     {"nearly zero", nearly_zero}}};

struct Counts {
  std::atomic<std::uint64_t> tried = 0, met = 0, turned = 0, wrong = 0;
};

void print_case(const char* kind, const AimedTriangle& t, bool met) {
  fmt::print(stderr, "{}: exact is wrong, the rationals say {}\n", kind, met ? "met" : "missed");
  for (const Vec3& p : {t.corners[0], t.corners[1], t.corners[2], t.origin, t.direction})
    fmt::print(stderr, "  {:a} {:a} {:a}\n", p.x, p.y, p.z);
}

void try_one(const Kind& kind, Random& random, Counts& counts) {
  const AimedTriangle t = kind.make(random);
  if (t.direction == Vec3(0.0)) return;
  const RationalTriangle truth = rational_triangle(t.origin, t.direction, t.corners);
  const bool met = truth.meets && truth.ahead;
  ++counts.tried, counts.met += met ? 1 : 0;
  // The robust kernel is asked about the whole line.
  if (kernel_meets(Precision::robust, t) != truth.meets) ++counts.turned;
  if (kernel_meets(Precision::exact, t) == met) return;
  if (counts.wrong++ < 3) print_case(kind.name, t, met);
}

bool run_kind(std::size_t k, std::uint64_t count, std::uint64_t seed) {
  constexpr std::uint64_t block = 1024;
  Counts counts;
  tbb::parallel_for(std::uint64_t{0}, (count + block - 1) / block, [&](std::uint64_t b) {
    Random random(Random(seed + 1000003u * k).next() + b);
    for (std::uint64_t i = b * block; i < std::min(count, (b + 1) * block); ++i)
      try_one(kinds[k], random, counts);
  });
  const bool hard = counts.turned > 0 && counts.met > counts.tried / 50;
  fmt::print("{:<26}{:>10} tried{:>10} met{:>9} turned by rounding{:>4} wrong{}\n", kinds[k].name,
             counts.tried.load(), counts.met.load(), counts.turned.load(), counts.wrong.load(),
             hard ? "" : "   NOT HARD");
  return hard && counts.wrong == 0;
}

int run(std::uint64_t count, std::uint64_t seed) {
  bool right = true;
  for (std::size_t k = 0; k < kinds.size(); ++k) right = run_kind(k, count / kinds.size(), seed) && right;
  return right ? 0 : 1;
}

}  // namespace
}  // namespace gnomon::verify

int main(int argc, char** argv) {
  const double count = argc > 1 ? std::strtod(argv[1], nullptr) : 2e5;
  const unsigned long long seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  if (!(count >= 1.0 && count <= 1e12)) return 2;
  return gnomon::verify::run(static_cast<std::uint64_t>(count), seed);
}
