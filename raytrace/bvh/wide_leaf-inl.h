// A leaf's triangles against one ray, sixteen at once, whatever the instruction set's width: what floats
// surely know of the answers in double, and the textbook's test for itself.

#if defined(GNOMON_RAYTRACE_BVH_WIDE_LEAF_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_BVH_WIDE_LEAF_INL_H_
#undef GNOMON_RAYTRACE_BVH_WIDE_LEAF_INL_H_
#else
#define GNOMON_RAYTRACE_BVH_WIDE_LEAF_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <type_traits>

#include "raytrace/bvh/wide_ray.h"
#include "raytrace/mask_bits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, node_lanes>;
using U = hn::RebindToUnsigned<F>;
using V = hn::Vec<F>;
using M = hn::Mask<F>;
inline constexpr F f;
inline constexpr U ids;
inline constexpr std::size_t lanes = hn::MaxLanes(f);
static_assert(node_lanes % lanes == 0 && node_lanes == 16 && !HWY_HAVE_SCALABLE);

inline constexpr float inf = std::numeric_limits<float>::infinity();
inline V all(float v) {
  return hn::Set(f, v);
}
static_assert(leaf_lanes == node_lanes && leaf_corners < leaf_lanes);
inline constexpr std::size_t leaf_steps = leaf_lanes / lanes;

/// A coordinate of a leaf's corners, to be looked up by the triangles; the first, of no corner, means
/// nothing.
class Corners {
 public:
  HWY_INLINE void set(std::size_t i, V part) {
    if constexpr (in_registers)
      part_[i] = part;
    else
      hn::Store(part, f, table_ + i * lanes);
  }
  HWY_INLINE V at(hn::Vec<U> index) const {
    if constexpr (leaf_steps == 1) {
      return hn::TableLookupLanes(part_[0], hn::IndicesFromVec(f, index));
    } else if constexpr (in_registers) {
      const auto low = hn::IndicesFromVec(f, hn::And(index, hn::Set(ids, lanes - 1)));
      const auto is_high = hn::BitCast(f, hn::ShiftLeft<31 - std::countr_zero(lanes)>(index));
      return hn::IfNegativeThenElse(is_high, hn::TableLookupLanes(part_[1], low),
                                    hn::TableLookupLanes(part_[0], low));
    } else {
      return hn::GatherIndex(f, table_, hn::BitCast(hn::RebindToSigned<F>(), index));
    }
  }

 private:
  static constexpr bool in_registers = leaf_steps <= 2;
  V part_[in_registers ? leaf_steps : 1];
  alignas(64) float table_[in_registers ? 1 : leaf_lanes];
};

/// Where in LeafTriangles::index a triangle's number is, as vectors see its pairs of words side by side.
alignas(64) inline constexpr std::uint32_t index_shift[leaf_lanes] = {0,  0,  4,  4,  8,  8,  12, 12,
                                                                      16, 16, 20, 20, 24, 24, 28, 28};

/// Holds the corners' places of the triangles from lane i * lanes on.
struct CornerIndices {
  hn::Vec<U> a, b, c;
  HWY_INLINE CornerIndices(const LeafTriangles& leaf, std::size_t i) {
    const auto shift = hn::Load(ids, index_shift + i * lanes);
    const auto unpacked = [&](const std::uint32_t(&index)[2]) {
      return hn::And(hn::Shr(words(index, i), shift), hn::Set(ids, leaf_lanes - 1));
    };
    a = unpacked(leaf.index[0]), b = unpacked(leaf.index[1]), c = unpacked(leaf.index[2]);
  }

 private:
  static HWY_INLINE hn::Vec<U> words(const std::uint32_t (&index)[2], std::size_t i) {
    if constexpr (lanes == 1) {
      return hn::Set(ids, index[i % 2]);
    } else {
      constexpr hn::Repartition<std::uint64_t, F> pairs;
      std::uint64_t pair;
      std::memcpy(&pair, index, sizeof pair);
      return hn::BitCast(ids, hn::Set(pairs, pair));
    }
  }
};
inline constexpr unsigned lane_bits = (1u << lanes) - 1;

/// Corners 1 to 15 of an axis, those from i * lanes on; in steps. Before the first is what stands there.
HWY_INLINE V corners_of(const WideLeaf& leaf, std::size_t axis, std::size_t i) {
  constexpr hn::Rebind<std::int16_t, F> shorts;
  constexpr hn::RebindToSigned<F> integers;
  constexpr std::size_t before = offsetof(WideLeaf, corner) - sizeof(std::int16_t);
  const auto* row = reinterpret_cast<const std::int16_t*>(reinterpret_cast<const char*>(&leaf) + before) +
                    axis * leaf_corners;
  return hn::ConvertTo(f, hn::PromoteTo(integers, hn::LoadU(shorts, row + i * lanes)));
}

