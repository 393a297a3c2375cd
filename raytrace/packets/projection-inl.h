// Where boxes and triangles lie in the plane of a common origin's or direction's rays, in floats. What needs no more of
// a primitive than which rays it may concern at all is spared its edge setup.

#if defined(GNOMON_RAYTRACE_PACKETS_PROJECTION_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_PROJECTION_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_PROJECTION_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_PROJECTION_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cfloat>
#include <span>

#include "raytrace/packets/leaf_corners-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {

/// Runs of leaves are not divided below this.
constexpr std::uint32_t run_size = 48;

/// PrimitiveBounds of leaves, by rows; `nearest` is finite, below what nobody asks for.
struct alignas(64) BoundsRows {
  float u_min[run_size], u_max[run_size], v_min[run_size], v_max[run_size], nearest[run_size];
  void set(std::size_t i, const PrimitiveBounds& b) {
    u_min[i] = b.u_min, u_max[i] = b.u_max, v_min[i] = b.v_min, v_max[i] = b.v_max;
    nearest[i] = std::min(b.nearest, FLT_MAX);
  }
};

/// Holds the lines through the edges of leaves' triangles, by rows. A ray at (u, v) surely misses where one of a triangle's
/// u across + v down + constant is negative.
struct alignas(64) EdgeLines {
  float across[3][run_size], down[3][run_size], constant[3][run_size];
  /// Sets what is no triangle, or one of which no line is known: no ray surely misses it.
  void set_unknown(std::size_t i) {
    for (std::size_t k = 0; k < 3; ++k) across[k][i] = down[k][i] = 0.0f, constant[k][i] = inf;
  }
};

/// Where in the plane boxes and triangles lie.
class Projection {
 public:
  Projection(const Structures& s, const EdgeSetup& setup)
      : s_(s),
        setup_(setup),
        slack_(float_above(setup.slack)),
        least_width_(float_above(setup.directional ? 0x1p-33 * setup.reach : 0x1p-17)) {
    const EdgeSetupPass pass = edge_setup_pass(s, setup);
    kernel_error_ = float_above(0x1p-38 * pass.largest * (setup.directional ? pass.farthest : 1.0));
    double_error_ = float_above(0x1p-46 * pass.largest);
    const Vec3 origin = setup.origin - s.bvh.center;
    for (int a = 0; a < 3; ++a) {
      origin_[a] = static_cast<float>(origin[a]);
      for (int k = 0; k < 3; ++k) axes_[a][k] = static_cast<float>(setup.axes[k][a]);
    }
  }

