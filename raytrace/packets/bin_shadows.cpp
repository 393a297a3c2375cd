#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packets/bin_shadows.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <bit>

#include "raytrace/packets/bin_shadows.h"
#include "raytrace/packets/blocked-inl.h"
#include "raytrace/packets/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {

using Place = hn::RebindToSigned<F>;
using Places = hn::Vec<Place>;
constexpr Place place;

/// A vector of rays: what is still asked of them, and where in their bins they lie.
struct alignas(64) TileState {
  float far[tile_rays];  ///< +infinity: nothing is asked any more
  std::int32_t u_in_bin[tile_rays], v_in_bin[tile_rays];
};

/// A vector's rays that share a bin, and of the bin's list what has not been looked at yet.
struct Group {
  std::uint32_t lane, bits;   ///< of the vector's first ray; which of its rays
  std::uint32_t next, end;    ///< of the list
  std::uint32_t first, last;  ///< candidates: list places, their primitives on their way to the cache
};

/// A vector of rays against primitives.
class BinShadows {
 public:
  BinShadows(const TileRays& rays, TileState& state, std::size_t at, TileShadows& out)
      : u_(hn::Load(f, rays.u + at)),
        v_(hn::Load(f, rays.v + at)),
        far_(hn::Load(f, state.far + at)),
        source_(hn::Load(ids, rays.source + at)),
        at_(at),
        state_(state),
        out_(out) {}
  ~BinShadows() { hn::Store(far_, f, state_.far + at_); }
  BinShadows(const BinShadows&) = delete;
  BinShadows& operator=(const BinShadows&) = delete;

  unsigned shadowed() const { return shadowed_; }
  unsigned ambiguous() const { return ambiguous_; }
  float least_far(M asked) const {
    return hn::GetLane(hn::MinOfLanes(f, hn::IfThenElse(asked, far_, all(inf))));
  }

  /// True when rays have been found to be shadowed.
  template <bool plane>
  bool test(const PrimitiveEdges& p, std::uint32_t leaf, M asked) {
    const Blocked blocked = blocked_by<plane>(p, RayTest{Functions(p)}, u_, v_, far_, source_, asked);
    if (hn::AllFalse(f, blocked.perhaps)) return false;
    const unsigned sure = bits_of(blocked.surely);
    const unsigned open = bits_of(blocked.perhaps) & ~sure;
    ambiguous_ |= open;
    if (!plane) out_.note(leaf, at_, open);
    if (sure == 0) return false;
    shadowed_ |= sure;
    far_ = hn::IfThenElse(blocked.surely, all(inf), far_);
    return true;
  }

 private:
  V u_, v_, far_;
  hn::Vec<I> source_;
  unsigned shadowed_ = 0, ambiguous_ = 0;
  std::size_t at_;
  TileState& state_;
  TileShadows& out_;
};

/// The box of some rays in their bin, against the boxes of as many primitives at once.
class Extent {
 public:
  Extent(const TileState& state, std::size_t at, M asked) {
    const auto mask = hn::RebindMask(place, asked);
    const auto u = hn::Load(place, state.u_in_bin + at), v = hn::Load(place, state.v_in_bin + at);
    const auto low = [&](Places p) {
      return hn::MinOfLanes(place, hn::IfThenElse(mask, p, hn::Set(place, 255)));
    };
    const auto high = [&](Places p) { return hn::MaxOfLanes(place, hn::IfThenElseZero(mask, p)); };
    u_min_ = low(u), u_max_ = high(u), v_min_ = low(v), v_max_ = high(v);
  }
  /// Bits of list places `first` on, as many as there are lanes; not those behind `least`.
  unsigned hits(const LightBins& bins, std::uint32_t first, std::uint32_t end, float least) const {
    const auto box = hn::LoadU(place, reinterpret_cast<const std::int32_t*>(bins.box.data()) + first);
    const auto byte = hn::Set(place, 255);
    const auto part = [&](auto shifted) { return hn::And(shifted, byte); };
    auto apart = hn::Or(hn::Gt(part(box), u_max_), hn::Gt(u_min_, part(hn::ShiftRight<8>(box))));
    apart = hn::Or(apart, hn::Or(hn::Gt(part(hn::ShiftRight<16>(box)), v_max_),
                                 hn::Gt(v_min_, part(hn::ShiftRight<24>(box)))));
    const M behind = hn::Lt(hn::LoadU(f, bins.nearest.data() + first), all(least));
    const unsigned hit = bits_of(hn::Not(hn::Or(behind, hn::RebindMask(f, apart))));
    return end - first < lanes() ? hit & ((1u << (end - first)) - 1) : hit;
  }

