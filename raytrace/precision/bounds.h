// Interval arithmetic: numbers known to lie between two doubles (Moore 1966, "Interval Analysis"), with every
// result rounded outwards. The functions that expressions need (scene/shapes/expression.h) are here, and the
// derivative of each. So a function can be bounded together with its slope along a ray (Mitchell 1990,
// "Robust ray intersection with interval arithmetic", Graphics Interface).
//
// `sure` says that the value exists and is continuous for all arguments; where it is not set (the root of a
// negative number, a pole), the ends hold for those arguments that have a value. Nothing at all: empty.
#pragma once

#include <cfloat>

#include "scene/math.h"
#include "scene/shapes/expression.h"

namespace gnomon::raytrace {

struct Bounds {
  double lo, hi;
  bool sure;

  Bounds() = default;
  explicit Bounds(double exact) : lo(exact), hi(exact), sure(true) {}
  Bounds(double low, double high, bool is_sure = true) : lo(low), hi(high), sure(is_sure) {}

  static Bounds empty() { return {infinity, -infinity, false}; }
  static Bounds anything() { return {-infinity, infinity, false}; }
  bool is_empty() const { return lo > hi; }
  bool positive() const { return lo > 0.0; }
  bool negative() const { return hi < 0.0; }
  bool without_zero() const { return positive() || negative(); }
  double width() const { return hi - lo; }
};

// A correctly rounded result is off by half a unit in its last place; these give way by at least one.
inline double rounded_down(double v) {
  return v - (std::abs(v) * DBL_EPSILON + std::numeric_limits<double>::denorm_min());
}
inline double rounded_up(double v) {
  return v + (std::abs(v) * DBL_EPSILON + std::numeric_limits<double>::denorm_min());
}
inline Bounds outward(double lo, double hi, bool sure) {
  if (std::isnan(lo) || std::isnan(hi)) return Bounds::anything();
  return {std::isinf(lo) ? lo : rounded_down(lo), std::isinf(hi) ? hi : rounded_up(hi), sure};
}
/// Bounds the result of a library function, which is within two units in the last place.
inline Bounds outward_twice(double lo, double hi, bool sure) {
  const Bounds once = outward(lo, hi, sure);
  return outward(rounded_down(once.lo), rounded_up(once.hi), sure);
}

inline Bounds operator-(const Bounds& a) {
  return {-a.hi, -a.lo, a.sure};
}
inline Bounds operator+(const Bounds& a, const Bounds& b) {
  if (a.is_empty() || b.is_empty()) return Bounds::empty();
  return outward(a.lo + b.lo, a.hi + b.hi, a.sure && b.sure);
}
inline Bounds operator-(const Bounds& a, const Bounds& b) {
  return a + -b;
}
inline Bounds operator*(const Bounds& a, const Bounds& b) {
  if (a.is_empty() || b.is_empty()) return Bounds::empty();
  const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
  if (std::isnan(p + q + r + s)) return Bounds::anything();
  return outward(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)),
                 a.sure && b.sure);
}
inline Bounds inverse(const Bounds& b) {
  if (b.is_empty()) return b;
  if (b.without_zero()) return outward(1.0 / b.hi, 1.0 / b.lo, b.sure);
  if (b.lo == 0.0 && b.hi > 0.0) return outward(1.0 / b.hi, infinity, false);
  if (b.hi == 0.0 && b.lo < 0.0) return outward(-infinity, 1.0 / b.lo, false);
  return b.lo == 0.0 ? Bounds::empty() : Bounds::anything();
}
inline Bounds operator/(const Bounds& a, const Bounds& b) {
  return a * inverse(b);
}

inline Bounds whole_power(const Bounds& a, int n) {
  if (a.is_empty()) return a;
  if (n == 0) return Bounds(1.0);
  if (n < 0) return inverse(whole_power(a, -n));
  if (n == 1) return a;
  const double low = std::min(std::abs(a.lo), std::abs(a.hi)),
               high = std::max(std::abs(a.lo), std::abs(a.hi));
  // Repeated products of numbers of one sign: monotone, each step rounded outwards.
  Bounds size(1.0), factor(a.without_zero() ? low : 0.0, high);
  const auto times = [](const Bounds& p, const Bounds& q) { return outward(p.lo * q.lo, p.hi * q.hi, true); };
  for (unsigned k = static_cast<unsigned>(n); k != 0; k >>= 1) {
    if (k & 1) size = times(size, factor);
    if (k > 1) factor = times(factor, factor);
  }
  size.lo = std::max(size.lo, 0.0);
  size.sure = a.sure;
  if (n % 2 == 0) return size;
  if (a.lo >= 0.0) return size;
  if (a.hi <= 0.0) return -size;
  const Bounds below = whole_power(Bounds(a.lo, a.lo), n), above = whole_power(Bounds(a.hi, a.hi), n);
  return {below.lo, above.hi, a.sure};
}

