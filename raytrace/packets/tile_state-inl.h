// One tile's shadow rays while a block is traversed (shadow_block.cpp): what is still asked, what is known, and the
// regions of the plane that primitives must touch to matter.

#if defined(GNOMON_RAYTRACE_PACKETS_TILE_STATE_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_TILE_STATE_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_TILE_STATE_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_TILE_STATE_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <bit>
#include <cfloat>

#include "raytrace/packets/blocked-inl.h"
#include "raytrace/packets/frustum-inl.h"
#include "raytrace/packets/projection-inl.h"
#include "raytrace/packets/shadow_block.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {

/// PrimitiveBounds in every lane.
struct LaneBounds {
  V u_min, u_max, v_min, v_max, nearest;

  static HWY_INLINE LaneBounds of(const PrimitiveBounds& b) {
    return {all(b.u_min), all(b.u_max), all(b.v_min), all(b.v_max), all(std::min(b.nearest, FLT_MAX))};
  }
  static HWY_INLINE LaneBounds of_row(const BoundsRows& rows, std::size_t i) {
    return {all(rows.u_min[i]), all(rows.u_max[i]), all(rows.v_min[i]), all(rows.v_max[i]),
            all(rows.nearest[i])};
  }
  /// Around the first `count` rows.
  static HWY_INLINE LaneBounds around(const BoundsRows& rows, std::size_t count) {
    LaneBounds b{all(inf), all(-inf), all(inf), all(-inf), all(-inf)};
    for (std::size_t i = 0; i < count; i += lanes()) {
      const M here = hn::FirstN(f, count - i);
      const auto at = [&](const float* row, V otherwise) {
        return hn::IfThenElse(here, hn::Load(f, row + i), otherwise);
      };
      b.u_min = hn::Min(b.u_min, at(rows.u_min, b.u_min)),
      b.u_max = hn::Max(b.u_max, at(rows.u_max, b.u_max));
      b.v_min = hn::Min(b.v_min, at(rows.v_min, b.v_min)),
      b.v_max = hn::Max(b.v_max, at(rows.v_max, b.v_max));
      b.nearest = hn::Max(b.nearest, at(rows.nearest, b.nearest));
    }
    return {hn::MinOfLanes(f, b.u_min), hn::MaxOfLanes(f, b.u_max), hn::MinOfLanes(f, b.v_min),
            hn::MaxOfLanes(f, b.v_max), hn::MaxOfLanes(f, b.nearest)};
  }
};

/// Bit i: the i-th of sixteen regions may be met within these bounds, in front of what it knows already.
inline unsigned met(const Packets& regions, const LaneBounds& b) {
  unsigned hit = 0;
  for (std::size_t i = 0; i < packet_rays; i += lanes()) {
    const auto at = [&](const float* row) { return hn::Load(f, row + i); };
    const M across = hn::And(hn::Ge(at(regions.u_max), b.u_min), hn::Le(at(regions.u_min), b.u_max));
    const M down = hn::And(hn::Ge(at(regions.v_max), b.v_min), hn::Le(at(regions.v_min), b.v_max));
    const M asks = hn::Le(at(regions.far_min), b.nearest);  // never where it is infinite
    hit |= bits_of(hn::And(asks, hn::And(across, down))) << i;
  }
  return hit;
}

/// Bit i: the i-th of the first `count` of rows may touch region k, in front of what that knows already.
inline std::uint64_t meeting(const Packets& regions, std::size_t k, const BoundsRows& rows,
                             std::size_t count) {
  const V u_min = all(regions.u_min[k]), u_max = all(regions.u_max[k]);
  const V v_min = all(regions.v_min[k]), v_max = all(regions.v_max[k]), far_min = all(regions.far_min[k]);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < count; i += lanes()) {
    const auto at = [&](const float* row) { return hn::Load(f, row + i); };
    const M across = hn::And(hn::Ge(u_max, at(rows.u_min)), hn::Le(u_min, at(rows.u_max)));
    const M down = hn::And(hn::Ge(v_max, at(rows.v_min)), hn::Le(v_min, at(rows.v_max)));
    const M asks = hn::Le(far_min, at(rows.nearest));
    bits |= std::uint64_t{bits_of(hn::And(asks, hn::And(across, down)))} << i;
  }
  return bits & ((std::uint64_t{1} << count) - 1);
}

