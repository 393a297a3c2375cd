// Single triangles and shadows against rational numbers, on rays aimed at corners and edges.
#include "raytrace/kernels.h"
#include "raytrace/precision/exact.h"
#include "raytrace/precision/fast.h"
#include "verify/adversarial.h"
#include "verify/cases.h"
#include "verify/rational.h"

namespace gnomon::verify {

namespace {

using raytrace::PointVisibility;
using raytrace::Precision;

/// One triangle through the kernels' own test.
template <class Arithmetic>
bool meets(const raytrace::Structures& s, const raytrace::RayFrame& ray) {
  raytrace::Hit hit;
  return Arithmetic(s, ray).leaf(s, ray, 0, hit);
}

/// Next to a huge triangle the sign of t itself is a matter of rounding: only the exact test is asked for it.
Interval interval(Precision precision) {
  return {precision == Precision::exact ? 0.0 : -infinity, infinity};
}

}  // namespace

bool kernel_meets(Precision precision, const AimedTriangle& t) {
  World world;
  for (const Vec3& corner : t.corners) world.finite_bounds.grow(corner);
  raytrace::Structures s;
  s.world = &world;
  raytrace::LeafPrimitive p{};
  for (std::size_t i = 0; i < 9; ++i) p.v[i] = t.corners[i / 3][static_cast<int>(i % 3)];
  s.bvh.primitives = raytrace::LeafPrimitives({&p, 1}), s.bvh.ids = {0};
  const auto frame = raytrace::make_ray_frame({t.origin, t.direction, interval(precision)});
  if (!frame) return false;
  switch (precision) {
    case Precision::fast:
      s.fast = {raytrace::fast_primitive(p, true)};
      return meets<raytrace::FastArithmetic>(s, *frame);
    case Precision::exact:
      return meets<raytrace::ExactArithmetic>(s, *frame);
    case Precision::robust:
      break;
  }
  return meets<raytrace::RobustArithmetic>(s, *frame);
}

double roundings_from_edge(const AimedTriangle& t, const RationalTriangle& truth) {
  double reach = 0.0, size = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    reach = std::max(reach, raytrace::max_component(glm::abs(t.corners[i] - t.origin)));
    size = std::max(size, glm::length(t.corners[i] - t.corners[(i + 1) % 3]));
  }
  const double largest = raytrace::max_component(glm::abs(t.direction));
  return std::abs(truth.inside) * std::abs(truth.slope) / (largest * size * reach * raytrace::unit_roundoff);
}

void triangles_by_rationals(Run& run) {
  // Rounding is no error of the robust test, which promises closed meshes, not exact triangles.
  const bool exact = run.precision() == Precision::exact;
  const double bound = exact ? 0.0 : roundings_of_an_edge;
  run.sample(
      "triangles against rationals", std::max(run.rays(0.1, 10'000'000), std::uint64_t{100'000}),
      [&](Random& r, Tally& tally) {
        const AimedTriangle t = aimed_triangle(r);
        const RationalTriangle truth = rational_triangle(t.origin, t.direction, t.corners);
        if (kernel_meets(run.precision(), t) == (truth.meets && (truth.ahead || !exact)))
          return tally.check(true);
        const double off = exact ? 1.0 : roundings_from_edge(t, truth);
        tally.error(off);
        tally.check(off <= bound);
      },
      "roundings from the edge", bound);
}

void shadows_by_rationals(Run& run) {
  const AdversarialShadows shadows(run.seed());
  const raytrace::Tracer tracer = run.tracer(shadows.world());
  const bool exact = run.precision() == Precision::exact;
  run.sample("shadows against rationals", run.rays(0.1, 10'000'000), [&](Random& r, Tally& tally) {
    const auto point = shadows.receiver(r);
    if (!point) return;
    const PointVisibility visibility = tracer.centre_visibility(*point, shadows.light());
    const PointVisibility truth = shadows.shadowed(*point) ? PointVisibility::shadowed : PointVisibility::lit;
    tally.check(visibility == truth || (!exact && visibility == PointVisibility::uncertain));
  });
}

}  // namespace gnomon::verify