/// x, y and z by which axis is z.
inline constexpr std::size_t axes_with_z[3][3] = {{1, 2, 0}, {2, 0, 1}, {0, 1, 2}};

/// What the floats say of a leaf's triangles (raytrace/bvh/wide_ray.h).
struct LeafTest {
  using Leaf = WideLeaf;
  unsigned candidates = 0, sure = 0;
  alignas(64) float below[leaf_lanes], above[leaf_lanes];

  /// wanted(candidates) leaves out what nobody asks for.
  template <class Wanted>
  HWY_INLINE LeafTest(const WideLeaf& leaf, const WideRay& ray, const Wanted& wanted) {
    const LeafTriangles& triangles = leaf.triangles;
    if (triangles.shapes()) {  // hit somewhere, for all that is known
      candidates = triangles.lanes();
      std::fill(below, below + leaf_lanes, -inf);
      return;
    }
    const auto& axis = axes_with_z[ray.z];
    const auto from = [&](std::size_t k) {
      return hn::Sub(all(ray.origin[axis[k]]), all(leaf.anchor(axis[k])));
    };
    const V o[3] = {from(0), from(1), from(2)};
    const V inverse_z = all(ray.inverse[axis[2]]);
    const V direction_x = all(ray.direction[axis[0]]), direction_y = all(ray.direction[axis[1]]);
    const V reach = hn::Max(hn::Max(hn::Abs(o[0]), hn::Abs(o[1])), hn::Abs(o[2])), step = all(leaf.step());
    const V off = hn::MulAdd(all(WideRay::origin_error), reach,
                             hn::MulAdd(all(WideRay::corner_error), step, all(ray.coordinate_error)));
    const V coarse = hn::Mul(off, hn::MulAdd(all(16.0f), off, all(leaf.size_13())));
    const V depth_off = hn::Mul(off, hn::Abs(hn::Add(inverse_z, inverse_z)));
    Corners x, y, t;
    for (std::size_t i = 0; i < leaf_steps; ++i) {
      const auto corner = [&](std::size_t k) { return hn::MulSub(corners_of(leaf, axis[k], i), step, o[k]); };
      const V along = hn::Mul(corner(2), inverse_z);
      t.set(i, along);
      x.set(i, hn::NegMulAdd(direction_x, along, corner(0)));
      y.set(i, hn::NegMulAdd(direction_y, along, corner(1)));
    }
    for (std::size_t i = 0; i < leaf_steps; ++i) {
      const unsigned present = (triangles.lanes() >> i * lanes) & lane_bits;
      if (leaf_steps > 1 && present == 0) continue;
      const CornerIndices k(triangles, i);
      const V x0 = x.at(k.a), x1 = x.at(k.b), x2 = x.at(k.c), y0 = y.at(k.a), y1 = y.at(k.b), y2 = y.at(k.c);
      const V u = hn::NegMulAdd(y2, x1, hn::Mul(x2, y1)), v = hn::NegMulAdd(y0, x2, hn::Mul(x0, y2)),
              w = hn::NegMulAdd(y1, x0, hn::Mul(x1, y0));
      const V least = hn::Min(u, hn::Min(v, w)), most = hn::Max(u, hn::Max(v, w));
      const auto one_sign = [&](V error) {
        return hn::Or(hn::Ge(least, hn::Neg(error)), hn::Le(most, error));
      };
      unsigned left = present & mask_bits(f, one_sign(coarse));
      if (left != 0) left = wanted(left << i * lanes) >> i * lanes;
      if (left == 0) continue;
      const V t0 = t.at(k.a), t1 = t.at(k.b), t2 = t.at(k.c);
      const auto far_of = [](V p, V q, V r) { return hn::Max(hn::Max(hn::Abs(p), hn::Abs(q)), hn::Abs(r)); };
      const V far = hn::Max(far_of(x0, x1, x2), far_of(y0, y1, y2));
      const V error = hn::Mul(off, hn::MulAdd(all(5.0f), far, hn::Add(off, off)));
      const V spread = hn::Sub(hn::Max(t0, hn::Max(t1, t2)), hn::Min(t0, hn::Min(t1, t2)));
      const V det = hn::Add(hn::Add(u, v), w), size_of_det = hn::Abs(det);
      const V depth_error =
          hn::MulAdd(size_of_det, depth_off,
                     hn::Mul(error, hn::MulAdd(all(2.0f), spread, hn::Mul(all(15.0f), depth_off))));
      const V sum = hn::MulAdd(u, t0, hn::MulAdd(v, t1, hn::Mul(w, t2)));
      const V depth = hn::Xor(sum, hn::And(det, all(-0.0f)));
      const auto in_range = hn::And(hn::Ge(depth, hn::MulSub(all(ray.t_min), size_of_det, depth_error)),
                                    hn::Le(depth, hn::MulAdd(all(ray.t_max), size_of_det, depth_error)));
      left &= mask_bits(f, hn::And(one_sign(error), in_range));
      if (left == 0) continue;
      candidates |= left << i * lanes;
      const auto is_sure = hn::Or(hn::Gt(least, error), hn::Lt(most, hn::Neg(error)));
      sure |= (left & mask_bits(f, is_sure)) << i * lanes;
      const V per_det = hn::Div(all(1.0f), size_of_det), middle = hn::Mul(depth, per_det);
      const V wider = hn::MulAdd(hn::Abs(middle), all(0x1p-20f), hn::Mul(depth_error, per_det));
      hn::Store(hn::IfThenElse(is_sure, hn::Sub(middle, wider), all(-inf)), f, below + i * lanes);
      hn::Store(hn::Add(middle, wider), f, above + i * lanes);
    }
  }
  bool is_sure(unsigned i) const { return (sure >> i & 1u) != 0; }
  /// A candidate is hit between these or not at all; t_above: of sure ones.
  float t_below(unsigned i) const { return below[i]; }
  float t_above(unsigned i) const { return above[i]; }
};