  /// Returns the intervals of the coordinates of a box, which counts from the hierarchy's centre, along the axes, and a
  /// point's divided by the depth's. They are conservative, for boxes are floats rounded outwards and widened by the slack;
  /// infinite, and nearest with it, for what is not clear of the common origin.
  PrimitiveBounds of(const BoxRef& box) const {
    alignas(16) float low[4], high[4];
    along_axes(box, low, high);
    if (setup_.directional) {
      const float margin = 4.0f * slack_;
      return {low[0] - margin, high[0] + margin, low[1] - margin, high[1] + margin, high[2] + margin};
    }
    if (!(low[2] > 64.0f * slack_)) return {-inf, inf, -inf, inf, inf};
    const float near = 1.0f / low[2], far = 1.0f / high[2];
    const float error = 2.0f * slack_ * near + 0x1p-20f;
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k] * near, low[k] * far), high[k] = std::max(high[k] * near, high[k] * far);
      const float margin = std::max(std::abs(low[k]), std::abs(high[k])) * error + error;
      low[k] -= margin, high[k] += margin;
    }
    return {low[0], high[0], low[1], high[1], (1.0f + 0x1p-20f) / (low[2] - slack_)};
  }

  /// Bounds up to run_size leaves; what follows them up to a multiple of leaves_together is anything. They are as near as
  /// their boxes: where a triangle is seen edge-on, the kernels' depth is anywhere between the corners' along a coordinate
  /// axis.
  void of_leaves(std::span<const std::uint32_t> leaves, BoundsRows& rows, EdgeLines& lines) const {
    for (std::size_t i = 0; i < leaves.size(); i += leaves_together)
      of_some(leaves.subspan(i, std::min(leaves_together, leaves.size() - i)), i, rows, lines);
  }

 private:
  /// PrimitiveBounds in every lane of its own.
  struct Bounds {
    V u_min, u_max, v_min, v_max, nearest;
    Bounds() : u_min(all(inf)), u_max(all(-inf)), v_min(u_min), v_max(u_max), nearest(u_min) {}
  };
  /// A point's, and what each may be wrong by.
  struct Place {
    V u, v, margin;
  };
  /// A triangle's corners. By arrays of vectors, not of structures: GCC copies those through memory.
  struct Corners {
    V u[3], v[3];
    V margin;           ///< the largest
    V size, per_depth;  ///< of a point's rays: the largest |x| + |y| + |z| from the origin, and 1 / depth
  };

  void of_some(std::span<const std::uint32_t> leaves, std::size_t first, BoundsRows& rows,
               EdgeLines& lines) const {
    const LeafCorners from(s_.bvh, leaves, setup_.origin);
    unsigned thin = 0;
    for (std::size_t i = 0; i < leaves_together; i += lanes()) {
      V corner[3][3], low[3], high[3];
      from.get(i, corner);
      for (std::size_t a = 0; a < 3; ++a) {
        low[a] = hn::Min(corner[0][a], hn::Min(corner[1][a], corner[2][a]));
        high[a] = hn::Max(corner[0][a], hn::Max(corner[1][a], corner[2][a]));
      }
      Bounds bounds;
      Corners at;
      at.margin = at.size = at.per_depth = hn::Zero(f);
      project(corner[0], 0, at, bounds), project(corner[1], 1, at, bounds), project(corner[2], 2, at, bounds);
      const Shape shape = shape_of(bounds, at);
      thin |= bits_of(hn::Not(shape.wide)) << i;
      widen(bounds, shape.size);
      const M clear = finish(bounds, low, high);
      const std::size_t row = first + i;
      hn::Store(bounds.u_min, f, rows.u_min + row), hn::Store(bounds.u_max, f, rows.u_max + row);
      hn::Store(bounds.v_min, f, rows.v_min + row), hn::Store(bounds.v_max, f, rows.v_max + row);
      hn::Store(hn::Min(bounds.nearest, all(FLT_MAX)), f, rows.nearest + row);
      store_lines(at, shape, hn::And(shape.wide, clear), lines, row);
    }
    unsigned others = (s_.has_shapes ? 0xffffu : thin) & ((1u << leaves.size()) - 1);
    for (; others != 0; others &= others - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(others));
      const std::uint32_t id = s_.bvh.id_at(leaves[i]);
      if (!s_.world->is_triangle(id)) {
        rows.set(first + i, of(shape_box(*s_.world, id, s_.bvh.center)));
        lines.set_unknown(first + i);
      } else if ((thin >> i & 1) != 0) {
        rows.set(first + i, of(triangle_box(leaves[i])));
      }
    }
  }

  /// The box's least and largest coordinate along each axis, from the origin.
  void along_axes(const BoxRef& box, float (&low)[4], float (&high)[4]) const {
    for (std::size_t i = 0; i < 4; i += hn::Lanes(four)) {
      auto least = hn::Zero(four), most = hn::Zero(four);
      for (std::size_t a = 0; a < 3; ++a) {
        const auto axes = hn::Load(four, axes_[a] + i);
        const auto from = hn::Mul(axes, hn::Set(four, box.min[a] - origin_[a]));
        const auto to = hn::Mul(axes, hn::Set(four, box.max[a] - origin_[a]));
        least = hn::Add(least, hn::Min(from, to)), most = hn::Add(most, hn::Max(from, to));
      }
      hn::Store(least, four, low + i), hn::Store(most, four, high + i);
    }
  }
  V along(std::size_t axis, const V (&from_origin)[3]) const {
    const auto times = [&](std::size_t a, V sum) {
      return hn::MulAdd(from_origin[a], all(axes_[a][axis]), sum);
    };
    return times(2, times(1, hn::Mul(from_origin[0], all(axes_[0][axis]))));
  }
  /// Bounds the error of quotients with that relative error.
  static V margin_of(V u, V v, V error) { return hn::MulAdd(hn::Max(hn::Abs(u), hn::Abs(v)), error, error); }
  /// Triangles' k-th corners, which were subtracted from the origin in double. With u = 2^-24 a coordinate along an axis has
  /// 5 roundings of terms that sum to at most the point's size; so has the depth, and the quotient 2 more. A direction's
  /// corners lie no farther from the origin than the slack's radius, of which a quarter of the slack is 32 u. What is left
  /// is the rounding of the rays, quantised receivers' included: below 4 u (1 + |u|) of a point's and 6 u of that radius.
  HWY_INLINE void project(const V (&p)[3], std::size_t k, Corners& at, Bounds& bounds) const {
    at.u[k] = along(0, p), at.v[k] = along(1, p);
    V margin = all(0.25f * slack_);
    if (!setup_.directional) {
      const V per_depth = hn::Div(all(1.0f), along(2, p));
      const V size = hn::Add(hn::Abs(p[0]), hn::Add(hn::Abs(p[1]), hn::Abs(p[2])));
      const V error = hn::MulAdd(size, all(0x1.8p-22f), all(double_error_));
      at.u[k] = hn::Mul(at.u[k], per_depth), at.v[k] = hn::Mul(at.v[k], per_depth);
      margin = margin_of(at.u[k], at.v[k], hn::MulAdd(error, per_depth, all(0x1p-20f)));
      at.size = hn::Max(at.size, size), at.per_depth = hn::Max(at.per_depth, per_depth);
    }
    at.margin = hn::Max(at.margin, margin);
    grow(bounds, {at.u[k], at.v[k], margin});
  }
  static void grow(Bounds& bounds, const Place& at) {
    bounds.u_min = hn::Min(bounds.u_min, hn::Sub(at.u, at.margin));
    bounds.u_max = hn::Max(bounds.u_max, hn::Add(at.u, at.margin));
    bounds.v_min = hn::Min(bounds.v_min, hn::Sub(at.v, at.margin));
    bounds.v_max = hn::Max(bounds.v_max, hn::Add(at.v, at.margin));
  }

  /// A triangle in the plane.
  struct Shape {
    V size, area;  ///< of its bounds the longer side; twice, signed
    M wide;        ///< much wider than what is not known of it
  };
  /// The double kernels cannot tell from a triangle's rays those within its edges moved out by 2^-41 of `reach`. Beyond a
  /// sharp corner that is more. It is less than a 16th of the triangle's size where the inscribed circle's radius is 32
  /// times it. Not wide: where that is not sure, and the box is to be taken.
  Shape shape_of(const Bounds& bounds, const Corners& at) const {
    Shape shape;
    shape.size = hn::Max(hn::Sub(bounds.u_max, bounds.u_min), hn::Sub(bounds.v_max, bounds.v_min));
    const V u1 = hn::Sub(at.u[1], at.u[0]), v1 = hn::Sub(at.v[1], at.v[0]);
    const V u2 = hn::Sub(at.u[2], at.u[0]), v2 = hn::Sub(at.v[2], at.v[0]);
    shape.area = hn::Sub(hn::Mul(u1, v2), hn::Mul(u2, v1));
    V least = hn::MulAdd(at.margin, all(16.0f), all(least_width_));
    if (!setup_.directional) least = hn::MulAdd(at.per_depth, all(32.0f * kernel_error_), least);
    shape.wide = hn::Gt(hn::Abs(shape.area), hn::Mul(shape.size, least));
    return shape;
  }
  static void widen(Bounds& bounds, V size) {
    const V more = hn::Mul(size, all(0x1p-4f));
    bounds.u_min = hn::Sub(bounds.u_min, more), bounds.u_max = hn::Add(bounds.u_max, more);
    bounds.v_min = hn::Sub(bounds.v_min, more), bounds.v_max = hn::Add(bounds.v_max, more);
  }

  /// A ray that the double kernels cannot tell from the triangle's is no farther from a corner than 9/8 of the size both
  /// ways. There the edge function, a product of two differences of places, is off by less than 12 margins times the size,
  /// and the kernels' own by what edge_setup_kernel.cpp says.
  void store_lines(const Corners& at, const Shape& shape, M known, EdgeLines& lines,
                   std::size_t first) const {
    V kernels = all(kernel_error_);
    if (!setup_.directional)
      kernels = hn::Mul(hn::Mul(kernels, at.size), hn::Mul(at.per_depth, at.per_depth));
    const V tolerance = hn::MulAdd(hn::Mul(at.margin, all(12.0f)), shape.size, kernels);
    const V sign = hn::CopySign(all(1.0f), shape.area);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      const V du = hn::Mul(hn::Sub(at.u[next], at.u[k]), sign),
              dv = hn::Mul(hn::Sub(at.v[next], at.v[k]), sign);
      const V constant = hn::Add(hn::Sub(hn::Mul(dv, at.u[k]), hn::Mul(du, at.v[k])), tolerance);
      hn::Store(hn::IfThenElseZero(known, hn::Neg(dv)), f, lines.across[k] + first);
      hn::Store(hn::IfThenElseZero(known, du), f, lines.down[k] + first);
      hn::Store(hn::IfThenElse(known, constant, all(inf)), f, lines.constant[k] + first);
    }
  }
  BoxRef triangle_box(std::uint32_t leaf) const {
    const LeafPrimitive p = s_.bvh.primitive_at(leaf);
    BoxRef box{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double center = s_.bvh.center[static_cast<int>(a)];
      const auto [low, high] = std::minmax({p.v[a], p.v[3 + a], p.v[6 + a]});
      box.min[a] = float_below(low - center), box.max[a] = float_above(high - center);
    }
    return box;
  }
  /// `low`, `high`: the box, from the origin. Returns where it is clear of the origin.
  M finish(Bounds& bounds, const V (&low)[3], const V (&high)[3]) const {
    V corner[3];
    for (std::size_t a = 0; a < 3; ++a)
      corner[a] = (axes_[a][2] > 0.0f) == setup_.directional ? high[a] : low[a];
    const V depth = along(2, corner);
    if (setup_.directional) {
      bounds.nearest = hn::Add(depth, all(4.0f * slack_));
      return hn::Eq(depth, depth);
    }
    const M clear = hn::Gt(depth, all(64.0f * slack_));
    const V most = all(inf), least = all(-inf);
    bounds.u_min = hn::IfThenElse(clear, bounds.u_min, least),
    bounds.u_max = hn::IfThenElse(clear, bounds.u_max, most);
    bounds.v_min = hn::IfThenElse(clear, bounds.v_min, least),
    bounds.v_max = hn::IfThenElse(clear, bounds.v_max, most);
    const V near = hn::Div(all(1.0f + 0x1p-20f), hn::Sub(depth, all(slack_)));
    bounds.nearest = hn::IfThenElse(clear, near, most);
    return clear;
  }

  const Structures& s_;
  const EdgeSetup& setup_;
  float origin_[3];                    ///< from the middle that boxes count from
  alignas(16) float axes_[3][4] = {};  ///< axes_[coordinate][axis]: of u, v and depth, and nothing
  float slack_;
  float least_width_;   ///< of triangles' areas, beyond their own rounding
  float kernel_error_;  ///< of the double kernels' edge functions; of a point's per world unit
  float double_error_;  ///< of a point's corners, world units, beyond that of the floats
};

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