 private:
  Places u_min_, u_max_, v_min_, v_max_;
};

/// A tile in three rounds, so that what one round asks memory for is there in the next: which bins the rays
/// lie in; which primitives of the bins' lists they may intersect; the tests.
class BinTile {
 public:
  BinTile(const LightBins& bins, const EdgeSetup& setup, const TileRays& rays, TileShadows& out)
      : bins_(bins), setup_(setup), rays_(rays), out_(out), columns_(bins.columns()) {}

  void run(LaneMask& outside) {
    out_.ambiguous_count = 0;
    out_.shadowed.fill(0), out_.ambiguous.fill(0);
    for (std::size_t p = 0; p < tile_packets; ++p) {
      unsigned out_of_bins = 0;
      for (std::size_t i = 0; i < packet_rays && rays_.alive[p] != 0; i += lanes())
        out_of_bins |= find_groups(p * packet_rays + i) << i;
      outside[p] = static_cast<std::uint16_t>(out_of_bins);
    }
    for (std::size_t g = 0; g < group_count_; ++g) gather(groups_[g]);
    for (std::size_t g = 0; g < group_count_; ++g) finish(groups_[g]);
    for (std::size_t p = 0; p < tile_packets; ++p) {
      outside[p] &= static_cast<std::uint16_t>(~out_.shadowed[p]);
      out_.ambiguous[p] = static_cast<std::uint16_t>((out_.ambiguous[p] | outside[p]) & ~out_.shadowed[p]);
    }
  }

 private:
  /// Returns the bits of the rays outside the bins.
  unsigned find_groups(std::size_t at) {
    const unsigned alive =
        static_cast<unsigned>(rays_.alive[at / packet_rays]) >> (at % packet_rays) & ((1u << lanes()) - 1);
    if (alive == 0) return 0;
    hn::Store(hn::IfThenElse(mask_of(alive), hn::Load(f, rays_.far + at), all(inf)), f, state_.far + at);
    unsigned left = alive;
    if (!setup_.planes.empty()) {
      BinShadows some(rays_, state_, at, out_);
      for (const PrimitiveEdges& plane : setup_.planes) some.test<true>(plane, 0, mask_of(alive));
      keep(some, at);
      left &= ~some.shadowed();
    }
    left &= ~beyond_limits(at);
    const unsigned outside = find_bins(at, left);
    left &= ~outside;
    while (left != 0) {
      const std::int32_t bin = bin_[std::countr_zero(left)];
      const auto same = hn::Eq(hn::Load(place, bin_), hn::Set(place, bin));
      const unsigned bits = left & bits_of(hn::RebindMask(f, same));
      left &= ~bits;
      const std::uint32_t begin = bins_.first[static_cast<std::size_t>(bin)];
      const std::uint32_t end = bins_.first[static_cast<std::size_t>(bin) + 1];
      if (begin == end) continue;
      groups_[group_count_++] = {static_cast<std::uint32_t>(at), bits, begin, end, 0, 0};
      for (const std::uint32_t i : {begin, begin + 16}) {  // where there is no more, nothing is asked for
        __builtin_prefetch(bins_.nearest.data() + i), __builtin_prefetch(bins_.leaf.data() + i);
        __builtin_prefetch(bins_.box.data() + i);
      }
    }
    return outside;
  }

  /// Bits of the rays that nothing finite can intersect.
  unsigned beyond_limits(std::size_t at) const {
    const PlaneLimits& limits = bins_.limits;
    const auto beyond = [at](const float* from, float min, float max) {
      const V value = hn::Load(f, from + at);
      return hn::Or(hn::Lt(value, all(min)), hn::Gt(value, all(max)));
    };
    return bits_of(
        hn::Or(beyond(rays_.u, limits.u_min, limits.u_max), beyond(rays_.v, limits.v_min, limits.v_max)));
  }

  /// Stores the rays' bins, and where in them they lie; returns the bits of those outside.
  unsigned find_bins(std::size_t at, unsigned asked) {
    M within = mask_of(asked);
    const auto along = [&](const float* from, const BinAxis& axis, std::int32_t* in_bin) {
      const V step = hn::Mul(hn::Sub(hn::Load(f, from + at), all(axis.origin)), all(axis.per_width));
      within = hn::And(within,
                       hn::And(hn::Ge(step, all(0.0f)), hn::Lt(step, all(static_cast<float>(axis.count)))));
      const auto fine = hn::ConvertTo(place, hn::Mul(step, all(256.0f)));
      hn::Store(hn::And(fine, hn::Set(place, 255)), place, in_bin + at);
      return hn::ShiftRight<8>(fine);
    };
    const auto x = along(rays_.u, bins_.u, state_.u_in_bin);
    const auto y = along(rays_.v, bins_.v, state_.v_in_bin);
    hn::Store(hn::Add(hn::Mul(y, hn::Set(place, columns_)), x), place, bin_);
    return asked & ~bits_of(within);
  }

