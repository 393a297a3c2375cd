// Several pixels' doubles at once: what the kernels share that find a tile's receivers. In a namespace of its own, for
// lanes-inl.h has functions of the same names and parameters that return floats' vectors.

#if defined(GNOMON_RAYTRACE_PACKETS_DOUBLE_LANES_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_DOUBLE_LANES_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_DOUBLE_LANES_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_DOUBLE_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "raytrace/mask_bits-inl.h"
#include "raytrace/packets/tile.h"
#include "raytrace/quantised_tile.h"
#include "raytrace/tiles.h"
#include "scene/camera.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE::doubles {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
using Ids = hn::Rebind<std::uint32_t, D>;  ///< of primitives and leaves
constexpr D d;

inline V all(double v) {
  return hn::Set(d, v);
}
inline unsigned bits_of(M mask) {
  return mask_bits(d, mask);
}
inline M mask_of(unsigned bits) {
  return mask_from_bits(d, bits);
}

struct V3 {
  V x, y, z;
};
inline V3 all(const Vec3& v) {
  return {all(v.x), all(v.y), all(v.z)};
}
inline V3 plus(const V3& a, const V3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
inline V3 minus(const V3& a, const V3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
inline V3 times(V s, const V3& a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
inline V3 cross(const V3& a, const V3& b) {
  const auto part = [](V p, V q, V r, V s) { return hn::Sub(hn::Mul(p, q), hn::Mul(r, s)); };
  return {part(a.y, b.z, a.z, b.y), part(a.z, b.x, a.x, b.z), part(a.x, b.y, a.y, b.x)};
}
/// By components.
inline V3 size_of(const V3& a) {
  return {hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)};
}
inline void store(const V3& a, double (&rows)[3][8]) {
  hn::Store(a.x, d, rows[0]), hn::Store(a.y, d, rows[1]), hn::Store(a.z, d, rows[2]);
}
/// A normal on the side that a ray comes from; `away`: where it points along the ray.
inline V3 facing(const V3& normal, M away) {
  const auto turned = [&](V component) { return hn::IfThenElse(away, hn::Neg(component), component); };
  return {turned(normal.x), turned(normal.y), turned(normal.z)};
}
/// Components of unit normals as QuantisedTile has them.
using Units = hn::Rebind<std::int16_t, D>;
inline hn::Vec<Units> in_units(hn::Vec<hn::Rebind<float, D>> components) {
  constexpr hn::Rebind<float, D> half;
  return hn::DemoteTo(Units(), hn::NearestInt(hn::Mul(components, hn::Set(half, normal_units))));
}
/// In the order of glm's operations, none of them fused.
inline V dot(const V3& a, const V3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

inline V fused_dot(const V3& a, const V3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

/// scene/camera.cpp's pixel_ray.
inline V3 pixel_direction(const View& view, V sx, V sy) {
  const auto along = [&](int a) {
    return hn::Add(hn::Add(all(view.forward[a]), hn::Mul(sx, all(view.right[a]))),
                   hn::Mul(sy, all(view.up[a])));
  };
  const V3 sum = {along(0), along(1), along(2)};
  return times(hn::Div(all(1.0), hn::Sqrt(dot(sum, sum))), sum);
}

/// A tile's pixels on the plane at distance one.
class PixelPlane {
 public:
  PixelPlane(const View& view, int x0, int y0) {
    for (std::size_t i = 0; i < tile_pixels; i += hn::Lanes(d)) {
      const V at = hn::Iota(d, static_cast<double>(i) + 0.5);
      const auto along = [&](int first, int size) {
        return hn::Div(hn::Mul(all(2.0), hn::Add(at, all(first))), all(size));
      };
      hn::Store(hn::Mul(hn::Sub(along(x0, view.size.width), all(1.0)), all(view.tan_half_x)), d, column_ + i);
      hn::Store(hn::Mul(hn::Sub(all(1.0), along(y0, view.size.height)), all(view.tan_half_y)), d, row_ + i);
    }
  }
  /// Returns the coordinates of the lanes from this one on.
  V x(std::size_t lane) const {
    const double* first = column_ + tile_pixel(lane).x;
#if HWY_MAX_BYTES == 64
    const auto row = hn::LoadU(hn::Half<D>(), first);
    return hn::Combine(d, row, row);
#else
    return hn::LoadU(d, first);
#endif
  }
  V y(std::size_t lane) const {
    const double* first = row_ + tile_pixel(lane).y;
#if HWY_MAX_BYTES == 64
    return hn::Combine(d, hn::Set(hn::Half<D>(), first[1]), hn::Set(hn::Half<D>(), first[0]));
#else
    return all(*first);
#endif
  }

 private:
  alignas(64) double column_[tile_pixels], row_[tile_pixels];
};

}  // namespace gnomon::raytrace::HWY_NAMESPACE::doubles
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
