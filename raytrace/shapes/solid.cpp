#include "raytrace/shapes/solid.h"

#include <array>

#include "raytrace/shapes/along_ray.h"

namespace gnomon::raytrace {
namespace {

/// A few numbers in ascending order.
struct Few {
  std::array<double, 8> at;
  std::size_t count = 0;
  void add(double v) { at[count++] = v; }
};

/// The part of a line for which something holds.
struct Stretch {
  double begin, end;
};

/// Where f <= 0 along the line: f = a s^2 + 2 b s + c. At most two stretches.
std::size_t below_zero(double a, double b, double c, std::array<Stretch, 2>& out) {
  const double discriminant = b * b - a * c;
  if (!(discriminant > 0.0)) {  // no change of sign; a touch from outside is no stretch
    if (!(c < 0.0 || a < 0.0)) return 0;
    out[0] = {-infinity, infinity};
    return 1;
  }
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  const double r = q / a, s = c / q;  // r is infinite where a = 0
  if (a == 0.0) {
    out[0] = b > 0.0 ? Stretch{-infinity, s} : Stretch{s, infinity};
    return 1;
  }
  const double low = std::min(r, s), high = std::max(r, s);
  if (a > 0.0) {
    out[0] = {low, high};
    return 1;
  }
  out = {Stretch{-infinity, low}, Stretch{high, infinity}};
  return 2;
}

void quadric_crossings(const Quadric& q, const LocalRay& ray, Few& out) {
  const Vec3& d = ray.direction;
  const double nearest = -glm::dot(ray.origin - q.box.center(), d) / glm::dot(d, d);
  const Vec3 o = ray.origin + nearest * d;
  const double a = q.xx * d.x * d.x + q.yy * d.y * d.y + q.zz * d.z * d.z;
  const double b = q.xx * o.x * d.x + q.yy * o.y * d.y + q.zz * o.z * d.z + 0.5 * q.z * d.z;
  const double c = quadric_value(q, o.x, o.y, o.z);
  std::array<Stretch, 2> body{};
  const std::size_t parts = below_zero(a, b, c, body);
  const bool cut = q.kind != QuadricKind::ellipsoid;
  Interval slab{-infinity, infinity};
  if (cut && d.z != 0.0) {
    const double low = (q.box.min.z - o.z) / d.z, high = (q.box.max.z - o.z) / d.z;
    slab = {std::min(low, high), std::max(low, high)};
  } else if (cut && !(o.z >= q.box.min.z && o.z <= q.box.max.z)) {
    return;
  }
  for (std::size_t i = 0; i < parts; ++i) {
    if (q.closed) {
      const double begin = std::max(body[i].begin, slab.min), end = std::min(body[i].end, slab.max);
      if (begin < end && std::isfinite(begin)) out.add(nearest + begin);
      if (begin < end && std::isfinite(end)) out.add(nearest + end);
    } else {
      for (const double s : {body[i].begin, body[i].end})
        if (std::isfinite(s) && slab.contains(s)) out.add(nearest + s);
    }
  }
}

/// A polynomial's coefficients from the constant up.
template <std::size_t degree>
using Polynomial = std::array<double, degree + 1>;

template <std::size_t size>
double horner(const std::array<double, size>& p, double s) {
  double value = 0.0;
  for (std::size_t i = size; i-- > 0;) value = value * s + p[i];
  return value;
}
template <std::size_t size>
std::array<double, size - 1> derivative(const std::array<double, size>& p) {
  std::array<double, size - 1> out{};
  for (std::size_t i = 1; i < size; ++i) out[i - 1] = static_cast<double>(i) * p[i];
  return out;
}

/// Plain halving: it cannot fail, and only places to look at depend on it.
template <class Function>
double halve(const Function& f, double lo, double hi, bool low_is_negative) {
  constexpr int halvings = 56;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (lo + hi);
    ((f(middle) < 0.0) == low_is_negative ? lo : hi) = middle;
  }
  return 0.5 * (lo + hi);
}

/// Where a polynomial changes sign in (lo, hi): between the places where its derivative does.
template <std::size_t size>
void sign_changes(const std::array<double, size>& p, double lo, double hi, Few& out) {
  Few ends;
  ends.add(lo);
  if constexpr (size > 2) sign_changes(derivative(p), lo, hi, ends);
  ends.add(hi);
  for (std::size_t i = 0; i + 1 < ends.count; ++i) {
    const double a = ends.at[i], b = ends.at[i + 1];
    const bool negative = horner(p, a) < 0.0;
    if (negative != (horner(p, b) < 0.0))
      out.add(halve([&](double s) { return horner(p, s); }, a, b, negative));
  }
}

void torus_crossings(const ShapeGeometry& solid, const LocalRay& ray, Few& out) {
  const Torus& torus = std::get<Torus>(solid);
  const Vec3& d = ray.direction;
  const double dd = glm::dot(d, d), nearest = -glm::dot(ray.origin, d) / dd;
  const Vec3 o = ray.origin + nearest * d;
  const double reach = (torus.major + torus.minor) * (1.0 + error_gamma(64));
  const double scratch = reach * reach - glm::dot(o, o);
  if (!(scratch > 0.0)) return;
  const double half = std::sqrt(scratch / dd);
  // g = |p|^2 + R^2 - r^2 and h = x^2 + y^2 along the line; the torus is g^2 = 4 R^2 h.
  const double rr = torus.major * torus.major;
  const std::array<double, 3> g{glm::dot(o, o) + (torus.major - torus.minor) * (torus.major + torus.minor),
                                2.0 * glm::dot(o, d), dd};
  const std::array<double, 3> h{o.x * o.x + o.y * o.y, 2.0 * (o.x * d.x + o.y * d.y), d.x * d.x + d.y * d.y};
  const Polynomial<4> p{g[0] * g[0] - 4.0 * rr * h[0], 2.0 * g[0] * g[1] - 4.0 * rr * h[1],
                        2.0 * g[0] * g[2] + g[1] * g[1] - 4.0 * rr * h[2], 2.0 * g[1] * g[2], g[2] * g[2]};
  Few ends;
  ends.add(-half);
  sign_changes(derivative(p), -half, half, ends);
  ends.add(half);
  const AlongRay f{&solid, o, d};
  bool inside = false;  // both ends lie outside
  for (std::size_t i = 0; i + 1 < ends.count; ++i) {
    const bool then = i + 2 < ends.count && f.value(ends.at[i + 1]) < 0.0;
    if (then != inside) out.add(nearest + solve_between(f, ends.at[i], ends.at[i + 1], inside ? -1.0 : 1.0));
    inside = then;
  }
}

template <class Visit>
bool visit_implicit(const ShapeGeometry& solid, const LocalRay& ray, const Interval& wanted,
                    const Visit& visit) {
  const Implicit& implicit = std::get<Implicit>(solid);
  const Interval range = box_range(ray, implicit.box);
  if (range.empty()) return false;
  const double from = std::max(range.min, wanted.min), to = std::min(range.max, wanted.max);
  if (!(from < to)) return false;
  // Counted from where the line enters the box, so that a far origin costs no precision.
  const AlongRay f{&solid, ray.origin + range.min * ray.direction, ray.direction};
  const double end = range.max - range.min;
  if (implicit.closed && from == range.min && f.value(0.0) < 0.0 && visit(range.min)) return true;
  if (isolate_roots(f, from - range.min, to - range.min, [&](double s) { return visit(range.min + s); }))
    return true;
  return implicit.closed && to == range.max && f.value(end) < 0.0 && visit(range.max);
}

Few few_crossings(const ShapeGeometry& solid, const LocalRay& ray) {
  Few out;
  if (const auto* quadric = std::get_if<Quadric>(&solid))
    quadric_crossings(*quadric, ray, out);
  else
    torus_crossings(solid, ray, out);
  return out;
}

}  // namespace