/// Sixteen regions of the plane, each in one part or in two. A silhouette's rays start from two surfaces, and a
/// rectangle around both would be met by all that lies between them.
struct SplitRegions {
  Packets part[2];
  bool split = false;  ///< whether any has a second part

  unsigned met_by(const LaneBounds& bounds) const {
    return met(part[0], bounds) | (split ? met(part[1], bounds) : 0);
  }
  /// Returns the rows whose bounds meet region k.
  std::uint64_t meeting(std::size_t k, const BoundsRows& rows, std::size_t count) const {
    return HWY_NAMESPACE::meeting(part[0], k, rows, count) |
           (split ? HWY_NAMESPACE::meeting(part[1], k, rows, count) : 0);
  }
  float far_min() const {
    return std::min(smallest(part[0].far_min), split ? smallest(part[1].far_min) : inf);
  }
};

/// A rectangle of the plane.
struct Extent {
  float u_min = inf, u_max = -inf, v_min = inf, v_max = -inf;
  bool empty() const { return u_min > u_max; }
  float area() const { return empty() ? 0.0f : (u_max - u_min) * (v_max - v_min); }
  float width() const { return u_max - u_min; }
  float height() const { return v_max - v_min; }
  void grow(const Extent& e) {
    u_min = std::min(u_min, e.u_min), u_max = std::max(u_max, e.u_max);
    v_min = std::min(v_min, e.v_min), v_max = std::max(v_max, e.v_max);
  }
  void store(Packets& to, std::size_t i) const {
    to.u_min[i] = u_min, to.u_max[i] = u_max, to.v_min[i] = v_min, to.v_max[i] = v_max;
  }
  static Extent of(const Packets& from, std::size_t i) {
    return {from.u_min[i], from.u_max[i], from.v_min[i], from.v_max[i]};
  }
};

/// Two parts are worth their second test where together they are much smaller than the whole.
inline bool worth_splitting(const Extent& whole, const Extent& a, const Extent& b) {
  return !a.empty() && !b.empty() && a.area() + b.area() < 0.5f * whole.area();
}

/// One tile's rays: what is still asked, and what is known.
///
/// A leaf costs a tile 30 to 50 ns, whatever the scene, and a kept instance's leaf, whose corners are brought into the world
/// first, some 130; a single ray costs 0.3 to 0.6 us through the wide tree, and 2 to 4 us where that must ask for alpha masks.
/// So a tile may meet a number of leaves for each of its rays; the rays of a tile that meets more go on one by one.
class TileState {
 public:
  /// `masks`: whether the world has any.
  void start(const ShadowTileRays& tile, bool masks) {
    rays_ = tile.rays, out_ = tile.shadows;
    out_->shadowed.fill(0), out_->ambiguous.fill(0), out_->ambiguous_count = 0;
    packets_.split = false;
    for (std::size_t p = 0; p < tile_packets; ++p) {
      for (std::size_t i = 0; i < packet_rays; i += lanes()) {
        const std::size_t at = p * packet_rays + i;
        const M alive = mask_of(static_cast<unsigned>(rays_->alive[p]) >> i);
        hn::Store(hn::IfThenElse(alive, hn::Load(f, rays_->far + at), all(inf)), f, far_ + at);
      }
    }
    find_extents();
    for (std::size_t p = 0; p < tile_packets; ++p) update(p);
    leaves_left_ = std::int64_t{rays()} * (masks ? most_leaves_of_masked : most_leaves);
  }

  /// The number of them, decided or not.
  unsigned rays() const {
    unsigned rays = 0;
    for (const std::uint16_t alive : rays_->alive) rays += static_cast<unsigned>(std::popcount(alive));
    return rays;
  }

