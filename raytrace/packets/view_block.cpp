#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packets/view_block.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "raytrace/packets/block_plane-inl.h"
#include "raytrace/packets/edge_setup_rows.h"
#include "raytrace/packets/mask_lanes-inl.h"
#include "raytrace/packets/packet_grid.h"
#include "raytrace/packets/pending_leaves-inl.h"
#include "raytrace/packets/view_block.h"
#include "raytrace/precision/facing.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {

/// Finds the closest hits of a block: each ray's best sure hit is known to have a reciprocal depth in [low, high], and no
/// other hit is nearer than `rival`.
class BlockClosest {
 public:
  BlockClosest(const Structures& s, const EdgeSetup& setup, const View& view, const BlockRect& rect,
               BlockHits& out)
      : s_(s),
        setup_(setup),
        pass_(edge_setup_pass(s, setup)),
        plane_(s, setup, view, rect),
        packets_(plane_.packets),
        rect_(rect),
        out_(out),
        pending_(s.bvh) {
    start();
  }

  void run() {
    for (std::uint32_t k = 0; k < setup_.planes.size(); ++k) {
      rows_[0].set(0, setup_.planes[k]);
      const LaneNumbers numbers(rows_[0], 0);
      test_all<true>(numbers, {first_plane + k, (setup_.planes[k].id & never_sure) == 0}, packets_);
    }
    Packets intervals;
    for (std::size_t p = 0; p < tile_packets; ++p) {
      intervals.u_min[p] = plane_.u_min, intervals.u_max[p] = plane_.u_max;
      intervals.v_min[p] = plane_.v_min, intervals.v_max[p] = plane_.v_max;
    }
    const Frustum frustum(s_.bvh, setup_, intervals);
    update_limit();
    traverse_block(
        s_.bvh, frustum, [&] { return limit_; }, [&](const BoxRef& box) { return !is_hidden(box); },
        [&](const BoxRef& box, LeafRange leaves) {
          if (!is_hidden(box)) put(leaves);
        });
    while (pending_.count() > 0) flush();
    finish();
  }

 private:
  static constexpr std::uint32_t batch = 32;

  // Rays outside the picture ask nothing.
  void start() {
    for (std::size_t y = 0; y < block_side; ++y)
      for (std::size_t x = 0; x < block_side; ++x) {
        const std::size_t packet = packet_at(x, y);
        const unsigned alive = alive_in(static_cast<int>(4 * x), static_cast<int>(4 * y));
        nearest_asked_[y][x] = alive != 0 ? 0.0f : inf;
        for (std::size_t i = 0; i < packet_rays; i += lanes()) {
          const std::size_t at = packet * packet_rays + i;
          const V first = hn::IfThenElse(mask_of(alive >> i), all(0.0f), all(inf));
          hn::Store(first, f, low_ + at), hn::Store(first, f, high_ + at),
              hn::Store(all(-inf), f, rival_ + at);
          hn::Store(hn::IfThenElse(hn::RebindMask(ids, mask_of(alive >> i)), hn::Set(ids, nothing_hit),
                                   hn::Set(ids, ambiguous_hit)),
                    ids, leaf_at(at));
        }
      }
    out_.ambiguous_hits.clear(), out_.all_ambiguous = true;
  }

  /// Returns the rays of the packet with this corner in the block that are still asked for.
  unsigned alive_in(int x, int y) const {
    const int columns = rect_.x1 - rect_.x0 - x, rows = rect_.y1 - rect_.y0 - y;
    if (columns >= 4 && rows >= 4) return 0xffff;
    unsigned alive = 0;
    for (int i = 0; i < static_cast<int>(packet_rays); ++i)
      if (i % 4 < columns && i / 4 < rows) alive |= 1u << i;
    return alive;
  }

  std::uint32_t* leaf_at(std::size_t place) { return out_.tiles[place / tile_rays].leaf + place % tile_rays; }

  void put(LeafRange run) {
    pending_.put(run, 0);
    while (pending_.count() >= std::size_t{2} * run_size) flush();
  }

  /// Whether no ray of the block can find anything in the box that is nearer than what it has.
  bool is_hidden(const BoxRef& box) const {
    const BoxPlace place = plane_.packets_of(box);
    return !is_asked(place.nearest, place.covered);
  }
  bool is_asked(float nearest, const PacketRect& covered) const {
    if (covered.x0 > covered.x1) return false;
    for (int y = covered.y0; y <= covered.y1; ++y)
      if (asking(nearest, covered, y) != 0) return true;
    return false;
  }

