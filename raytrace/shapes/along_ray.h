// A solid's function along a ray in its local frame: values, slopes and bounds of both over a stretch of the
// ray, and the isolation of its roots.
#pragma once

#include "raytrace/precision/bounds.h"
#include "scene/shapes/solid.h"

namespace gnomon::raytrace {

/// f(origin + s direction), local.
struct AlongRay {
  const ShapeGeometry* solid;
  Vec3 origin, direction;
  Vec3 origin_error{0.0};  ///< componentwise; bounds() holds for all origins within

  double value(double s) const {
    const Vec3 p = origin + s * direction;
    return solid_value(*solid, p.x, p.y, p.z);
  }
  Differential<double, double> slope(double s) const {
    using Number = Differential<double, double>;
    const Vec3 p = origin + s * direction;
    return solid_value(*solid, Number(p.x, direction.x), Number(p.y, direction.y), Number(p.z, direction.z));
  }
  Slope coordinate(int a, const Bounds& s) const {
    const Bounds start(origin[a] - origin_error[a], origin[a] + origin_error[a]);
    return {start + s * Bounds(direction[a]), Bounds(direction[a])};
  }
  Slope bounds(const Bounds& s) const {
    return solid_value(*solid, coordinate(0, s), coordinate(1, s), coordinate(2, s));
  }
};

/// The axes, from this one on, across which a solid is cut by its box; 3: not cut.
inline int first_cut_axis(const ShapeGeometry& solid) {
  if (std::holds_alternative<Torus>(solid)) return 3;
  const auto* quadric = std::get_if<Quadric>(&solid);
  if (quadric == nullptr) return 0;
  return quadric->kind == QuadricKind::ellipsoid ? 3 : 2;
}

/// A closed solid as one function, less than 0 in the body: the greatest of f and the distances over its
/// cuts. Of an open one f alone.
inline Slope body_slope(const ShapeGeometry& solid, const Slope& x, const Slope& y, const Slope& z) {
  Slope h = solid_value(solid, x, y, z);
  if (!is_closed(solid)) return h;
  const std::array<const Slope*, 3> at{&x, &y, &z};
  const Aabb box = local_box(solid);
  for (int a = first_cut_axis(solid); a < 3; ++a) {
    const Slope& p = *at[static_cast<std::size_t>(a)];
    h = maximum(h, maximum(p - Slope(box.max[a]), Slope(box.min[a]) - p));
  }
  return h;
}

/// The root between lo and hi, where f has the values of different sign (or 0 at hi), to the last place that
/// f resolves. Newton's step where it stays inside, else halving; bounded by 200 steps.
double solve_between(const AlongRay& f, double lo, double hi, double f_lo);

/// Calls visit(s) for the roots in (lo, hi], ascending, until it returns true; returns whether it did.
/// Marches in stretches that are doubled and halved as needed. A stretch has no root when f's bounds leave
/// out 0; it has at most one, told by the signs at its ends, when the slope's bounds do (Mitchell 1990). What
/// is left when a stretch is down to the rounding of f itself, or to 2^-44 of the whole, is a root, a touch. For
/// f cannot be told from 0 there. So no root is skipped, except pairs closer than 2^-44 of the whole; a near
/// miss may count as a touch only where rounding cannot tell. Poles are no roots. After max_stretches the rest
/// counts as empty.
inline constexpr int max_stretches = 1 << 16;
template <class Visit>
bool isolate_roots(const AlongRay& f, double lo, double hi, const Visit& visit) {
  constexpr double first_share = 0x1p-3, least_share = 0x1p-44;
  const double longest = (hi - lo) * first_share, least = (hi - lo) * least_share;
  double step = longest, at = lo, f_at = f.value(lo);
  bool touching = false;
  for (int n = 0; n < max_stretches && at < hi; ++n) {
    const double end = at + step < hi ? at + step : hi;
    if (!(end > at)) break;
    const Slope s = f.bounds(Bounds(at, end));
    const auto advance = [&](double f_end) {
      at = end, f_at = f_end;
      step = std::min(2.0 * step, longest);
    };
    if (s.value.is_empty() || s.value.without_zero()) {
      touching = false;
      advance(f.value(end));
    } else if (s.value.sure && s.change.without_zero()) {
      const double f_end = f.value(end);
      const bool crosses = (f_at < 0.0 && f_end >= 0.0) || (f_at > 0.0 && f_end <= 0.0);
      if (crosses && !touching && visit(solve_between(f, at, end, f_at))) return true;
      touching = false;
      advance(f_end);
    } else {
      const double middle = at + 0.5 * (end - at);
      const Bounds here = f.bounds(Bounds(middle)).value;
      const bool rounding = !here.without_zero() && s.value.width() <= 4.0 * here.width();
      if (!rounding && step > least) {
        step *= 0.5;
        continue;
      }
      const double f_end = f.value(end);
      const bool touches = s.value.sure;  // nothing finer tells f from 0
      if (touches && !touching && visit(middle)) return true;
      touching = touches;
      advance(f_end);
    }
  }
  return false;
}

}  // namespace gnomon::raytrace
