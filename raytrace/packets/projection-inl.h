// Where boxes and triangles lie in the plane of a common origin's or direction's rays, in floats: what needs no more of
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
#include <span>
#include <utility>

#include "raytrace/packets/leaf_corners-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {

alignas(32) constexpr float corner_bit[3][8] = {
    {0, 1, 0, 1, 0, 1, 0, 1}, {0, 0, 1, 1, 0, 0, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}};

/// PrimitiveBounds of eight leaves, by rows.
struct alignas(32) BoundsRows {
  float u_min[8], u_max[8], v_min[8], v_max[8], nearest[8];
  void set(std::size_t i, const PrimitiveBounds& b) {
    u_min[i] = b.u_min, u_max[i] = b.u_max, v_min[i] = b.v_min, v_max[i] = b.v_max, nearest[i] = b.nearest;
  }
};

/// Where in the plane boxes and triangles lie.
class Projection {
 public:
  Projection(const Structures& s, const EdgeSetup& setup)
      : s_(s),
        setup_(setup),
        slack_(float_above(setup.slack)),
        least_per_margin_(float_above(0.5 + 0x1p-35 * setup.reach / setup.slack)),
        least_width_(setup.directional ? 0.0f : 0x1p-17f) {
    const Vec3 origin = setup.origin - s.bvh.center;
    for (int a = 0; a < 3; ++a) {
      origin_[a] = static_cast<float>(origin[a]);
      for (int k = 0; k < 3; ++k) axes_[k][a] = static_cast<float>(setup.axes[k][a]);
    }
  }

  /// Of a box that counts from the hierarchy's centre. Conservative; infinite, and nearest with it, of what is not clear of
  /// the common origin.
  PrimitiveBounds of(const BoxRef& box) const {
    Bounds bounds;
    V8 low[3], high[3];
    for (std::size_t a = 0; a < 3; ++a)
      low[a] = hn::Set(eight, box.min[a]), high[a] = hn::Set(eight, box.max[a]);
    for (std::size_t i = 0; i < 8; i += hn::Lanes(eight)) {
      V8 corner[3];
      for (std::size_t a = 0; a < 3; ++a) {
        const auto is_high = hn::Ne(hn::LoadU(eight, corner_bit[a] + i), hn::Zero(eight));
        corner[a] = hn::IfThenElse(is_high, high[a], low[a]);
      }
      grow(bounds, place_of(corner));
    }
    bounds.u_min = hn::MinOfLanes(eight, bounds.u_min), bounds.u_max = hn::MaxOfLanes(eight, bounds.u_max);
    bounds.v_min = hn::MinOfLanes(eight, bounds.v_min), bounds.v_max = hn::MaxOfLanes(eight, bounds.v_max);
    finish(bounds, low, high);
    return {hn::GetLane(bounds.u_min), hn::GetLane(bounds.u_max), hn::GetLane(bounds.v_min),
            hn::GetLane(bounds.v_max), hn::GetLane(bounds.nearest)};
  }

