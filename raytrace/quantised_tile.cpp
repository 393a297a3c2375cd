#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/quantised_tile.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <cmath>

#include "raytrace/packets/hit_corners-inl.h"
#include "raytrace/packets/receivers.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {
using namespace doubles;
using Half = hn::Rebind<float, D>;
constexpr Half half;
constexpr Ids leaves;

inline hn::Vec<Units> units(std::int16_t number) {
  return hn::Set(Units(), number);
}

/// The planes of the triangles that several pixels show, as the eye sees them.
struct TrianglePlanes {
  HitCorners corners;
  V3 normal = all(Vec3(0.0));                               ///< of no length in particular
  V height = all(0.0);                                      ///< of the triangle above the eye, along it
  hn::Vec<Units> unit[3] = {units(0), units(0), units(0)};  ///< of length one
  unsigned well_known = 0;  ///< bits of those whose planes say where the receiver lies

  void load(const Bvh& bvh, const V3& eye, const std::uint32_t* leaf, unsigned known) {
    if (!corners.load(bvh, leaf, known)) return;
    const V3(&corner)[3] = corners.corner;
    const V3 e1 = minus(corner[1], corner[0]), e2 = minus(corner[2], corner[0]);
    const V3 to_corner = minus(corner[0], eye);
    normal = cross(e1, e2);
    const V n2 = fused_dot(normal, normal);
    height = fused_dot(normal, to_corner);
    well_known = bits_of(is_well_known(e1, e2, n2, to_corner, height));
    const auto length = hn::Sqrt(hn::DemoteTo(half, n2));
    const auto scale = hn::Div(hn::Set(half, 1.0f), length);
    unit[0] = in_units(hn::Mul(hn::DemoteTo(half, normal.x), scale));
    unit[1] = in_units(hn::Mul(hn::DemoteTo(half, normal.y), scale));
    unit[2] = in_units(hn::Mul(hn::DemoteTo(half, normal.z), scale));
  }

 private:
  // With k = |e1||e2| / |n| and c the cosine between ray and normal, the plane through the first corner is
  // turned by 2^-51 k. The crossing is moved by 2^-51 (|to_corner| + k |e|) / c. That is to stay below 2^-39 of
  // the crossing's distance, and the turn below 2^-24. All is squared, and (a + b)^2 <= 2 (a^2 + b^2). And n2 is to
  // lie well within the range of floats, in which the normal is divided by its length.
  static M is_well_known(const V3& e1, const V3& e2, V n2, const V3& to_corner, V height) {
    const V l1 = fused_dot(e1, e1), l2 = fused_dot(e2, e2), spread = hn::Mul(l1, l2);
    const V sum = hn::MulAdd(hn::Max(l1, l2), spread, hn::Mul(fused_dot(to_corner, to_corner), n2));
    const M near = hn::Lt(sum, hn::Mul(all(0x1p23), hn::Mul(height, height)));
    const M turned = hn::Lt(spread, hn::Mul(all(0x1p54), n2));
    return hn::And(hn::And(near, turned), hn::And(hn::Gt(n2, all(0x1p-100)), hn::Lt(n2, all(0x1p100))));
  }
};

class Draft {
 public:
  Draft(const Bvh& bvh, const View& view, QuantisedTile& tile, TileDraft& draft)
      : bvh_(bvh), view_(view), tile_(tile), draft_(draft) {
    for (int a = 0; a < 3; ++a) low_[a] = all(infinity), high_[a] = all(-infinity);
  }

  /// Bits of those written.
  unsigned put(const PixelPlane& plane, const std::uint32_t* leaf, unsigned known, std::size_t lane) {
    const V x = plane.x(lane), y = plane.y(lane);
    const auto along = [&](int a) {
      return hn::MulAdd(y, all(view_.up[a]), hn::MulAdd(x, all(view_.right[a]), all(view_.forward[a])));
    };
    const V3 ray = {along(0), along(1), along(2)};
    const V3 eye = all(view_.eye);
    planes_.load(bvh_, eye, leaf, known);
    const V slope = fused_dot(planes_.normal, ray), t = hn::Div(planes_.height, slope);
    const M ahead = hn::And(hn::Gt(t, all(0.0)), hn::Lt(t, all(infinity)));
    const unsigned sound = bits_of(ahead) & planes_.well_known & known;
    if (sound == 0) return 0;
    const V position[3] = {hn::MulAdd(t, ray.x, eye.x), hn::MulAdd(t, ray.y, eye.y),
                           hn::MulAdd(t, ray.z, eye.z)};
    constexpr hn::Rebind<std::int32_t, D> whole;
    const auto side =  // towards the eye
        hn::DemoteTo(Units(), hn::DemoteTo(whole, hn::CopySign(all(1.0), hn::Neg(slope))));
    const M here = mask_of(sound);
    for (std::size_t a = 0; a < 3; ++a) {
      hn::Store(position[a], d, draft_.position[a] + lane);
      hn::Store(hn::Mul(planes_.unit[a], side), Units(), draft_.normal[a] + lane);
      low_[a] = hn::IfThenElse(here, hn::Min(low_[a], position[a]), low_[a]);
      high_[a] = hn::IfThenElse(here, hn::Max(high_[a], position[a]), high_[a]);
    }
    hn::Store(planes_.corners.ids(), leaves, draft_.source + lane);
    tile_.present[lane / packet_rays] |= static_cast<std::uint16_t>(sound << (lane % packet_rays));
    return sound;
  }

