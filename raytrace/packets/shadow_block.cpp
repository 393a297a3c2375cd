// Shadow rays of a block of tiles: raytrace/packets/shadow_block.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packets/shadow_block.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "raytrace/packets/block_traverse-inl.h"
#include "raytrace/packets/edge_setup_rows.h"
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
      : s_(s), setup_(setup), pass_(edge_setup_pass(s, setup)), projection_(s, setup), count_(tiles.size()) {
    for (std::size_t t = 0; t < most_shadow_tiles; ++t) {
      for (Packets& part : regions_.part) Extent{}.store(part, t), part.far_min[t] = inf;
      if (t >= count_) continue;
      tiles_[t].start(tiles[t]);
      tiles_[t].enter(regions_, t);
    }
  }

  void run() {
    for (const PrimitiveEdges& plane : setup_.planes) {
      const RayTest rays{Functions(plane)};
      for (std::size_t t = 0; t < count_; ++t)
        if (tiles_[t].test_all<true>(plane, 0, rays)) tiles_[t].update_regions(regions_, t);
    }
    update_limit();
    if (far_min_ < inf) {
      const Frustum frustum(s_.bvh, setup_, whole());
      traverse_block(
          s_.bvh, frustum, [&] { return limit_; },
          [&](const BoxRef& box, LeafRange leaves) {
            if (is_touched(projection_.of(box))) put(leaves);
          });
      while (begin_ < end_) flush();
    }
    for (std::size_t t = 0; t < count_; ++t) tiles_[t].finish();
  }

 private:
  static constexpr std::uint32_t batch = 8;

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

  bool is_touched(const PrimitiveBounds& bounds) const {
    for (unsigned tiles = regions_.touched_by(bounds); tiles != 0; tiles &= tiles - 1)
      if (tiles_[std::countr_zero(tiles)].packets().touched_by(bounds) != 0) return true;
    return false;
  }

  void put(LeafRange run) {
    prefetch_run(s_.bvh, run);
    for (std::uint32_t k = 0; k < run.count; ++k) pending_[end_++] = run.first + k;
    while (end_ - begin_ >= run_size) flush();
    end_ = static_cast<std::size_t>(std::copy(pending_ + begin_, pending_ + end_, pending_) - pending_),
    begin_ = 0;
  }

  /// Sets up the longest waiting ones and tries them: which tiles each may concern, which packets of these, and then
  /// every pair, in three plain loops, because branches that nobody can foresee would cost more than the tests.
  void flush() {
    const std::size_t count = std::min<std::size_t>(end_ - begin_, batch);
    never_ = set_up_leaves(s_, pass_, {pending_ + begin_, count}, block_);
    PrimitiveBounds bounds[batch];
    std::size_t tiles = 0, pairs = 0;
    for (std::size_t i = 0; i < count; ++i) {
      bounds[i] = bounds_of(i);
      tiles += list_bits(regions_.touched_by(bounds[i]), i, tiles_of_ + tiles);
    }
    for (std::size_t k = 0; k < tiles; ++k) {
      const std::uint32_t at = tiles_of_[k];
      pairs += list_bits(tiles_[at % 16].packets().touched_by(bounds[at / 16]), at, pairs_ + pairs);
    }
    unsigned changed = 0;
    for (std::size_t k = 0; k < pairs; ++k) changed |= test(pairs_[k]);
    for (unsigned left = changed; left != 0; left &= left - 1) {
      const auto t = static_cast<std::size_t>(std::countr_zero(left));
      tiles_[t].update_regions(regions_, t);
    }
    if (changed != 0) update_limit();
    begin_ += count;
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
    const std::uint32_t leaf = pending_[begin_ + i];
    const PrimitiveEdges primitive = edges_of(leaf, i);
    const bool taken =
        tiles_[tile].template test_packet<false>(primitive, leaf, RayTest{Functions(primitive)}, packet);
    return static_cast<unsigned>(taken) << tile;
  }

  PrimitiveBounds bounds_of(std::size_t i) const {
    const PrimitiveBounds bounds{block_.u_min()[i], block_.u_max()[i], block_.v_min()[i], block_.v_max()[i],
                                 block_.nearest()[i]};
    return bounds.u_min == -inf ? bounds_of_box(pending_[begin_ + i]) : bounds;
  }

  /// Of what has no bounds of its own: shapes, and triangles seen edge-on.
  PrimitiveBounds bounds_of_box(std::uint32_t leaf) const {
    const std::uint32_t id = s_.bvh.id_at(leaf);
    return projection_.of(s_.world->is_triangle(id) ? triangle_box(leaf)
                                                    : shape_box(*s_.world, id, s_.bvh.center));
  }
  BoxRef triangle_box(std::uint32_t leaf) const {
    LeafPrimitive scratch;
    const LeafPrimitive& p = s_.bvh.primitive_at(leaf, scratch);
    BoxRef box{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double center = s_.bvh.center[static_cast<int>(a)];
      const double low = std::min({p.v[a], p.v[3 + a], p.v[6 + a]}),
                   high = std::max({p.v[a], p.v[3 + a], p.v[6 + a]});
      box.min[a] = float_below(low - center), box.max[a] = float_above(high - center);
    }
    return box;
  }

  PrimitiveEdges edges_of(std::uint32_t leaf, std::size_t i) const {
    PrimitiveEdges p;
    const auto& out = block_.rows.out;
    for (std::size_t k = 0; k < 9; ++k) p.edge[k / 3][k % 3] = out[k][i];
    for (std::size_t k = 0; k < 3; ++k) p.reciprocal_depth[k] = out[9 + k][i];
    p.edge_error = out[12][i], p.depth_error = out[13][i], p.depth_floor = out[14][i];
    p.id = s_.bvh.id_at(leaf) | ((never_ >> i & 1) != 0 ? never_sure : 0u);
    return p;
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
  BoxProjection projection_;
  std::size_t count_;
  TileState tiles_[most_shadow_tiles];
  SplitRegions regions_;  ///< of the tiles
  float far_min_ = inf, limit_ = -inf;
  EdgeSetupBlock block_;
  unsigned never_ = 0;  ///< bit i: the i-th of it is never sure
  std::uint32_t tiles_of_[batch * most_shadow_tiles + packet_rays];
  std::uint32_t pairs_[batch * most_shadow_tiles * tile_packets + packet_rays];
  std::uint32_t pending_[2 * run_size];
  std::size_t begin_ = 0, end_ = 0;  ///< of the pending ones
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