  /// Of up to eight leaves; the rest is anything. As near as their boxes: where a triangle is seen edge-on, the kernels'
  /// depth is anywhere between the corners' along a coordinate axis.
  void of_leaves(std::span<const std::uint32_t> leaves, BoundsRows& rows) const {
    const LeafCorners from(s_.bvh, leaves);
    unsigned thin = 0;
    for (std::size_t i = 0; i < 8; i += hn::Lanes(eight)) {
      V8 corner[3][3], low[3], high[3];
      from.get(i, corner);
      Bounds bounds;
      Place place[3];
      for (std::size_t k = 0; k < 3; ++k) {
        place[k] = place_of(corner[k]), grow(bounds, place[k]);
        low[k] = hn::Min(corner[0][k], hn::Min(corner[1][k], corner[2][k]));
        high[k] = hn::Max(corner[0][k], hn::Max(corner[1][k], corner[2][k]));
      }
      thin |= widen(bounds, place) << i;
      finish(bounds, low, high);
      hn::Store(bounds.u_min, eight, rows.u_min + i), hn::Store(bounds.u_max, eight, rows.u_max + i);
      hn::Store(bounds.v_min, eight, rows.v_min + i), hn::Store(bounds.v_max, eight, rows.v_max + i);
      hn::Store(bounds.nearest, eight, rows.nearest + i);
    }
    unsigned others = (s_.has_shapes ? 0xffu : thin) & ((1u << leaves.size()) - 1);
    for (; others != 0; others &= others - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(others));
      const std::uint32_t id = s_.bvh.id_at(leaves[i]);
      if (!s_.world->is_triangle(id))
        rows.set(i, of(shape_box(*s_.world, id, s_.bvh.center)));
      else if ((thin >> i & 1) != 0)
        rows.set(i, of(triangle_box(leaves[i])));
    }
  }

 private:
  /// PrimitiveBounds in every lane of its own.
  struct Bounds {
    V8 u_min, u_max, v_min, v_max, nearest;
    Bounds()
        : u_min(hn::Set(eight, inf)),
          u_max(hn::Set(eight, -inf)),
          v_min(u_min),
          v_max(u_max),
          nearest(u_min) {}
  };

  V8 along(std::size_t axis, const V8 (&from_origin)[3]) const {
    const auto times = [&](std::size_t a, V8 sum) {
      return hn::MulAdd(from_origin[a], hn::Set(eight, axes_[axis][a]), sum);
    };
    return times(2, times(1, hn::Mul(from_origin[0], hn::Set(eight, axes_[axis][0]))));
  }
  /// A point's, and what it may be wrong by.
  struct Place {
    V8 u, v, u_margin, v_margin;
  };
  Place place_of(const V8 (&corner)[3]) const {
    V8 p[3];
    for (std::size_t a = 0; a < 3; ++a) p[a] = hn::Sub(corner[a], hn::Set(eight, origin_[a]));
    const V8 u = along(0, p), v = along(1, p), margin = hn::Set(eight, 4.0f * slack_);
    if (setup_.directional) return {u, v, margin, margin};
    const V8 per_depth = hn::Div(hn::Set(eight, 1.0f), along(2, p));
    const V8 relative = hn::MulAdd(hn::Set(eight, 2.0f * slack_), per_depth, hn::Set(eight, 0x1p-20f));
    const V8 at_u = hn::Mul(u, per_depth), at_v = hn::Mul(v, per_depth);
    return {at_u, at_v, hn::MulAdd(hn::Abs(at_u), relative, relative),
            hn::MulAdd(hn::Abs(at_v), relative, relative)};
  }
  static void grow(Bounds& bounds, const Place& at) {
    bounds.u_min = hn::Min(bounds.u_min, hn::Sub(at.u, at.u_margin));
    bounds.u_max = hn::Max(bounds.u_max, hn::Add(at.u, at.u_margin));
    bounds.v_min = hn::Min(bounds.v_min, hn::Sub(at.v, at.v_margin));
    bounds.v_max = hn::Max(bounds.v_max, hn::Add(at.v, at.v_margin));
  }
  /// What the double kernels cannot tell from a triangle's rays are those within its edges moved out by 2^-41 of `reach`,
  /// which is more than that beyond a sharp corner: less than a 16th of the triangle's size where the inscribed circle's
  /// radius is 32 times it. Bits: where that is not sure, and the box is to be taken.
  unsigned widen(Bounds& bounds, const Place (&at)[3]) const {
    const V8 size = hn::Max(hn::Sub(bounds.u_max, bounds.u_min), hn::Sub(bounds.v_max, bounds.v_min));
    V8 margin = hn::Max(at[0].u_margin, at[0].v_margin);
    for (const Place& p : at) margin = hn::Max(margin, hn::Max(p.u_margin, p.v_margin));
    const auto edge = [&](std::size_t k) {
      return std::pair(hn::Sub(at[k].u, at[0].u), hn::Sub(at[k].v, at[0].v));
    };
    const auto [u1, v1] = edge(1);
    const auto [u2, v2] = edge(2);
    const V8 area = hn::Abs(hn::Sub(hn::Mul(u1, v2), hn::Mul(u2, v1)));  // twice the triangle's
    const V8 more = hn::Mul(size, hn::Set(eight, 0x1p-4f));
    bounds.u_min = hn::Sub(bounds.u_min, more), bounds.u_max = hn::Add(bounds.u_max, more);
    bounds.v_min = hn::Sub(bounds.v_min, more), bounds.v_max = hn::Add(bounds.v_max, more);
    const V8 least = hn::MulAdd(margin, hn::Set(eight, least_per_margin_), hn::Set(eight, least_width_));
    const auto wide = hn::Gt(area, hn::Mul(size, least));
    return mask_bits(eight, hn::Not(wide));
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
  /// `low`, `high`: the box.
  void finish(Bounds& bounds, const V8 (&low)[3], const V8 (&high)[3]) const {
    V8 corner[3];
    for (std::size_t a = 0; a < 3; ++a) {
      const bool highest = (axes_[2][a] > 0.0f) == setup_.directional;
      corner[a] = hn::Sub(highest ? high[a] : low[a], hn::Set(eight, origin_[a]));
    }
    const V8 depth = along(2, corner);
    if (setup_.directional) {
      bounds.nearest = hn::Add(depth, hn::Set(eight, 4.0f * slack_));
      return;
    }
    const auto clear = hn::Gt(depth, hn::Set(eight, 64.0f * slack_));
    const V8 most = hn::Set(eight, inf), least = hn::Set(eight, -inf);
    bounds.u_min = hn::IfThenElse(clear, bounds.u_min, least),
    bounds.u_max = hn::IfThenElse(clear, bounds.u_max, most);
    bounds.v_min = hn::IfThenElse(clear, bounds.v_min, least),
    bounds.v_max = hn::IfThenElse(clear, bounds.v_max, most);
    const V8 near = hn::Div(hn::Set(eight, 1.0f + 0x1p-20f), hn::Sub(depth, hn::Set(eight, slack_)));
    bounds.nearest = hn::IfThenElse(clear, near, most);
  }

  const Structures& s_;
  const EdgeSetup& setup_;
  float origin_[3], axes_[3][3];  ///< from the middle that boxes count from
  float slack_;
  float least_per_margin_, least_width_;  ///< of triangles' areas, beyond their own rounding
};

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