  void finish() {
    for (int a = 0; a < 3; ++a) {
      draft_.bounds.min[a] = hn::GetLane(hn::MinOfLanes(d, low_[a]));
      draft_.bounds.max[a] = hn::GetLane(hn::MaxOfLanes(d, high_[a]));
    }
  }

 private:
  const Bvh& bvh_;
  const View& view_;
  QuantisedTile& tile_;
  TileDraft& draft_;
  TrianglePlanes planes_;
  V low_[3], high_[3];
};

DraftLeft draft_kernel(const Bvh& bvh, const View& view, int x0, int y0, const TileHits& hits,
                       QuantisedTile& tile, TileDraft& draft) {
  constexpr std::size_t ahead = 3;  // packets
  const PixelPlane plane(view, x0, y0);
  const std::uint32_t count = bvh.leaf_count();
  DraftLeft left{};
  Draft some(bvh, view, tile, draft);
  const auto bits = [](hn::Mask<Ids> mask) { return mask_bits(leaves, mask); };
  for (std::size_t p = 0; p < ahead; ++p) prefetch(bvh, hits.leaf + p * packet_rays);
  for (std::size_t p = 0; p < tile_packets; ++p) {
    if (p + ahead < tile_packets) prefetch(bvh, hits.leaf + (p + ahead) * packet_rays);
    unsigned done = 0, known = 0, hit = 0;
    for (std::size_t i = 0; i < packet_rays; i += hn::Lanes(d)) {
      const std::size_t lane = p * packet_rays + i;
      const auto leaf = hn::Load(leaves, hits.leaf + lane);
      hit |= bits(hn::Ne(leaf, hn::Set(leaves, nothing_hit))) << i;
      const unsigned triangles = bits(hn::Lt(leaf, hn::Set(leaves, count)));
      known |= triangles << i;
      if (triangles != 0) done |= some.put(plane, hits.leaf + lane, triangles, lane) << i;
    }
    left.ill[p] = static_cast<std::uint16_t>(known & ~done);
    left.others[p] = static_cast<std::uint16_t>(hit & ~known);
  }
  some.finish();
  return left;
}

/// Lines of the cache, whole ones.
template <class T>
void stream(const T* from, std::size_t count, T* to) {
  constexpr hn::CappedTag<T, 64 / sizeof(T)> tag;
  for (std::size_t i = 0; i < count; i += hn::Lanes(tag)) hn::Stream(hn::Load(tag, from + i), tag, to + i);
}

void settle_kernel(const TileDraft& draft, QuantisedTile& tile) {
  constexpr std::size_t pair = 2 * packet_rays;
  for (std::size_t p = 0; p < tile_packets; ++p) {
    const std::size_t first = p * packet_rays;
    if (p % 2 == 0 && (tile.present[p] | tile.present[p + 1]) != 0)
      for (std::size_t a = 0; a < 3; ++a) stream(draft.normal[a] + first, pair, tile.normal[a] + first);
    if (tile.present[p] == 0) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      const V origin = all(tile.origin[static_cast<int>(a)]);
      alignas(64) float offset[packet_rays];
      for (std::size_t i = 0; i < packet_rays; i += hn::Lanes(d))
        hn::Store(hn::DemoteTo(half, hn::Sub(hn::Load(d, draft.position[a] + first + i), origin)), half,
                  offset + i);
      stream(offset, packet_rays, tile.position[a] + first);
    }
    stream(draft.source + first, packet_rays, tile.source + first);
  }
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(draft_kernel);
HWY_EXPORT(settle_kernel);

DraftLeft draft_receivers(const Bvh& bvh, const View& view, int x0, int y0, const TileHits& hits,
                          QuantisedTile& tile, TileDraft& draft) {
  return HWY_DYNAMIC_DISPATCH(draft_kernel)(bvh, view, x0, y0, hits, tile, draft);
}

void QuantisedTile::put(std::size_t lane, const SurfacePoint& point, TileDraft& draft) {
  if (point.primitive == no_id) return;
  present[lane / packet_rays] |= static_cast<std::uint16_t>(1u << (lane % packet_rays));
  draft.bounds.grow(point.position);
  for (int a = 0; a < 3; ++a) {
    draft.position[a][lane] = point.position[a];
    draft.normal[a][lane] = static_cast<std::int16_t>(std::lround(point.normal[a] * double{normal_units}));
  }
  draft.source[lane] = point.primitive;
}

void QuantisedTile::finish(const TileDraft& draft, const Vec3& eye) {
  any = !draft.bounds.empty();
  if (!any) return;
  bounds = draft.bounds;
  origin = bounds.center();
  // 2^-38 of a distance is at most 2^-27 of this.
  const Vec3 farthest = glm::max(glm::abs(bounds.min - eye), glm::abs(bounds.max - eye));
  extent = std::max(max_component(0.5 * bounds.extent()), 0x1p-10 * max_component(farthest));
  HWY_DYNAMIC_DISPATCH(settle_kernel)(draft, *this);
}

void publish_receivers() {
  hwy::FlushStream();
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