  /// Bits of the row's packets that ask for something of that reciprocal depth.
  unsigned asking(float nearest, const PacketRect& covered, int y) const {
    const float* row = nearest_asked_[y - packets_.y0];
    unsigned bits = 0;
    for (std::size_t i = 0; i < block_side; i += lanes())
      bits |= bits_of(hn::Not(hn::Lt(all(nearest), hn::Load(f, row + i)))) << i;
    return bits & ((2u << (covered.x1 - packets_.x0)) - (1u << (covered.x0 - packets_.x0)));
  }

  /// A primitive that packets ask for.
  struct Asked {
    std::uint32_t leaf;
    PacketRect covered;
  };

  /// Finds the numbers of those of the longest waiting ones that packets ask for, and tries the nearest of them first.
  void flush() {
    const std::size_t waiting = std::min<std::size_t>(pending_.count(), batch);
    alignas(64) float nearest[batch + packet_rays] = {};
    alignas(64) std::uint32_t rank[batch + packet_rays], order[batch];
    unsigned never[batch / 8], backs[batch / 8] = {};
    std::size_t count = 0;
    for (std::size_t first = 0; first < waiting; first += PacketSpans::together) {
      const std::size_t together = std::min(PacketSpans::together, waiting - first);
      count = find_asked(pending_.first(waiting).subspan(first, together), count, nearest);
    }
    pending_.drop(waiting);
    for (std::size_t first = 0; first < count; first += 8) {
      std::uint32_t leaves[8];
      const std::size_t together = std::min<std::size_t>(8, count - first);
      for (std::size_t i = 0; i < together; ++i) leaves[i] = asked_[first + i].leaf;
      never[first / 8] = set_up_leaves(s_, pass_, {leaves, together}, rows_[first / 8], masks_ + first);
      if (s_.hides_backs) backs[first / 8] = leave_out_backs({leaves, together}, never[first / 8]);
    }
    rank_falling(nearest, count, rank);
    for (std::uint32_t i = 0; i < count; ++i) order[rank[i]] = i;
    bool taken = false;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = order[k], b = at / 8, i = at % 8;
      if ((backs[b] >> i & 1) != 0) continue;
      const Tested tested{asked_[at].leaf, (never[b] >> i & 1) == 0,
                          masks_[at].cells != nullptr ? masks_ + at : nullptr};
      taken |= test_packets(LaneNumbers(rows_[b], i), tested, nearest[at], asked_[at].covered);
    }
    if (taken) update_limit();
  }

  /// Adds those of up to PacketSpans::together leaves that packets ask for to `count` others; returns how many there are
  /// then.
  std::size_t find_asked(std::span<const std::uint32_t> leaves, std::size_t count, float* nearest) {
    BoundsRows bounds;
    EdgeLines lines;
    PacketSpans u, v;
    plane_.projection().of_leaves(leaves, bounds, lines);
    place_bounds(plane_.columns, 0x1p-21 * std::abs(plane_.columns.first), bounds.u_min, bounds.u_max, u);
    place_bounds(plane_.rows, 0x1p-21 * std::abs(plane_.rows.first), bounds.v_min, bounds.v_max, v);
    const unsigned not_missed = met_by_rays(u, v, lines);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      if ((not_missed >> i & 1) == 0) continue;
      const PacketRect covered{std::max(u.first[i], packets_.x0), std::max(v.first[i], packets_.y0),
                               std::min(u.last[i], packets_.x1), std::min(v.last[i], packets_.y1)};
      if (!is_asked(bounds.nearest[i], covered)) continue;
      asked_[count] = {leaves[i], covered}, nearest[count++] = bounds.nearest[i];
    }
    return count;
  }

  /// Bits of those leaves that one of their rays does not surely miss. Looked at are those of up to two rays each
  /// way, since most triangles that are smaller than pixels lie between all rays.
  unsigned met_by_rays(const PacketSpans& u, const PacketSpans& v, const EdgeLines& lines) const {
    const V u_two = all(static_cast<float>(1.5 * plane_.columns.width));
    const V v_two = all(static_cast<float>(1.5 * plane_.rows.width));
    unsigned met = 0;
    for (std::size_t i = 0; i < PacketSpans::together; i += lanes()) {
      const auto at = [&](const float* row) { return hn::Load(f, row + i); };
      const V at_u[2] = {at(u.low), at(u.high)}, at_v[2] = {at(v.low), at(v.high)};
      auto may = hn::Or(hn::Gt(hn::Sub(at_u[1], at_u[0]), u_two), hn::Gt(hn::Sub(at_v[1], at_v[0]), v_two));
      for (std::size_t ray = 0; ray < 4; ++ray) {
        const auto side = [&](std::size_t e) {
          return value(at(lines.across[e]), at(lines.down[e]), at(lines.constant[e]), at_u[ray % 2],
                       at_v[ray / 2]);
        };
        may = hn::Or(may, hn::Ge(hn::Min(side(0), hn::Min(side(1), side(2))), all(0.0f)));
      }
      met |= bits_of(may) << i;
    }
    return met;
  }

  /// Bits of those of eight waiting triangles whose back alone the eye could meet, and does not see; which of them it
  /// meets ambiguously is left to the double kernels.
  unsigned leave_out_backs(std::span<const std::uint32_t> leaves, unsigned& never) const {
    unsigned backs = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      const std::uint32_t leaf = leaves[i];
      const Facing facing = facing_of(s_.bvh.primitive_at(leaf).v.data(), setup_.origin);
      if (facing == Facing::front || !hides_back(s_, s_.bvh.id_at(leaf))) continue;
      if (facing == Facing::back) backs |= 1u << i;
      if (facing == Facing::ambiguous) never |= 1u << i;
    }
    return backs;
  }

  /// A primitive besides its numbers.
  struct Tested {
    std::uint32_t leaf;
    bool may_be_sure;
    const TriangleMask* mask = nullptr;  ///< if any is known
  };

  bool test_packets(const LaneNumbers& numbers, const Tested& tested, float nearest,
                    const PacketRect& covered) {
    bool taken = false;
    for (int y = covered.y0; y <= covered.y1; ++y)
      for (unsigned left = asking(nearest, covered, y); left != 0; left &= left - 1)
        taken |= test<false>(numbers, tested, static_cast<std::size_t>(std::countr_zero(left)),
                             static_cast<std::size_t>(y - packets_.y0));
    return taken;
  }
  template <bool plane>
  void test_all(const LaneNumbers& numbers, const Tested& tested, const PacketRect& covered) {
    for (int y = covered.y0; y <= covered.y1; ++y)
      for (int x = covered.x0; x <= covered.x1; ++x)
        test<plane>(numbers, tested, static_cast<std::size_t>(x - packets_.x0),
                    static_cast<std::size_t>(y - packets_.y0));
  }

  template <bool plane>
  bool test(const LaneNumbers& p, const Tested& tested, std::size_t column, std::size_t row) {
    const std::size_t packet = packet_at(column, row);
    bool taken = false;
    for (std::size_t i = 0; i < packet_rays; i += lanes()) {
      const std::size_t at = packet * packet_rays + i;
      const V u = hn::Load(f, plane_.u[column] + i), v = hn::Load(f, plane_.v[row] + i);
      const V edge = plane ? all(inf) : p.least_edge(u, v);
      const V reciprocal_depth = p.reciprocal_depth(u, v), low = hn::Load(f, low_ + at);
      const M known = hn::Gt(reciprocal_depth, p.depth_floor());
      const M behind = hn::And(hn::Lt(reciprocal_depth, hn::Sub(low, p.depth_error())), known);
      M candidate = hn::AndNot(behind, hn::Ge(edge, hn::Neg(p.edge_error())));
      if (hn::AllFalse(f, candidate)) continue;
      M sure = hn::And(candidate, hn::And(hn::Gt(edge, p.edge_error()), known));
      if (!tested.may_be_sure) sure = hn::Lt(low, low);
      if (!plane && tested.mask != nullptr) [[unlikely]] {
        const MaskBits mask = look_up(*tested.mask, u, v, bits_of(sure));
        candidate = hn::AndNot(mask_of(mask.holes), candidate), sure = mask_of(mask.opaque);
        if (hn::AllFalse(f, candidate)) continue;
      }
      const V high = hn::Load(f, high_ + at), new_low = hn::Sub(reciprocal_depth, p.depth_error());
      const V new_high = hn::IfThenElse(known, hn::Add(reciprocal_depth, p.depth_error()), all(inf));
      const M take = hn::And(sure, hn::Gt(new_low, low));
      // Surely nearer than all that was sure before: the old best is no rival. Otherwise the
      // loser makes the ray ambiguous.
      const M rival = hn::AndNot(hn::And(take, hn::Gt(new_low, high)), candidate);
      if (!hn::AllFalse(f, rival)) {
        const V nearest = hn::Load(f, rival_ + at);
        hn::Store(hn::IfThenElse(rival, hn::Max(nearest, hn::IfThenElse(take, high, new_high)), nearest), f,
                  rival_ + at);
        note(tested.leaf, at, bits_of(rival), bits_of(take));
      }
      if (hn::AllFalse(f, take)) continue;
      taken = true;
      hn::Store(hn::IfThenElse(take, new_low, low), f, low_ + at);
      hn::Store(hn::IfThenElse(take, new_high, high), f, high_ + at);
      const auto old = hn::Load(ids, leaf_at(at));
      hn::Store(hn::IfThenElse(hn::RebindMask(ids, take), hn::Set(ids, tested.leaf), old), ids, leaf_at(at));
    }
    if (taken) {
      float& asked = nearest_asked_[row][column];
      M still = hn::Lt(all(0.0f), all(0.0f));
      for (std::size_t i = 0; i < packet_rays; i += lanes())
        still = hn::Or(still, hn::Eq(hn::Load(f, low_ + packet * packet_rays + i), all(asked)));
      if (hn::AllFalse(f, still)) asked = smallest(low_ + packet * packet_rays);
    }
    return taken;
  }

  /// The losers: what was the best where this one is taken, else this one.
  void note(std::uint32_t leaf, std::size_t at, unsigned rival, unsigned take) {
    constexpr std::size_t most = 4 * block_rays;
    for (; rival != 0; rival &= rival - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rival));
      const std::uint32_t loser = (take >> i & 1) != 0 ? *leaf_at(at + i) : leaf;
      if (loser < first_plane) out_.ambiguous_hits.push_back({static_cast<std::uint32_t>(at + i), loser});
    }
    if (out_.ambiguous_hits.size() > most) out_.ambiguous_hits.clear(), out_.all_ambiguous = false;
  }

  void update_limit() {
    V least = all(inf);
    for (std::size_t y = 0; y < block_side; ++y)
      for (std::size_t x = 0; x < block_side; x += lanes())
        least = hn::Min(least, hn::Load(f, nearest_asked_[y] + x));
    const float far = hn::GetLane(hn::MinOfLanes(f, least));
    limit_ = far > 0.0f ? -(1.0f / far) * (1.0f + 0x1p-20f) : -inf;
  }

  void finish() {
    for (std::size_t at = 0; at < block_rays; at += lanes()) {
      const M ambiguous = hn::Ge(hn::Load(f, rival_ + at), hn::Load(f, low_ + at));
      unsigned bits = bits_of(ambiguous);
      if (bits == 0) continue;
      for (unsigned left = bits; left != 0; left &= left - 1) {
        const std::size_t place = at + static_cast<std::size_t>(std::countr_zero(left));
        const std::uint32_t best = *leaf_at(place);
        if (best < first_plane) out_.ambiguous_hits.push_back({static_cast<std::uint32_t>(place), best});
        *leaf_at(place) = ambiguous_hit;
      }
    }
    std::sort(out_.ambiguous_hits.begin(), out_.ambiguous_hits.end(),
              [](const AmbiguousBlockHit& a, const AmbiguousBlockHit& b) { return a.place < b.place; });
  }

  const Structures& s_;
  const EdgeSetup& setup_;
  EdgeSetupPass pass_;
  BlockPlane plane_;
  PacketRect packets_;
  BlockRect rect_;
  BlockHits& out_;
  float limit_ = -inf;
  PendingLeaves pending_;
  EdgeSetupRows rows_[batch / 8];
  Asked asked_[batch];
  TriangleMask masks_[batch];
  alignas(64) float nearest_asked_[block_side]
                                  [block_side];  ///< of packets; what is nowhere nearer is of no interest
  alignas(64) float low_[block_rays], high_[block_rays], rival_[block_rays];
};

void block_kernel(const Structures& s, const EdgeSetup& setup, const View& view, const BlockRect& rect,
                  BlockHits& hits) {
  BlockClosest(s, setup, view, rect, hits).run();
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(block_kernel);

void closest_in_block(const Structures& s, const EdgeSetup& setup, const View& view, const BlockRect& rect,
                      BlockHits& hits) {
  HWY_DYNAMIC_DISPATCH(block_kernel)(s, setup, view, rect, hits);
}

std::span<const AmbiguousBlockHit> BlockHits::ambiguous_at(std::size_t place) const {
  const auto less = [](const AmbiguousBlockHit& hit, std::size_t p) { return hit.place < p; };
  const auto begin = std::lower_bound(ambiguous_hits.begin(), ambiguous_hits.end(), place, less);
  return {begin, std::lower_bound(begin, ambiguous_hits.end(), place + 1, less)};
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