  /// Whether the tile is still worth its part in so many more leaves, of a kept instance or not.
  bool affords(std::uint32_t leaves, bool placed) {
    return (leaves_left_ -= std::int64_t{leaves} * (placed ? placed_price : 1)) >= 0;
  }
  /// What is not yet decided is ambiguous, and what it may intersect is not known.
  void leave_to_single_rays() {
    for (std::size_t p = 0; p < tile_packets; ++p) {
      out_->ambiguous[p] |= rays_->alive[p];
      packets_.part[0].far_min[p] = packets_.part[1].far_min[p] = inf;
    }
    std::fill_n(far_, tile_rays, inf);
    out_->ambiguous_count = TileShadows::most_ambiguous + 1;
  }

  const SplitRegions& packets() const { return packets_; }
  float far_min() const { return packets_.far_min(); }

  /// The tile's own place in the block's regions.
  void enter(SplitRegions& regions, std::size_t t) {
    Extent whole, part[2];
    for (const Packets& p : packets_.part)
      for (std::size_t i = 0; i < tile_packets; ++i) whole.grow(Extent::of(p, i));
    const bool by_u = whole.width() > whole.height();
    const float middle = by_u ? 0.5f * (whole.u_min + whole.u_max) : 0.5f * (whole.v_min + whole.v_max);
    std::array<unsigned, 2> second{};
    for (std::size_t k = 0; k < 2; ++k)
      for (std::size_t i = 0; i < tile_packets; ++i) {
        const Extent e = Extent::of(packets_.part[k], i);
        if (e.empty()) continue;
        const bool beyond = (by_u ? e.u_min + e.u_max : e.v_min + e.v_max) > 2.0f * middle;
        part[beyond].grow(e);
        second[k] |= static_cast<unsigned>(beyond) << i;
      }
    divided_ = packets_.split && worth_splitting(whole, part[0], part[1]);
    second_ = second;
    if (!divided_) part[0] = whole, part[1] = Extent{};
    regions.split |= divided_;
    part[0].store(regions.part[0], t), part[1].store(regions.part[1], t);
    update_regions(regions, t);
  }
  void update_regions(SplitRegions& regions, std::size_t t) const {
    if (!divided_) {
      regions.part[0].far_min[t] = far_min(), regions.part[1].far_min[t] = inf;
      return;
    }
    V least[2] = {all(inf), all(inf)};
    for (std::size_t k = 0; k < (packets_.split ? 2 : 1); ++k)
      for (std::size_t i = 0; i < tile_packets; i += lanes()) {
        const V far = hn::Load(f, packets_.part[k].far_min + i);
        const M beyond = mask_of(second_[k] >> i);
        least[0] = hn::Min(least[0], hn::IfThenElse(beyond, all(inf), far));
        least[1] = hn::Min(least[1], hn::IfThenElse(beyond, far, all(inf)));
      }
    for (std::size_t k = 0; k < 2; ++k) regions.part[k].far_min[t] = hn::GetLane(hn::MinOfLanes(f, least[k]));
  }