double solve_between(const AlongRay& f, double lo, double hi, double f_lo) {
  constexpr int most_steps = 200;
  const bool low_is_negative = f_lo < 0.0;
  double s = 0.5 * (lo + hi), last_width = hi - lo;
  for (int i = 0; i < most_steps && lo < hi; ++i) {
    const auto [value, change] = f.slope(s);
    if (value == 0.0) return s;
    ((value < 0.0) == low_is_negative ? lo : hi) = s;
    double next = s - value / change;
    // Every third step must have halved the bracket, or it is halved.
    if (i % 3 == 2) {
      if (!(hi - lo <= 0.5 * last_width)) next = infinity;
      last_width = hi - lo;
    }
    if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
    if (next == s || next == lo || next == hi) return next;
    if (std::abs(next - s) <= DBL_EPSILON * std::abs(next)) return next;
    s = next;
  }
  return s;
}

LocalRay local_ray(const RayFrame& ray, const ShapeGeometry& solid) {
  const ShapeFrame& frame = frame_of(solid);
  const Vec3 o(ray.origin[0], ray.origin[1], ray.origin[2]);
  const Vec3 d(ray.direction[0], ray.direction[1], ray.direction[2]);
  return {to_local(frame, o), glm::transpose(frame.axes) * d};
}

