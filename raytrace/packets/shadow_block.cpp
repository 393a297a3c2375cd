// Shadow rays of a block of tiles: raytrace/packets/shadow_block.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packets/shadow_block.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "raytrace/packets/block_traverse-inl.h"
#include "raytrace/packets/edge_setup_rows.h"
#include "raytrace/packets/pending_leaves-inl.h"
#include "raytrace/packets/shadow_block.h"
#include "raytrace/packets/tile_state-inl.h"

#ifndef GNOMON_RAYTRACE_PACKETS_PLACES_OF_BITS  // once for all instruction sets
#define GNOMON_RAYTRACE_PACKETS_PLACES_OF_BITS
namespace gnomon::raytrace {
namespace {

/// The places of a byte's bits, and then anything. Here and not by Highway's Compress, of which GCC copies the table
/// onto the stack at every use.
constexpr auto places_of_bits = [] {
  std::array<std::array<std::uint8_t, 8>, 256> table{};
  for (std::size_t bits = 0; bits < table.size(); ++bits)
    for (std::uint8_t place = 0, count = 0; place < 8; ++place)
      if ((bits >> place & 1) != 0) table[bits][count++] = place;
  return table;
}();

}  // namespace
}  // namespace gnomon::raytrace
#endif

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {
constexpr hn::CappedTag<std::uint32_t, 8> eight_ids;
constexpr hn::Rebind<std::uint8_t, decltype(eight_ids)> eight_bytes;

class BlockShadows {
 public:
  BlockShadows(const Structures& s, const EdgeSetup& setup, std::span<const ShadowTileRays> tiles)
      : s_(s),
        setup_(setup),
        pass_(edge_setup_pass(s, setup)),
        projection_(s, setup),
        count_(tiles.size()),
        pending_(s.bvh) {
    for (std::size_t t = 0; t < most_shadow_tiles; ++t) {
      for (Packets& part : regions_.part) Extent{}.store(part, t), part.far_min[t] = inf;
      if (t >= count_) continue;
      tiles_[t].start(tiles[t]);
      tiles_[t].enter(regions_, t);
    }
  }

  void run() {
    for (const PrimitiveEdges& plane : setup_.planes) {
      rows_.set(0, plane);
      const bool is_sure = (plane.id & never_sure) == 0;
      const Blocker blocker{plane.edge_error < inf ? plane.id & ~never_sure : no_id, is_sure};
      for (std::size_t t = 0; t < count_; ++t)
        if (tiles_[t].test_all_by_plane({rows_, 0}, blocker)) tiles_[t].update_regions(regions_, t);
    }
    update_limit();
    if (far_min_ < inf) {
      const Frustum frustum(s_.bvh, setup_, whole());
      traverse_block(
          s_.bvh, frustum, [&] { return limit_; },
          [&](const BoxRef& box, LeafRange leaves) {
            if (const unsigned tiles = touched_tiles(LaneBounds(projection_.of(box)))) put(leaves, tiles);
          });
      while (pending_.count() > 0) flush();
      while (ready_ > 0) test_eight();
    }
    for (std::size_t t = 0; t < count_; ++t) tiles_[t].finish();
  }

 private:
  static constexpr std::size_t batch = 8;

  /// Around both parts of all tiles.
  Packets whole() const {
    Packets all_of = regions_.part[0];
    for (std::size_t t = 0; t < most_shadow_tiles; ++t) {
      Extent e = Extent::of(all_of, t);
      e.grow(Extent::of(regions_.part[1], t));
      e.store(all_of, t);
    }
    return all_of;
  }

  /// Bits of the tiles that may be touched; none where no packet of theirs is.
  unsigned touched_tiles(const LaneBounds& bounds) const {
    const unsigned tiles = regions_.touched_by(bounds);
    for (unsigned left = tiles; left != 0; left &= left - 1)
      if (tiles_[std::countr_zero(left)].packets().touched_by(bounds) != 0) return tiles;
    return 0;
  }

  void put(LeafRange run, unsigned tiles) {
    pending_.put(run, static_cast<std::uint16_t>(tiles));
    while (pending_.count() >= std::size_t{2} * run_size) flush();
  }

  /// Of the longest waiting ones finds which tiles each may concern, and which packets of these, in plain loops, because
  /// branches that nobody can foresee would cost more than the tests.
  void flush() {
    const std::size_t count = std::min<std::size_t>(pending_.count(), batch);
    const std::span<const std::uint32_t> leaves = pending_.first(count);
    projection_.of_leaves(leaves, bounds_);
    std::size_t tiles = 0;
    for (std::size_t i = 0; i < count; ++i) {
      unsigned touched = pending_.tiles_of(i);
      if (!std::has_single_bit(touched)) touched &= regions_.touched_by({bounds_, i});
      tiles += list_bits(touched, i, tiles_of_ + tiles);
    }
    unsigned concern = 0;
    std::size_t pairs = pair_end_;
    for (std::size_t k = 0; k < tiles; ++k) {
      const std::uint32_t i = tiles_of_[k] / 16, tile = tiles_of_[k] % 16;
      const std::size_t place = ready_ + static_cast<std::size_t>(std::popcount(concern & ((1u << i) - 1)));
      const std::size_t packets =
          list_bits(tiles_[tile].packets().touched_by({bounds_, i}), 16 * place + tile, pairs_ + pairs);
      pairs += packets, concern |= static_cast<unsigned>(packets != 0) << i;
    }
    pair_end_ = pairs;
    for (std::size_t k = 0; k < batch; ++k)
      ready_leaves_[ready_ + k] = leaves[std::min<std::size_t>(places_of_bits[concern][k], count - 1)];
    ready_ += static_cast<std::size_t>(std::popcount(concern));
    pending_.drop(count);
    if (ready_ >= batch) test_eight();
  }

  /// Sets up those that concern packets, and tries every pair.
  void test_eight() {
    const std::size_t count = std::min<std::size_t>(ready_, batch);
    const unsigned never = set_up_leaves(s_, pass_, {ready_leaves_, count}, rows_);
    for (std::size_t i = 0; i < count; ++i)
      blockers_[i] = {rows_.edge_error()[i] < inf ? s_.bvh.id_at(ready_leaves_[i]) : no_id,
                      (never >> i & 1) == 0};
    unsigned changed = 0;
    std::size_t k = 0;
    for (; k < pair_end_ && pairs_[k] < 256 * batch; ++k) changed |= test(pairs_[k]);
    for (unsigned left = changed; left != 0; left &= left - 1) {
      const auto t = static_cast<std::size_t>(std::countr_zero(left));
      tiles_[t].update_regions(regions_, t);
    }
    if (changed != 0) update_limit();
    const std::size_t first = k;
    for (; k < pair_end_; ++k) pairs_[k - first] = pairs_[k] - std::uint32_t{256 * batch};
    pair_end_ -= first, ready_ -= count;
    std::copy_n(ready_leaves_ + count, ready_, ready_leaves_);
  }

  /// 16 `first` + i for every bit i; returns their number.
  static std::size_t list_bits(unsigned bits, std::size_t first, std::uint32_t* out) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < packet_rays; i += 8) {
      const unsigned these = bits >> i & 0xffu;
      const auto base = hn::Set(eight_ids, static_cast<std::uint32_t>(16 * first + i));
      for (std::size_t k = 0; k < 8; k += hn::Lanes(eight_ids)) {
        const auto places =
            hn::PromoteTo(eight_ids, hn::LoadU(eight_bytes, places_of_bits[these].data() + k));
        hn::StoreU(hn::Add(base, places), eight_ids, out + count + k);
      }
      count += static_cast<std::size_t>(std::popcount(these));
    }
    return count;
  }

  /// `pair`: a pending primitive, a tile and one of its packets. The tile's bit when rays of it were found to be
  /// shadowed.
  unsigned test(std::uint32_t pair) {
    const std::size_t i = pair / 256, tile = pair / 16 % 16, packet = pair % 16;
    const bool taken =
        tiles_[tile].template test_packet<false>({rows_, i}, blockers_[i], ready_leaves_[i], packet);
    return static_cast<unsigned>(taken) << tile;
  }

  void update_limit() {
    far_min_ = regions_.far_min();
    if (setup_.directional)
      limit_ = far_min_;
    else
      limit_ = far_min_ > 0.0f ? -(1.0f / far_min_) * (1.0f + 0x1p-20f) : -inf;
  }

  const Structures& s_;
  const EdgeSetup& setup_;
  EdgeSetupPass pass_;
  Projection projection_;
  std::size_t count_;
  TileState tiles_[most_shadow_tiles];
  SplitRegions regions_;  ///< of the tiles
  float far_min_ = inf, limit_ = -inf;
  BoundsRows bounds_;
  std::uint32_t tiles_of_[batch * most_shadow_tiles + packet_rays];
  std::uint32_t ready_leaves_[2 * batch];  ///< those that concern packets
  std::size_t ready_ = 0, pair_end_ = 0;
  std::uint32_t pairs_[2 * batch * most_shadow_tiles * tile_packets + packet_rays];
  EdgeSetupRows rows_;
  Blocker blockers_[batch];
  PendingLeaves pending_;
};

void block_kernel(const Structures& s, const EdgeSetup& setup, std::span<const ShadowTileRays> tiles) {
  BlockShadows(s, setup, tiles).run();
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(block_kernel);

void shadows_in_block(const Structures& s, const EdgeSetup& setup, std::span<const ShadowTileRays> tiles) {
  HWY_DYNAMIC_DISPATCH(block_kernel)(s, setup, tiles);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