/// The test of FastArithmetic (raytrace/precision/fast.h), step by step, so that it has the same hits at the
/// same t.
struct PlainTest {
  using Leaf = PlainLeaf;
  unsigned candidates = 0;
  alignas(64) float t[leaf_lanes];

  template <class Wanted>
  HWY_INLINE PlainTest(const PlainLeaf& leaf, const WideRay& ray, const Wanted&) {
    const LeafTriangles& triangles = leaf.triangles;
    if (triangles.shapes()) {
      candidates = triangles.lanes();
      std::fill(t, t + leaf_lanes, -inf);
      return;
    }
    struct V3 {
      V x, y, z;
    };
    const auto minus = [](const V3& a, const V3& b) {
      return V3{hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
    };
    const auto cross = [](const V3& a, const V3& b) {
      const auto part = [](V p, V q, V r, V s) { return hn::Sub(hn::Mul(p, q), hn::Mul(r, s)); };
      return V3{part(a.y, b.z, b.y, a.z), part(a.z, b.x, b.z, a.x), part(a.x, b.y, b.x, a.y)};
    };
    const auto dot = [](const V3& a, const V3& b) {
      return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
    };
    const auto every = [](const float* v) { return V3{all(v[0]), all(v[1]), all(v[2])}; };
    const V3 origin = every(ray.plain_origin), direction = every(ray.plain_direction);
    const V zero = hn::Zero(f), one = all(1.0f);
    Corners x, y, z;
    for (std::size_t i = 0; i < leaf_steps; ++i) {
      const auto corner = [&](std::size_t a) { return hn::Load(f, leaf.corner[a] + i * lanes); };
      x.set(i, corner(0)), y.set(i, corner(1)), z.set(i, corner(2));
    }
    for (std::size_t i = 0; i < leaf_steps; ++i) {
      const CornerIndices k(triangles, i);
      const auto at = [&](hn::Vec<U> index) { return V3{x.at(index), y.at(index), z.at(index)}; };
      const V3 first = at(k.a), edge1 = minus(at(k.b), first), edge2 = minus(at(k.c), first);
      const V3 p = cross(direction, edge2), s = minus(origin, first), q = cross(s, edge1);
      const V det = dot(edge1, p), inverse = hn::Div(one, det);
      const V u = hn::Mul(dot(s, p), inverse), w = hn::Mul(dot(direction, q), inverse);
      const V kernel_t = hn::Mul(hn::Mul(dot(edge2, q), inverse), all(ray.kernel_t));
      const M missed =
          hn::Or(hn::Or(hn::Or(hn::Eq(det, zero), hn::Lt(u, zero)), hn::Or(hn::Gt(u, one), hn::Lt(w, zero))),
                 hn::Gt(hn::Add(u, w), one));
      const M in_range = hn::And(hn::Ge(kernel_t, all(ray.t_min)), hn::Le(kernel_t, all(ray.t_max)));
      candidates |=
          ((triangles.lanes() >> i * lanes) & mask_bits(f, in_range) & ~mask_bits(f, missed) & lane_bits)
          << i * lanes;
      hn::Store(kernel_t, f, t + i * lanes);
    }
  }
  bool is_sure(unsigned i) const { return t[i] > -inf; }
  float t_below(unsigned i) const { return t[i]; }
  float t_above(unsigned i) const { return t[i]; }
};

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