  /// True when rays have been found to be shadowed.
  bool test_all_by_plane(const LaneNumbers& plane, const Blocker& blocker) {
    bool any = false;
    for (std::size_t p = 0; p < tile_packets; ++p) any |= test_packet<true>(plane, blocker, 0, p);
    return any;
  }
  /// Returns those bits of `leaves`, rows, that some ray of the packet does not surely miss; `not_from`: by row, the rays
  /// that leave it are not blocked by the row.
  std::uint64_t not_missed(const BoundsRows& rows, const EdgeLines& lines, const std::uint32_t* not_from,
                           std::uint64_t leaves, std::size_t packet) const {
    std::uint64_t met = 0;
    for (std::uint64_t left = leaves; left != 0; left &= left - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(left));
      const auto side = [&](std::size_t e, V u, V v) {
        return value(all(lines.across[e][i]), all(lines.down[e][i]), all(lines.constant[e][i]), u, v);
      };
      M any = hn::Lt(all(inf), all(inf));
      for (std::size_t k = 0; k < packet_steps; ++k) {
        const std::size_t at = packet * packet_rays + k * lanes();
        const V u = hn::Load(f, rays_->u + at), v = hn::Load(f, rays_->v + at);
        const M inside = hn::Ge(hn::Min(side(0, u, v), hn::Min(side(1, u, v), side(2, u, v))), all(0.0f));
        const M asks = hn::And(inside, hn::Le(hn::Load(f, far_ + at), all(rows.nearest[i])));
        const auto leaves_it = hn::Eq(hn::Load(ids, rays_->source + at), hn::Set(ids, not_from[i]));
        any = hn::Or(any, hn::AndNot(hn::RebindMask(f, leaves_it), asks));
      }
      met |= std::uint64_t{!hn::AllFalse(f, any)} << i;
    }
    return met;
  }

  /// Whether a ray that is still asked for is within the bounds, and the primitive may be before its end.
  bool holds_ray(const LaneBounds& b) const {
    for (unsigned left = packets_.met_by(b); left != 0; left &= left - 1) {
      const auto packet = static_cast<std::size_t>(std::countr_zero(left));
      for (std::size_t k = 0; k < packet_steps; ++k) {
        const std::size_t at = packet * packet_rays + k * lanes();
        const V u = hn::Load(f, rays_->u + at), v = hn::Load(f, rays_->v + at);
        const M across = hn::And(hn::Ge(u, b.u_min), hn::Le(u, b.u_max));
        const M down = hn::And(hn::Ge(v, b.v_min), hn::Le(v, b.v_max));
        const M asks = hn::Le(hn::Load(f, far_ + at), b.nearest);
        if (!hn::AllFalse(f, hn::And(asks, hn::And(across, down)))) return true;
      }
    }
    return false;
  }

  template <bool plane>
  HWY_INLINE bool test_packet(const LaneNumbers& primitive, const Blocker& blocker, std::uint32_t leaf,
                              std::size_t packet) {
    M any = hn::Lt(all(inf), all(inf));
    for (std::size_t k = 0; k < packet_steps; ++k)
      any = hn::Or(any, blocked<plane>(primitive, blocker, packet, k).perhaps);
    return !hn::AllFalse(f, any) && take<plane>(primitive, blocker, leaf, packet);
  }

  void finish() {
    for (std::size_t p = 0; p < tile_packets; ++p)
      out_->ambiguous[p] &= static_cast<std::uint16_t>(~out_->shadowed[p]);
  }

 private:
  static constexpr int most_leaves = 32,
                       most_leaves_of_masked = 128;  ///< for a ray; the comment of the class
  static constexpr int placed_price = 4;             ///< of an instance's leaf, in others

  template <bool plane>
  HWY_INLINE BlockedRays<plane> blocked(const LaneNumbers& primitive, const Blocker& blocker,
                                        std::size_t packet, std::size_t step) const {
    return {primitive, blocker, *rays_, far_, packet * packet_rays + step * lanes()};
  }
  template <bool plane>
  HWY_NOINLINE bool take(const LaneNumbers& primitive, const Blocker& blocker, std::uint32_t leaf,
                         std::size_t packet) {
    unsigned shadowed = 0;
    for (std::size_t k = 0; k < packet_steps; ++k) {
      const std::size_t first = k * lanes(), at = packet * packet_rays + first;
      const BlockedRays<plane> rays = blocked<plane>(primitive, blocker, packet, k);
      M surely = blocker.may_be_sure ? rays.surely(primitive) : hn::Lt(all(inf), all(inf));
      unsigned bits = bits_of(surely), open = bits_of(rays.perhaps) & ~bits;
      if (blocker.mask != nullptr && bits != 0) [[unlikely]] {
        const V u = hn::Load(f, rays_->u + at), v = hn::Load(f, rays_->v + at);
        const MaskBits mask = look_up(*blocker.mask, u, v, bits);
        open |= bits & ~(mask.opaque | mask.holes), bits = mask.opaque;
        surely = mask_of(bits);
      }
      out_->ambiguous[packet] |= static_cast<std::uint16_t>(open << first);
      if (!plane) out_->note(leaf, at, open);
      hn::Store(hn::IfThenElse(surely, all(inf), rays.far), f, far_ + at);
      shadowed |= bits << first;
    }
    if (shadowed == 0) return false;
    out_->shadowed[packet] |= static_cast<std::uint16_t>(shadowed);
    update(packet);
    return true;
  }

  Extent extent_of(std::size_t p, unsigned bits) const {
    V u_min = all(inf), u_max = all(-inf), v_min = all(inf), v_max = all(-inf);
    for (std::size_t i = 0; i < packet_rays; i += lanes()) {
      const M in = mask_of(bits >> i);
      const V u = hn::Load(f, rays_->u + p * packet_rays + i),
              v = hn::Load(f, rays_->v + p * packet_rays + i);
      u_min = hn::Min(u_min, hn::IfThenElse(in, u, u_min)),
      u_max = hn::Max(u_max, hn::IfThenElse(in, u, u_max));
      v_min = hn::Min(v_min, hn::IfThenElse(in, v, v_min)),
      v_max = hn::Max(v_max, hn::IfThenElse(in, v, v_max));
    }
    return {hn::GetLane(hn::MinOfLanes(f, u_min)), hn::GetLane(hn::MaxOfLanes(f, u_max)),
            hn::GetLane(hn::MinOfLanes(f, v_min)), hn::GetLane(hn::MaxOfLanes(f, v_max))};
  }

  /// Packets that are much wider than the tile's others are divided.
  void find_extents() {
    float width = 0.0f, height = 0.0f, count = 0.0f;
    Packets& whole = packets_.part[0];
    beyond_.fill(0);
    for (std::size_t p = 0; p < tile_packets; ++p) {
      const Extent e = extent_of(p, rays_->alive[p]);
      e.store(whole, p), Extent{}.store(packets_.part[1], p);
      if (!e.empty()) width += e.width(), height += e.height(), count += 1.0f;
    }
    for (std::size_t p = 0; p < tile_packets; ++p) {
      const Extent e = Extent::of(whole, p);
      if (!e.empty() && (count * e.width() > 2.0f * width || count * e.height() > 2.0f * height))
        divide(p, e);
    }
  }

  /// Across the middle of the longer side, where that pays.
  void divide(std::size_t p, const Extent& whole) {
    const unsigned alive = rays_->alive[p];
    const bool by_u = whole.width() > whole.height();
    const V middle = all(by_u ? 0.5f * (whole.u_min + whole.u_max) : 0.5f * (whole.v_min + whole.v_max));
    unsigned beyond = 0;
    for (std::size_t i = 0; i < packet_rays; i += lanes()) {
      const float* along = (by_u ? rays_->u : rays_->v) + p * packet_rays + i;
      beyond |= bits_of(hn::Gt(hn::Load(f, along), middle)) << i;
    }
    const Extent a = extent_of(p, alive & ~beyond), b = extent_of(p, alive & beyond);
    if (!worth_splitting(whole, a, b)) return;
    packets_.split = true;
    a.store(packets_.part[0], p), b.store(packets_.part[1], p);
    beyond_[p] = static_cast<std::uint16_t>(beyond);
  }
  void update(std::size_t p) {
    packets_.part[1].far_min[p] = inf;
    if (beyond_[p] == 0) {
      packets_.part[0].far_min[p] = smallest(far_ + p * packet_rays);
      return;
    }
    V least[2] = {all(inf), all(inf)};
    for (std::size_t i = 0; i < packet_rays; i += lanes()) {
      const V far = hn::Load(f, far_ + p * packet_rays + i);
      const M second = mask_of(static_cast<unsigned>(beyond_[p]) >> i);
      least[0] = hn::Min(least[0], hn::IfThenElse(second, all(inf), far));
      least[1] = hn::Min(least[1], hn::IfThenElse(second, far, all(inf)));
    }
    for (std::size_t k = 0; k < 2; ++k)
      packets_.part[k].far_min[p] = hn::GetLane(hn::MinOfLanes(f, least[k]));
  }

  const TileRays* rays_ = nullptr;
  TileShadows* out_ = nullptr;
  SplitRegions packets_;
  LaneMask beyond_;                 ///< of each packet the rays of its second part
  std::array<unsigned, 2> second_;  ///< packets' first and second parts that are of the tile's second part
  bool divided_ = false;
  std::int64_t leaves_left_ = 0;  ///< that the tile may still meet
  alignas(64) float far_[tile_rays];
};

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
