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
constexpr hn::CappedTag<std::uint16_t, 8> eight_pairs;
constexpr hn::Rebind<std::uint8_t, decltype(eight_pairs)> eight_bytes;

class BlockShadows {
 public:
  BlockShadows(const Structures& s, const EdgeSetup& setup, std::span<const ShadowTileRays> tiles,
               bool at_any_cost)
      : s_(s),
        setup_(setup),
        pass_(edge_setup_pass(s, setup)),
        projection_(s, setup),
        count_(tiles.size()),
        at_any_cost_(at_any_cost),
        pending_(s.bvh) {
    for (std::size_t t = 0; t < most_shadow_tiles; ++t) {
      for (Packets& part : regions_.part) Extent{}.store(part, t), part.far_min[t] = inf;
      if (t >= count_) continue;
      tiles_[t].start(tiles[t], s.has_masks);
      tiles_[t].enter(regions_, t);
      misses_left_ += misses_a_ray * tiles_[t].rays();
    }
  }

  void run() {
    for (const PrimitiveEdges& plane : setup_.planes) {
      rows_[0].set(0, plane);
      const bool is_sure = (plane.id & never_sure) == 0;
      const Blocker blocker{plane.edge_error < inf ? plane.id & ~never_sure : no_id, is_sure};
      for (std::size_t t = 0; t < count_; ++t)
        if (tiles_[t].test_all_by_plane({rows_[0], 0}, blocker)) tiles_[t].update_regions(regions_, t);
    }
    update_limit();
    if (far_min_ < inf) {
      const Frustum frustum(s_.bvh, setup_, whole());
      traverse_block(
          s_.bvh, frustum, [&] { return limit_; }, want_every_box,
          [&](const BoxRef& box, LeafRange leaves) { find(projection_.of(box), leaves); });
      test_found();
      while (pending_.count() > 0) flush();
      if (ready_ > 0) test_ready();
    }
    for (std::size_t t = 0; t < count_; ++t) tiles_[t].finish();
  }

 private:
  static constexpr std::size_t batch = 8;
  static constexpr std::size_t most_found = 4096;   ///< runs that wait for their tests
  static constexpr std::uint64_t misses_a_ray = 2;  ///< as misses_left_ has them
  struct FoundRun {
    PrimitiveBounds bounds;
    LeafRange leaves;
  };
  /// Leaves that are set up together: a last batch with few of them is little beside the others.
  static constexpr std::size_t enough = 16, most_ready = enough + run_size;

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

  /// Bits of the tiles of which a ray may be met.
  unsigned met_tiles(const LaneBounds& bounds) const {
    unsigned tiles = regions_.met_by(bounds);
    for (unsigned left = tiles; left != 0; left &= left - 1)
      if (!tiles_[std::countr_zero(left)].holds_ray(bounds)) tiles &= ~(left & -left);
    return tiles;
  }

  /// A run of leaves that the traversal has come to. It waits until many more are found, so that a tile that meets too many
  /// leaves is left to single rays before work has been done for it.
  void find(const PrimitiveBounds& bounds, LeafRange leaves) {
    const unsigned tiles = met_tiles(LaneBounds::of(bounds));
    if (tiles == 0) {
      if (--misses_left_ == 0 && !at_any_cost_) leave_to_single_rays((1u << count_) - 1);
      return;
    }
    found_[found_count_++] = {bounds, leaves};
    const bool placed = leaves.first >= s_.bvh.ids.size();
    unsigned costly = 0;
    for (unsigned left = tiles; left != 0; left &= left - 1) {
      const auto t = static_cast<std::size_t>(std::countr_zero(left));
      costly |= tiles_[t].affords(leaves.count, placed) ? 0 : left & -left;
    }
    if (costly != 0 && !at_any_cost_) leave_to_single_rays(costly);
    if (found_count_ == most_found) test_found();
  }
  void leave_to_single_rays(unsigned tiles) {
    for (; tiles != 0; tiles &= tiles - 1) {
      const auto t = static_cast<std::size_t>(std::countr_zero(tiles));
      tiles_[t].leave_to_single_rays(), tiles_[t].update_regions(regions_, t);
    }
    update_limit();
  }
  /// Hands on the runs that still concern tiles.
  void test_found() {
    for (std::size_t i = 0; i < found_count_; ++i) {
      const unsigned tiles = regions_.met_by(LaneBounds::of(found_[i].bounds));
      if (tiles == 0) continue;
      pending_.put(found_[i].leaves, static_cast<std::uint16_t>(tiles));
      while (pending_.count() >= std::size_t{2} * run_size) flush();
    }
    found_count_ = 0;
  }