  /// The first of the list's primitives that the rays may intersect.
  void gather(Group& group) {
    constexpr std::uint32_t few = 4;      // not worth telling apart
    constexpr std::uint32_t enough = 24;  // one of them may end the search
    const M asked = mask_of(group.bits);
    const V far = hn::IfThenElse(asked, hn::Load(f, state_.far + group.lane), all(inf));
    const float least = hn::GetLane(hn::MinOfLanes(f, far));
    group.first = group.last = candidate_count_;
    if (bins_.nearest[group.next] < least) {
      group.next = group.end;
      return;
    }
    if (candidate_count_ + packet_rays > most_candidates) return;
    if (group.end - group.next <= few) {
      while (group.next < group.end && !(bins_.nearest[group.next] < least)) add_candidate(group.next++);
      group.next = group.end;
    } else {
      const Extent extent(state_, group.lane, asked);
      while (candidate_count_ - group.first < enough && candidate_count_ + packet_rays <= most_candidates) {
        for (unsigned hit = extent.hits(bins_, group.next, group.end, least); hit != 0; hit &= hit - 1)
          add_candidate(group.next + static_cast<std::uint32_t>(std::countr_zero(hit)));
        group.next = std::min(group.next + static_cast<std::uint32_t>(lanes()), group.end);
        if (group.next == group.end || bins_.nearest[group.next] < least) break;
      }
      if (group.next < group.end && bins_.nearest[group.next] < least) group.next = group.end;
    }
    group.last = candidate_count_;
  }
  void add_candidate(std::uint32_t i) {
    __builtin_prefetch(&bins_.primitives[bins_.leaf[i]]);
    candidates_[candidate_count_++] = i;
  }

  void finish(const Group& group) {
    if (group.first == group.last && group.next == group.end) return;
    const M asked = mask_of(group.bits);
    BinShadows some(rays_, state_, group.lane, out_);
    float least = some.least_far(asked);
    const auto test = [&](std::uint32_t i) {
      const std::uint32_t leaf = bins_.leaf[i];
      if (some.test<false>(bins_.primitives[leaf], leaf, asked)) least = some.least_far(asked);
    };
    for (std::uint32_t c = group.first; c != group.last && !(bins_.nearest[candidates_[c]] < least); ++c)
      test(candidates_[c]);
    if (group.next < group.end && !(bins_.nearest[group.next] < least)) {
      const Extent extent(state_, group.lane, asked);
      for (std::uint32_t next = group.next; next < group.end && !(bins_.nearest[next] < least);
           next += static_cast<std::uint32_t>(lanes())) {
        const unsigned all_hit = extent.hits(bins_, next, group.end, least);
        for (unsigned hit = all_hit; hit != 0; hit &= hit - 1)
          __builtin_prefetch(
              &bins_.primitives[bins_.leaf[next + static_cast<std::uint32_t>(std::countr_zero(hit))]]);
        for (unsigned hit = all_hit; hit != 0; hit &= hit - 1)
          test(next + static_cast<std::uint32_t>(std::countr_zero(hit)));
      }
    }
    keep(some, group.lane);
  }

  void keep(const BinShadows& some, std::size_t at) {
    const std::size_t p = at / packet_rays, shift = at % packet_rays;
    out_.shadowed[p] |= static_cast<std::uint16_t>(some.shadowed() << shift);
    out_.ambiguous[p] |= static_cast<std::uint16_t>(some.ambiguous() << shift);
  }

  const LightBins& bins_;
  const EdgeSetup& setup_;
  const TileRays& rays_;
  TileShadows& out_;
  int columns_;
  TileState state_;
  alignas(64) std::int32_t bin_[packet_rays];
  Group groups_[tile_rays];
  std::size_t group_count_ = 0;
  static constexpr std::uint32_t most_candidates = 2048;
  std::uint32_t candidates_[most_candidates];
  std::uint32_t candidate_count_ = 0;
};

void shadows_kernel(const LightBins& bins, const EdgeSetup& setup, const TileRays& rays, TileShadows& out,
                    LaneMask& outside) {
  BinTile(bins, setup, rays, out).run(outside);
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(shadows_kernel);

void shadows_in_bins(const LightBins& bins, const EdgeSetup& setup, const TileRays& rays,
                     TileShadows& shadows, LaneMask& outside) {
  HWY_DYNAMIC_DISPATCH(shadows_kernel)(bins, setup, rays, shadows, outside);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
