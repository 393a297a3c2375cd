// A solid's function along a ray in its local frame: values, slopes and bounds of both over a stretch of the
// ray, and the isolation of its roots.
#pragma once

#include "raytrace/bounds.h"
#include "scene/solid.h"

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
  Slope bounds(const Bounds& s) const {
    const auto at = [&](int a) {
      const Bounds start(origin[a] - origin_error[a], origin[a] + origin_error[a]);
      return Slope(start + s * Bounds(direction[a]), Bounds(direction[a]));
    };
    return solid_value(*solid, at(0), at(1), at(2));
  }
};

/// The root between lo and hi, where f has the values of different sign (or 0 at hi), to the last place that
/// f resolves. Newton's step where it stays inside, else halving; bounded by 200 steps.
double solve_between(const AlongRay& f, double lo, double hi, double f_lo);

/// Calls visit(s) for the roots in (lo, hi], ascending, until it returns true; returns whether it did.
/// Marches in stretches that are doubled and halved as needed. A stretch has no root when f's bounds leave
/// out 0; it has at most one, told by the signs at its ends, when the slope's bounds do (Mitchell 1990). What
/// is left when a stretch is down to the rounding of f itself, or to 2^-44 of the whole, is a root if f
/// changes sign there or cannot be told from 0: a touch. So no root is skipped, except pairs closer than
/// 2^-44 of the whole; a near miss may count as a touch only where rounding cannot tell. Poles are no roots.
/// After max_stretches the rest counts as empty.
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
      const bool crosses = s.value.sure && ((f_at < 0.0) != (f_end < 0.0));
      const bool touches = s.value.sure;  // nothing finer tells f from 0
      if ((crosses || touches) && !touching && visit(middle)) return true;
      touching = crosses || touches;
      advance(f_end);
    }
  }
  return false;
}

}  // namespace gnomon::raytrace