Interval box_range(const LocalRay& ray, const Aabb& box) {
  Interval range{-infinity, infinity};
  for (int a = 0; a < 3; ++a) {
    const double o = ray.origin[a], d = ray.direction[a];
    if (d == 0.0) {
      if (!(o >= box.min[a] && o <= box.max[a])) return {infinity, -infinity};
      continue;
    }
    const double low = (box.min[a] - o) / d, high = (box.max[a] - o) / d;
    range.min = std::max(range.min, std::min(low, high));
    range.max = std::min(range.max, std::max(low, high));
  }
  return range;
}

bool intersect_solid(const RayFrame& ray, const ShapeGeometry& solid, double& t) {
  const LocalRay local = local_ray(ray, solid);
  const auto report = [&](double s) {
    if (!(s > ray.t.min && s < ray.t.max)) return false;
    t = s;
    return true;
  };
  if (std::holds_alternative<Implicit>(solid)) return visit_implicit(solid, local, ray.t, report);
  const Few found = few_crossings(solid, local);
  for (std::size_t i = 0; i < found.count; ++i)
    if (report(found.at[i])) return true;
  return false;
}

std::vector<double> solid_crossings(const RayFrame& ray, const ShapeGeometry& solid) {
  const LocalRay local = local_ray(ray, solid);
  std::vector<double> all;
  if (std::holds_alternative<Implicit>(solid)) {
    visit_implicit(solid, local, {-infinity, infinity}, [&](double s) {
      all.push_back(s);
      return false;
    });
    return all;
  }
  const Few found = few_crossings(solid, local);
  all.assign(found.at.begin(), found.at.begin() + static_cast<std::ptrdiff_t>(found.count));
  return all;
}

Vec3 solid_point(const ShapeGeometry& solid, const Vec3& near_surface, Vec3& error) {
  const ShapeFrame& frame = frame_of(solid);
  const Aabb box = local_box(solid);
  Vec3 local = to_local(frame, near_surface);
  const SolidPart part = nearest_part(solid, local);
  double off = 0.0;  // the surface's distance from the local point
  if (part.axis >= 0) {
    local[part.axis] = (part.high ? box.max : box.min)[part.axis];
  } else {
    for (int step = 0; step < 2; ++step) {  // Newton along the gradient
      const auto f = solid_gradient(solid, local);
      const Vec3 move = (f.value / glm::dot(f.change, f.change)) * f.change;
      if (all_finite(move) && glm::length(move) < 1e-3 * box.diagonal()) local -= move;
    }
    const double steepness = glm::length(solid_gradient(solid, local).change);
    const Bounds f = solid_value(solid, Bounds(local.x), Bounds(local.y), Bounds(local.z));
    off = 2.0 * std::max(std::abs(f.lo), std::abs(f.hi)) / steepness;
    const double most = 1e-6 * box.diagonal();
    if (!(off < most)) off = most;
  }
  const Vec3 point = to_world(frame, local);
  const double size = max_component(glm::abs(local)) + box.diagonal();
  error = error_gamma(8) * (glm::abs(point) + glm::abs(frame.origin)) + Vec3(error_gamma(32) * size + off);
  return point;
}

}  // namespace gnomon::raytrace
