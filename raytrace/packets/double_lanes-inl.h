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
#include <cstring>

#include "raytrace/mask_bits-inl.h"
#include "raytrace/packets/tile.h"
#include "scene/camera.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE::doubles {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
constexpr D d;

inline V all(double v) {
  return hn::Set(d, v);
}
inline unsigned bits_of(M mask) {
  return mask_bits(d, mask);
}
inline M mask_of(unsigned bits) {
  const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits)};
  return hn::LoadMaskBits(d, bytes);
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
struct PixelPlane {
  alignas(64) double x[tile_rays], y[tile_rays];
  PixelPlane(const View& view, int x0, int y0) {
    double column[16], row[16];
    for (int i = 0; i < 16; ++i) {
      column[i] = (2.0 * (x0 + i + 0.5) / view.size.width - 1.0) * view.tan_half_x;
      row[i] = (1.0 - 2.0 * (y0 + i + 0.5) / view.size.height) * view.tan_half_y;
    }
    for (std::size_t lane = 0; lane < tile_rays; lane += 4) {
      const TilePixel at = tile_pixel(lane);
      for (std::size_t i = 0; i < 4; ++i)
        x[lane + i] = column[static_cast<std::size_t>(at.x) + i], y[lane + i] = row[at.y];
    }
  }
};

/// Those lanes that show a triangle.
inline unsigned on_triangles(const Bvh& bvh, const std::uint32_t* leaf) {
  constexpr hn::Rebind<std::uint32_t, D> ids;
  return mask_bits(ids, hn::Lt(hn::LoadU(ids, leaf), hn::Set(ids, bvh.leaf_count())));
}

/// The corners of as many pixels' triangles as there are lanes; often these are one and the same.
class HitCorners {
 public:
  V3 corner[3] = {all(Vec3(0.0)), all(Vec3(0.0)), all(Vec3(0.0))};

  /// `known`, not 0: the lanes that show a triangle; the others get one of those. False: nothing has changed.
  bool load(const Bvh& bvh, const std::uint32_t* leaf, unsigned known) {
    constexpr hn::Rebind<std::uint32_t, D> ids;
    const auto first = leaf[std::countr_zero(known)];
    const bool same = hn::AllTrue(ids, hn::Eq(hn::LoadU(ids, leaf), hn::Set(ids, first)));
    if (same && first == only_) return false;
    only_ = same ? first : nothing_hit;
    PlacedCorners scratch;
    const CornerPointers one = bvh.corners_at(first, scratch);
    if (same)
      for (std::size_t k = 0; k < 3; ++k) corner[k] = {all(one[k][0]), all(one[k][1]), all(one[k][2])};
    else
      load_each(bvh, leaf, known, one);
    return true;
  }

 private:
  void load_each(const Bvh& bvh, const std::uint32_t* leaf, unsigned known, const CornerPointers& other) {
    alignas(64) double row[3][4 * 8];
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
      PlacedCorners scratch;
      const CornerPointers at = (known >> i & 1) != 0 ? bvh.corners_at(leaf[i], scratch) : other;
      for (std::size_t k = 0; k < 3; ++k) std::memcpy(row[k] + 4 * i, at[k], 4 * sizeof(double));
    }
    V nothing;
    for (std::size_t k = 0; k < 3; ++k)
      hn::LoadInterleaved4(d, row[k], corner[k].x, corner[k].y, corner[k].z, nothing);
  }

  std::uint32_t only_ = nothing_hit;  ///< what all lanes show
};

/// A packet's triangles on their way to the cache; where all are one they are there.
inline void prefetch(const Bvh& bvh, const std::uint32_t* leaf) {
  if (leaf[0] == leaf[packet_rays - 1]) return;
  const std::uint32_t count = bvh.leaf_count();
  for (std::size_t i = 0; i < packet_rays; ++i) {
    if (leaf[i] < count) bvh.prefetch(leaf[i]);
  }
}

}  // namespace gnomon::raytrace::HWY_NAMESPACE::doubles
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
