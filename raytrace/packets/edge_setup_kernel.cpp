// The numbers of raytrace/packets/edge_setup.h, in double, eight triangles at a time.
//
// The bounds, with u = 2^-24 and M the largest coordinate in the pass:
// - An edge function has 5 roundings of terms that sum to at most |d| (<= 2.35 for |u|, |v| <= 1.5): 12 u.
//   Along a direction |u|, |v| <= 2 R for the world's radius R, and no line is farther than R from the middle.
//   Near an edge the coefficients and (u, v) add 2 * 2.83 R + R, the inner sum 2 R, products that are not fused
//   2.83 R. Quantised receivers' positions add 4 R. Together that is below 16 u R.
// - The double kernels see corners displaced by less than 2^-43 M, points by less than 2^-44 M (their own
// error
//   boxes included: gamma(7) and gamma(24) of raytrace/precision/ray_offset.h, gamma(12) of
//   raytrace/precision/ambiguous_ray.cpp, times the shear), so an edge function by 2^-41 M C with C the farthest
//   corner; four times that is taken, for one edge function surely negative then leaves another one surely
//   positive.
// - The depth: the mean of the corners' with weights known to the same bound.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packets/edge_setup_kernel.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "raytrace/packets/edge_setup.h"
#include "raytrace/packets/edge_setup_rows.h"
#include "raytrace/packets/load_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
constexpr D d;