inline Bounds square_root(const Bounds& a) {
  if (a.is_empty() || a.hi < 0.0) return Bounds::empty();
  const bool whole = a.lo >= 0.0;
  Bounds root = outward(std::sqrt(std::max(a.lo, 0.0)), std::sqrt(a.hi), a.sure && whole);
  root.lo = std::max(root.lo, 0.0);
  return root;
}
inline Bounds absolute(const Bounds& a) {
  if (a.is_empty() || a.lo >= 0.0) return a;
  if (a.hi <= 0.0) return -a;
  return {0.0, std::max(-a.lo, a.hi), a.sure};
}
inline Bounds minimum(const Bounds& a, const Bounds& b) {
  if (a.is_empty() || b.is_empty()) return Bounds::empty();
  return {std::min(a.lo, b.lo), std::min(a.hi, b.hi), a.sure && b.sure};
}
inline Bounds maximum(const Bounds& a, const Bounds& b) {
  if (a.is_empty() || b.is_empty()) return Bounds::empty();
  return {std::max(a.lo, b.lo), std::max(a.hi, b.hi), a.sure && b.sure};
}
inline Bounds exponential(const Bounds& a) {
  if (a.is_empty()) return a;
  Bounds power = outward_twice(std::exp(a.lo), std::exp(a.hi), a.sure && std::isfinite(std::exp(a.hi)));
  power.lo = std::max(power.lo, 0.0);
  return power;
}
inline Bounds logarithm(const Bounds& a) {
  if (a.is_empty() || a.hi <= 0.0) return Bounds::empty();
  const bool whole = a.lo > 0.0;
  return outward_twice(whole ? std::log(a.lo) : -infinity, std::log(a.hi), a.sure && whole);
}

/// The sine of an interval given in turns and in radians: whether a crest (at `phase` of a turn) lies within
/// is decided with the turns' own rounding given away.
inline bool holds_whole(double from, double to) {
  return std::floor(to) >= std::ceil(from);
}
inline Bounds wave(const Bounds& a, double crest_turn, double at_lo, double at_hi) {
  if (!(std::abs(a.lo) < 1e9 && std::abs(a.hi) < 1e9)) return {-1.0, 1.0, a.sure};  // phase mostly rounding
  const double lo = a.lo / (2.0 * pi) - 1e-6, hi = a.hi / (2.0 * pi) + 1e-6;
  Bounds value = outward_twice(std::min(at_lo, at_hi), std::max(at_lo, at_hi), a.sure);
  if (holds_whole(lo - crest_turn, hi - crest_turn)) value.hi = 1.0;
  if (holds_whole(lo - crest_turn - 0.5, hi - crest_turn - 0.5)) value.lo = -1.0;
  value.lo = std::max(value.lo, -1.0), value.hi = std::min(value.hi, 1.0);
  return value;
}
inline Bounds sine(const Bounds& a) {
  return a.is_empty() ? a : wave(a, 0.25, std::sin(a.lo), std::sin(a.hi));
}
inline Bounds cosine(const Bounds& a) {
  return a.is_empty() ? a : wave(a, 0.0, std::cos(a.lo), std::cos(a.hi));
}

/// exp(b log a): a > 0, or a = 0 with b > 0.
inline Bounds real_power(const Bounds& a, const Bounds& b) {
  if (a.is_empty() || b.is_empty() || a.hi < 0.0) return Bounds::empty();
  if (a.positive()) return exponential(b * logarithm(a));
  if (!b.positive()) return {0.0, infinity, false};
  const Bounds at_high = a.hi > 0.0 ? exponential(b * logarithm(Bounds(a.hi))) : Bounds(0.0);
  return {0.0, std::max(at_high.hi, 0.0), a.sure && b.sure && a.lo >= 0.0};
}

/// A function's bounds and those of its slope along a ray.
using Slope = Differential<Bounds, Bounds>;

inline Slope absolute(const Slope& a) {
  if (a.value.lo >= 0.0) return a;
  if (a.value.hi <= 0.0) return -a;
  return {absolute(a.value), Bounds(-1.0, 1.0) * a.change};
}
inline Bounds hull(const Bounds& a, const Bounds& b) {
  if (a.is_empty()) return b;
  if (b.is_empty()) return a;
  return {std::min(a.lo, b.lo), std::max(a.hi, b.hi), a.sure && b.sure};
}
/// Bounds a function's values on a stretch by its mean value form, too. That helps where the bounds of its terms
/// add up though the terms cancel (Moore, Kearfott and Cloud 2009, "Introduction to Interval Analysis", section
/// 6.3). `middle`: its values at a place of the stretch; `offset`: of the stretch from there.
inline Bounds narrowed(const Slope& stretch, const Bounds& middle, const Bounds& offset) {
  if (!(stretch.value.sure && middle.sure)) return stretch.value;
  const Bounds mean = middle + stretch.change * offset;
  return {std::max(stretch.value.lo, mean.lo), std::min(stretch.value.hi, mean.hi), true};
}

inline Slope minimum(const Slope& a, const Slope& b) {
  if (a.value.hi < b.value.lo) return a;
  if (b.value.hi < a.value.lo) return b;
  return {minimum(a.value, b.value), hull(a.change, b.change)};
}
inline Slope maximum(const Slope& a, const Slope& b) {
  return -minimum(-a, -b);
}

}  // namespace gnomon::raytrace
