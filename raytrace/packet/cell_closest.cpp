#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packet/cell_closest.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "raytrace/packet/cell_tile.h"
#include "raytrace/packet/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {

/// A vector of rays against primitives, nearest first. Of each ray the best sure hit's nearness is known to
/// lie in [low, high], and no other hit is nearer than `doubt`.
class CellClosest {
 public:
  CellClosest(const TileRays& rays, std::size_t at)
      : u_(hn::Load(f, rays.u + at)), v_(hn::Load(f, rays.v + at)), doubt_(all(-inf)) {
    const M alive = mask_of(static_cast<unsigned>(rays.alive[at / packet_rays]) >> (at % packet_rays));
    low_ = high_ = hn::IfThenElse(alive, all(0.0f), all(inf));
    leaf_ = hn::Set(ids, nothing_hit);
  }

  /// Nothing that is nowhere nearer than this is of interest.
  float least_low() const { return hn::GetLane(hn::MinOfLanes(f, low_)); }

  /// True when least_low() has changed.
  template <bool plane>
  bool test(const SeenPrimitive& p, std::uint32_t leaf) {
    const RayTest rays{Functions(p)};
    const V edge = plane ? all(inf) : rays.least_edge(u_, v_);
    const V edge_error = all(p.edge_error), depth_error = all(p.depth_error);
    const V nearness = rays.nearness(u_, v_);
    const M known = hn::Gt(nearness, all(p.depth_floor));
    const V new_low = hn::Sub(nearness, depth_error);
    const M behind = hn::And(hn::Lt(nearness, hn::Sub(low_, depth_error)), known);
    const M contact = hn::AndNot(behind, hn::Ge(edge, hn::Neg(edge_error)));
    if (hn::AllFalse(f, contact)) return false;
    M sure = hn::And(contact, hn::And(hn::Gt(edge, edge_error), known));
    if ((p.id & never_sure) != 0) sure = hn::Lt(low_, low_);
    const V new_high = hn::IfThenElse(known, hn::Add(nearness, depth_error), all(inf));
    const M take = hn::And(sure, hn::Gt(new_low, low_));
    // Surely nearer than all that was sure before: the old best is no rival. Otherwise the loser is a doubt.
    const M rival = hn::AndNot(hn::And(take, hn::Gt(new_low, high_)), contact);
    doubt_ = hn::IfThenElse(rival, hn::Max(doubt_, hn::IfThenElse(take, high_, new_high)), doubt_);
    low_ = hn::IfThenElse(take, new_low, low_), high_ = hn::IfThenElse(take, new_high, high_);
    leaf_ = hn::IfThenElse(hn::RebindMask(ids, take), hn::Set(ids, leaf), leaf_);
    return true;
  }

  void store(std::uint32_t* leaf) const {
    const M unsure = hn::Ge(doubt_, low_);
    hn::Store(hn::IfThenElse(hn::RebindMask(ids, unsure), hn::Set(ids, unsure_hit), leaf_), ids, leaf);
  }

 private:
  V u_, v_, low_, high_, doubt_;
  hn::Vec<I> leaf_;
};

/// A packet's list on its way to the cache, and later the nearest of its primitives: each is a cache line of
/// its own.
struct List {
  std::uint32_t begin, end;
  void prefetch(const Cells& cells) const {
    __builtin_prefetch(&cells.nearest[begin]), __builtin_prefetch(&cells.leaf[begin]);
  }
  void prefetch_nearest(const Cells& cells) const {
    for (std::uint32_t k = begin; k < std::min(end, begin + 12); ++k)
      __builtin_prefetch(&cells.primitives[cells.leaf[k]]);
  }
};

void closest_kernel(const Cells& cells, const Seen& seen, const TileRays& rays, int column, int row,
                    TileHits& hits) {
  constexpr std::size_t ahead = 3;  // packets
  List lists[tile_packets];
  for (std::size_t p = 0; p < tile_packets; ++p) {
    const int x = column + static_cast<int>(p % 4), y = row + static_cast<int>(p / 4);
    const int at = y * cells.columns() + x;
    const auto cell = static_cast<std::size_t>(at);
    lists[p] = rays.alive[p] == 0 ? List{0, 0} : List{cells.first[cell], cells.first[cell + 1]};
    lists[p].prefetch(cells);
  }
  for (std::size_t p = 0; p < ahead; ++p) lists[p].prefetch_nearest(cells);
  for (std::size_t p = 0; p < tile_packets; ++p) {
    if (p + ahead < tile_packets) lists[p + ahead].prefetch_nearest(cells);
    if (rays.alive[p] == 0) continue;
    for (std::size_t i = 0; i < packet_rays; i += lanes()) {
      CellClosest closest(rays, p * packet_rays + i);
      for (std::uint32_t k = 0; k < seen.planes.size(); ++k)
        closest.test<true>(seen.planes[k], first_plane + k);
      float low = closest.least_low();
      for (std::uint32_t k = lists[p].begin; k != lists[p].end && !(cells.nearest[k] < low); ++k)
        if (closest.test<false>(cells.primitives[cells.leaf[k]], cells.leaf[k])) low = closest.least_low();
      closest.store(hits.leaf + p * packet_rays + i);
    }
  }
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(closest_kernel);

void closest_in_cells(const Cells& cells, const Seen& seen, const TileRays& rays, int column, int row,
                      TileHits& hits) {
  HWY_DYNAMIC_DISPATCH(closest_kernel)(cells, seen, rays, column, row, hits);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