struct V3 {
  V x, y, z;
};
V3 operator-(const V3& a, const V3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
V dot(const V3& a, const V3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
V product_difference(V a, V b, V c, V e) {
  return hn::Sub(hn::Mul(a, b), hn::Mul(c, e));
}
V3 cross(const V3& a, const V3& b) {
  return {product_difference(a.y, b.z, a.z, b.y), product_difference(a.z, b.x, a.x, b.z),
          product_difference(a.x, b.y, a.y, b.x)};
}
V3 times(const V3& a, V s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
V square(const V3& a) {
  return dot(a, a);
}
V max3(V a, V b, V c) {
  return hn::Max(a, hn::Max(b, c));
}
V min3(V a, V b, V c) {
  return hn::Min(a, hn::Min(b, c));
}
V all(double v) {
  return hn::Set(d, v);
}

/// To within 2^-23 of themselves, which the errors' rounding covers: roots of floats where floats can hold the squares, for
/// those of doubles take several times as long.
template <std::size_t count>
void roots_of(const V (&squares)[count], V (&roots)[count]) {
  constexpr hn::Rebind<float, D> half;
  V least = squares[0], most = squares[0];
  for (const V& s : squares) least = hn::Min(least, s), most = hn::Max(most, s);
  if (hn::AllTrue(d, hn::And(hn::Gt(least, all(0x1p-120)), hn::Lt(most, all(0x1p120))))) [[likely]] {
    for (std::size_t k = 0; k < count; ++k)
      roots[k] = hn::PromoteTo(d, hn::Sqrt(hn::DemoteTo(half, squares[k])));
    return;
  }
  for (std::size_t k = 0; k < count; ++k) roots[k] = hn::Sqrt(squares[k]);
}

// What is to be written: rows of PrimitiveEdges.
struct Out {
  V3 edge[3], reciprocal_depth;
  V edge_error, depth_error, depth_floor;
};

// Where `thin`: the triangle is taken for its own plane alone, seen edge-on; it never says how near it is.
template <class M>
void lie_in_plane(M thin, const V3& normal, V error, Out& out) {
  out.edge_error = hn::IfThenElse(thin, error, out.edge_error);
  const V3 slab[3] = {normal, times(normal, all(-1.0)), times(normal, all(0.0))};
  for (int k = 0; k < 3; ++k) {
    out.edge[k] = {hn::IfThenElse(thin, slab[k].x, out.edge[k].x),
                   hn::IfThenElse(thin, slab[k].y, out.edge[k].y),
                   hn::IfThenElse(thin, slab[k].z, out.edge[k].z)};
  }
  out.reciprocal_depth = {hn::IfThenZeroElse(thin, out.reciprocal_depth.x),
                          hn::IfThenZeroElse(thin, out.reciprocal_depth.y),
                          hn::IfThenZeroElse(thin, out.reciprocal_depth.z)};
  out.depth_error = hn::IfThenElse(thin, all(infinity), out.depth_error);
}

V inverse_or_zero(V length, V sign) {
  return hn::IfThenElseZero(hn::Gt(length, all(0.0)), hn::Div(sign, length));
}

// Divisions and roots are what these numbers cost, so several quotients share one.
struct Inverses {
  V of[3], most;  ///< of a length of zero: 0; the most: infinity there
  explicit Inverses(const V (&l)[3]) {
    const V product = hn::Mul(hn::Mul(l[0], l[1]), l[2]);
    const auto in_range = hn::And(hn::Gt(product, all(1e-200)), hn::Lt(product, all(1e200)));
    if (hn::AllTrue(d, in_range)) [[likely]] {
      const V inverse = hn::Div(all(1.0), product), last = hn::Mul(inverse, l[2]);
      of[0] = hn::Mul(last, l[1]), of[1] = hn::Mul(last, l[0]);
      of[2] = hn::Mul(inverse, hn::Mul(l[0], l[1]));
      most = max3(of[0], of[1], of[2]);
      return;
    }
    for (int k = 0; k < 3; ++k) of[k] = inverse_or_zero(l[k], all(1.0));
    most = hn::Div(all(1.0), min3(l[0], l[1], l[2]));
  }
};

Out from_point(const V3& a, const V3& b, const V3& c, double m) {
  const V3 e0 = c - b, e1 = a - c, e2 = b - a;
  const V3 n[3] = {cross(b, e0), cross(c, e1), cross(a, e2)};
  const V3 normal = cross(e1, e2);
  const V det = dot(normal, a), size = hn::Abs(det), sign = hn::CopySign(all(1.0), det);
  const V squares[6] = {square(n[0]),
                        square(n[1]),
                        square(n[2]),
                        max3(square(a), square(b), square(c)),
                        max3(square(e0), square(e1), square(e2)),
                        square(normal)};
  V root[6];
  roots_of(squares, root);
  const V l[3] = {root[0], root[1], root[2]}, corner = root[3], extent = root[4], area = root[5];
  const V kernel_error = hn::Mul(all(0x1p-39 * m), corner);
  const Inverses inverse(l);
  Out out;
  out.edge_error = hn::MulAdd(kernel_error, inverse.most, all(0x1p-20));
  for (int k = 0; k < 3; ++k) out.edge[k] = times(n[k], hn::Mul(inverse.of[k], sign));
  const V per_size = hn::Div(all(1.0), size), steep = hn::Mul(area, per_size);
  out.reciprocal_depth = times(normal, hn::Mul(sign, per_size));
  out.depth_error = hn::MulAdd(
      steep, hn::MulAdd(hn::Mul(all(0x1p-35 * m), corner), hn::Mul(extent, per_size), all(0x1p-19)),
      hn::Mul(all(0x1p-40 * m), hn::Mul(steep, steep)));
  // Rays in the widened triangle intersect its plane ahead, at a distance that the double kernels know.
  const V well = hn::Max(hn::Mul(hn::Mul(all(12.0), out.edge_error), hn::Mul(max3(l[0], l[1], l[2]), corner)),
                         hn::Mul(all(0x1p-33 * m), hn::Mul(corner, corner)));
  out.depth_floor = hn::IfThenElse(hn::Ge(size, well), all(-infinity),
                                   hn::Mul(hn::Mul(all(0x1p-34 * m), corner), per_size));
  // Edge-on: all edge planes are the triangle's own; only rays within that plane's error are not surely off.
  const auto thin = hn::Not(hn::Gt(size, hn::Mul(hn::Mul(all(0x1p-38 * m), corner), extent)));
  if (!hn::AllFalse(d, thin)) {
    const V3 unit = times(normal, inverse_or_zero(area, all(1.0)));
    const V s0 = dot(n[0], unit), s1 = dot(n[1], unit), s2 = dot(n[2], unit);
    const V spread = hn::Min(max3(s0, s1, s2), hn::Neg(min3(s0, s1, s2)));
    const V off = hn::MulAdd(hn::Mul(all(3.0), hn::Div(size, area)), extent, kernel_error);
    const V error =
        hn::IfThenElse(hn::Gt(spread, all(0.0)), hn::Add(all(0x1p-20), hn::Div(off, spread)), all(infinity));
    lie_in_plane(thin, unit, error, out);
  }
  return out;
}

// The line through p along e in the plane across the direction, as an edge function, times `scale`.
V3 line(const V3& p, const V3& e, V scale) {
  return times({hn::Neg(e.y), e.x, product_difference(e.y, p.x, e.x, p.y)}, scale);
}
V square2(const V3& e) {
  return hn::MulAdd(e.x, e.x, hn::Mul(e.y, e.y));
}

Out along_direction(const V3& a, const V3& b, const V3& c, const EdgeSetupPass& pass) {
  const V3 e0 = c - b, e1 = a - c, e2 = b - a;
  const V3 normal = cross(e1, e2);
  const V size = hn::Abs(normal.z), sign = hn::CopySign(all(1.0), normal.z);
  const V squares[4] = {square2(e0), square2(e1), square2(e2), max3(square(e0), square(e1), square(e2))};
  V root[4];
  roots_of(squares, root);
  const V l[3] = {root[0], root[1], root[2]}, extent = root[3];
  const double m = pass.largest, radius = pass.radius, corner = pass.farthest;
  const V kernel_error = all(0x1p-39 * m * corner);
  Out out;
  const Inverses per(l);
  out.edge_error = hn::MulAdd(kernel_error, per.most, all(0x1p-20 * radius));
  out.edge[0] = line(b, e0, hn::Mul(per.of[0], sign));
  out.edge[1] = line(c, e1, hn::Mul(per.of[1], sign));
  out.edge[2] = line(a, e2, hn::Mul(per.of[2], sign));
  const V inverse = hn::Div(all(1.0), normal.z);
  out.reciprocal_depth = {hn::Neg(hn::Mul(normal.x, inverse)), hn::Neg(hn::Mul(normal.y, inverse)),
                          hn::Mul(dot(normal, a), inverse)};
  const V terms = hn::MulAdd(hn::Add(hn::Abs(out.reciprocal_depth.x), hn::Abs(out.reciprocal_depth.y)),
                             all(2.0 * radius), hn::Abs(out.reciprocal_depth.z));
  out.depth_error = hn::MulAdd(terms, all(0x1p-20),
                               hn::MulAdd(all(0x1p-35 * m * corner), hn::Mul(extent, hn::Abs(inverse)),
                                          all(0x1p-20 * radius + 0x1p-40 * m)));
  out.depth_floor = all(-infinity);
  const auto thin = hn::Not(hn::Gt(size, all(0x1p-35 * m * corner)));
  if (!hn::AllFalse(d, thin)) {
    const V longest = max3(l[0], l[1], l[2]);
    const V3 source[3] = {line(b, e0, inverse_or_zero(l[0], all(1.0))),
                          line(c, e1, inverse_or_zero(l[1], all(1.0))),
                          line(a, e2, inverse_or_zero(l[2], all(1.0)))};
    const auto first = hn::Eq(l[0], longest), second = hn::Eq(l[1], longest);
    const auto pick = [&](V p, V q, V r) { return hn::IfThenElse(first, p, hn::IfThenElse(second, q, r)); };
    const V3 n = {pick(source[0].x, source[1].x, source[2].x), pick(source[0].y, source[1].y, source[2].y),
                  pick(source[0].z, source[1].z, source[2].z)};
    const V off = hn::Mul(all(2.0), hn::Add(kernel_error, size));
    const V error = hn::IfThenElse(hn::Gt(longest, all(0.0)),
                                   hn::Add(all(0x1p-20 * radius), hn::Div(off, longest)), all(infinity));
    lie_in_plane(thin, n, error, out);
  }
  return out;
}

// Rounds the errors up, and lets numbers beyond a float's range (and what is not a number) decide nothing.
void store(const Out& out, EdgeSetupRows& rows, std::size_t first) {
  constexpr hn::Rebind<float, D> half;
  const auto size = [](const V3& v) { return hn::Add(hn::Abs(v.x), hn::Add(hn::Abs(v.y), hn::Abs(v.z))); };
  const V sum = hn::Add(hn::Add(size(out.edge[0]), size(out.edge[1])),
                        hn::Add(size(out.edge[2]), size(out.reciprocal_depth)));
  const auto sound = hn::And(hn::Lt(sum, all(1e30)),
                             hn::And(hn::Gt(out.edge_error, all(0.0)), hn::Gt(out.depth_error, all(0.0))));
  std::size_t row = 0;
  const auto put = [&](V v) { hn::Store(hn::DemoteTo(half, v), half, rows.out[row++] + first); };
  const auto store_number = [&](V v) { put(hn::IfThenElseZero(sound, v)); };
  const auto set_above = [&](V v, double otherwise) {
    put(hn::IfThenElse(sound, hn::MulAdd(hn::Abs(v), all(0x1p-20), v), all(otherwise)));
  };
  for (const V3& e : out.edge) store_number(e.x), store_number(e.y), store_number(e.z);
  store_number(out.reciprocal_depth.x), store_number(out.reciprocal_depth.y),
      store_number(out.reciprocal_depth.z);
  set_above(out.edge_error, infinity), set_above(out.depth_error, infinity);
  put(hn::IfThenElse(hn::And(sound, hn::Gt(out.depth_floor, all(-1.0))),
                     hn::Mul(out.depth_floor, all(1.0 + 0x1p-20)), all(-infinity)));
}

void see_eight(std::span<const CornerPointers, EdgeSetupRows::together> triangles, const EdgeSetupPass& pass,
               EdgeSetupRows& rows) {
  for (std::size_t first = 0; first < 8; first += hn::Lanes(d)) {
    V3 corner[3];
    for (std::size_t k = 0; k < 3; ++k) {
      V in[3];
      load_points([&](std::size_t lane) { return triangles[first + lane][k]; }, in);
      const V3 p = V3{in[0], in[1], in[2]} - V3{all(pass.origin.x), all(pass.origin.y), all(pass.origin.z)};
      const auto along = [&](const Vec3& axis) { return dot(p, V3{all(axis.x), all(axis.y), all(axis.z)}); };
      corner[k] = {along(pass.axes[0]), along(pass.axes[1]), along(pass.axes[2])};
    }
    const Out out = pass.directional ? along_direction(corner[0], corner[1], corner[2], pass)
                                     : from_point(corner[0], corner[1], corner[2], pass.largest);
    store(out, rows, first);
  }
}

const char* target() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(see_eight);
HWY_EXPORT(target);

void set_up_eight_triangles(std::span<const CornerPointers, EdgeSetupRows::together> triangles,
                            const EdgeSetupPass& pass, EdgeSetupRows& rows) {
  HWY_DYNAMIC_DISPATCH(see_eight)(triangles, pass, rows);
}
const char* packet_target() {
  return HWY_DYNAMIC_DISPATCH(target)();
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