  /// Finds for the longest waiting leaves which packets each may concern, in plain loops, because branches that nobody can
  /// foresee would cost more than the tests.
  void flush() {
    const std::size_t count = std::min<std::size_t>(pending_.count(), run_size);
    const std::span<const std::uint32_t> leaves = pending_.first(count);
    projection_.of_leaves(leaves, bounds_, lines_);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t id = s_.bvh.id_at(leaves[i]);
      not_from_[i] = !s_.has_shapes || s_.world->is_triangle(id) ? id : no_id;
    }
    const std::size_t first = pair_end_;
    std::uint64_t concern = list_pairs(count);
    for (std::size_t k = first; k < pair_end_; ++k) {
      const std::uint64_t before = (std::uint64_t{1} << (pairs_[k] / 256)) - 1;
      pairs_[k] = static_cast<std::uint16_t>(
          256 * (ready_ + static_cast<std::size_t>(std::popcount(concern & before))) + pairs_[k] % 256);
    }
    for (; concern != 0; concern &= concern - 1)
      ready_leaves_[ready_++] = leaves[static_cast<std::size_t>(std::countr_zero(concern))];
    pending_.drop(count);
    if (ready_ >= enough) test_ready();
  }

  /// Every leaf with every packet that its bounds touch. Bits of the leaves. Where a tile has more leaves than its packets
  /// take tests, these are asked packet by packet, and then their rays: of so small a triangle most packets have none.
  std::uint64_t list_pairs(std::size_t count) {
    unsigned tiles = 0;
    for (std::size_t i = 0; i < count; ++i) tiles |= pending_.tiles_of(i);
    const LaneBounds around = LaneBounds::around(bounds_, count);
    std::uint64_t concern = 0;
    for (tiles &= regions_.met_by(around); tiles != 0; tiles &= tiles - 1) {
      const auto tile = static_cast<std::size_t>(std::countr_zero(tiles));
      const std::uint64_t meeting = regions_.meeting(tile, bounds_, count);
      if (meeting == 0) continue;
      const unsigned packets = tiles_[tile].packets().met_by(around);
      const int by_leaf = std::popcount(meeting) * static_cast<int>(packet_steps);
      const int by_packet = std::popcount(packets) * static_cast<int>((count + lanes() - 1) / lanes());
      concern |= by_leaf <= by_packet ? list_by_leaf(meeting, tile) : list_by_packet(packets, tile, count);
    }
    return concern;
  }

  std::uint64_t list_by_leaf(std::uint64_t leaves, std::size_t tile) {
    std::uint64_t concern = 0;
    for (; leaves != 0; leaves &= leaves - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(leaves));
      const unsigned packets = tiles_[tile].packets().met_by(LaneBounds::of_row(bounds_, i));
      concern |= std::uint64_t{packets != 0} << i;
      pair_end_ += list_bits<1>(packets, 256 * i + 16 * tile, pairs_ + pair_end_);
    }
    return concern;
  }
  std::uint64_t list_by_packet(unsigned packets, std::size_t tile, std::size_t count) {
    std::uint64_t concern = 0;
    for (; packets != 0; packets &= packets - 1) {
      const auto packet = static_cast<std::size_t>(std::countr_zero(packets));
      std::uint64_t leaves = tiles_[tile].packets().meeting(packet, bounds_, count);
      leaves = tiles_[tile].not_missed(bounds_, lines_, not_from_, leaves, packet);
      concern |= leaves;
      pair_end_ += list_bits<256>(leaves, 16 * tile + packet, pairs_ + pair_end_);
    }
    return concern;
  }

  /// Sets up the leaves that concern packets, and tries every pair.
  void test_ready() {
    for (std::size_t first = 0; first < ready_; first += batch) {
      const std::size_t count = std::min(ready_ - first, batch);
      EdgeSetupRows& rows = rows_[first / batch];
      TriangleMask* masks = masks_ + first;
      const unsigned never = set_up_leaves(s_, pass_, {ready_leaves_ + first, count}, rows, masks);
      for (std::size_t i = 0; i < count; ++i)
        blockers_[first + i] = {rows.edge_error()[i] < inf ? s_.bvh.id_at(ready_leaves_[first + i]) : no_id,
                                (never >> i & 1) == 0, masks[i].cells != nullptr ? masks + i : nullptr};
    }
    unsigned changed = 0;
    for (std::size_t k = 0; k < pair_end_; ++k) changed |= test(pairs_[k]);
    for (unsigned left = changed; left != 0; left &= left - 1) {
      const auto t = static_cast<std::size_t>(std::countr_zero(left));
      tiles_[t].update_regions(regions_, t);
    }
    if (changed != 0) update_limit();
    ready_ = pair_end_ = 0;
  }

  /// `unit` i + `other` for every bit i; returns their number.
  template <unsigned unit>
  static std::size_t list_bits(std::uint64_t bits, std::size_t other, std::uint16_t* out) {
    std::size_t listed = 0;
    while (bits != 0) {
      const std::size_t i = static_cast<std::size_t>(std::countr_zero(bits)) & ~std::size_t{7};
      const auto these = static_cast<std::size_t>(bits >> i & 0xff);
      const auto base = hn::Set(eight_pairs, static_cast<std::uint16_t>(unit * i + other));
      for (std::size_t k = 0; k < 8; k += hn::Lanes(eight_pairs)) {
        const auto places =
            hn::PromoteTo(eight_pairs, hn::LoadU(eight_bytes, places_of_bits[these].data() + k));
        hn::StoreU(hn::Add(base, hn::ShiftLeft<std::countr_zero(unit)>(places)), eight_pairs,
                   out + listed + k);
      }
      listed += static_cast<std::size_t>(std::popcount(these)), bits &= ~(std::uint64_t{0xff} << i);
    }
    return listed;
  }

  /// `pair`: a leaf that is ready, a tile and one of its packets. The tile's bit when rays of it were found to be
  /// shadowed.
  unsigned test(std::uint16_t pair) {
    const std::size_t at = pair / 256, tile = pair / 16 % 16;
    const bool taken = tiles_[tile].template test_packet<false>({rows_[at / batch], at % batch},
                                                                blockers_[at], ready_leaves_[at], pair % 16);
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
  bool at_any_cost_;
  TileState tiles_[most_shadow_tiles];
  SplitRegions regions_;  ///< of the tiles
  float far_min_ = inf, limit_ = -inf;
  FoundRun found_[most_found];
  std::size_t found_count_ = 0;
  /// How many more runs may concern no tile before all rays are left to single rays. Where the tiles' regions are small in the
  /// block's, as in foliage, the traversal alone costs more than these.
  std::uint64_t misses_left_ = 1;
  BoundsRows bounds_;
  EdgeLines lines_;
  std::uint32_t not_from_[run_size];
  std::uint32_t ready_leaves_[most_ready];  ///< those that concern packets
  std::size_t ready_ = 0, pair_end_ = 0;
  std::uint16_t pairs_[most_ready * most_shadow_tiles * tile_packets + 8];
  EdgeSetupRows rows_[most_ready / batch];
  Blocker blockers_[most_ready];
  TriangleMask masks_[most_ready];
  PendingLeaves pending_;
};

void block_kernel(const Structures& s, const EdgeSetup& setup, std::span<const ShadowTileRays> tiles,
                  bool at_any_cost) {
  BlockShadows(s, setup, tiles, at_any_cost).run();
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(block_kernel);

void shadows_in_block(const Structures& s, const EdgeSetup& setup, std::span<const ShadowTileRays> tiles,
                      bool at_any_cost) {
  HWY_DYNAMIC_DISPATCH(block_kernel)(s, setup, tiles, at_any_cost);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
