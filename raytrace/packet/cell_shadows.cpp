#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packet/cell_shadows.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "raytrace/packet/cell_tile.h"
#include "raytrace/packet/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {

using Place = hn::RebindToSigned<F>;
using Places = hn::Vec<Place>;
constexpr Place place;

/// A vector of rays against primitives.
class CellShadows {
 public:
  CellShadows(const TileRays& rays, std::size_t at, TileShadows& out)
      : u_(hn::Load(f, rays.u + at)),
        v_(hn::Load(f, rays.v + at)),
        own_(hn::Load(ids, rays.own + at)),
        alive_((static_cast<unsigned>(rays.alive[at / packet_rays]) >> (at % packet_rays)) &
               ((1u << lanes()) - 1)),
        at_(at),
        out_(out) {
    u_in_cell_ = v_in_cell_ = hn::Zero(place);
    far_ = hn::IfThenElse(mask_of(alive_), hn::Load(f, rays.far + at), all(inf));
  }

  unsigned alive() const { return alive_; }
  unsigned shadowed() const { return shadowed_; }
  unsigned unsure() const { return unsure_; }

  /// Bits of the rays outside the cells; the others' cells are stored, and where in them they lie.
  unsigned find_cells(const Cells& cells, int columns, std::int32_t* cell) {
    const auto along = [&](V v, const CellAxis& axis, M& within, Places& in_cell) {
      const V step = hn::Mul(hn::Sub(v, all(axis.origin)), all(axis.per_width));
      within = hn::And(within,
                       hn::And(hn::Ge(step, all(0.0f)), hn::Lt(step, all(static_cast<float>(axis.count)))));
      const auto fine = hn::ConvertTo(place, hn::Mul(step, all(256.0f)));
      in_cell = hn::And(fine, hn::Set(place, 255));
      return hn::ShiftRight<8>(fine);
    };
    M within = mask_of(alive_);
    const auto x = along(u_, cells.u, within, u_in_cell_), y = along(v_, cells.v, within, v_in_cell_);
    hn::Store(hn::Add(hn::Mul(y, hn::Set(place, columns)), x), place, cell);
    return alive_ & ~bits_of(within);
  }

  void test_plane(const SeenPrimitive& plane) { test<true>(plane, 0, mask_of(alive_)); }

  /// The rays of one cell against its list.
  void test_list(const Cells& cells, std::size_t cell, unsigned bits) {
    const std::uint32_t begin = cells.first[cell], end = cells.first[cell + 1];
    const M asked = mask_of(bits);
    float least = least_far(asked);
    if (begin == end || cells.nearest[begin] < least) return;
    constexpr std::uint32_t few = 4;  // to be tested one by one
    if (end - begin <= few) {
      for (std::uint32_t i = begin; i != end && !(cells.nearest[i] < least); ++i)
        if (test<false>(cells.primitives[cells.leaf[i]], cells.leaf[i], asked)) least = least_far(asked);
      return;
    }
    const Extent extent = extent_of(asked);
    for (std::uint32_t first = begin; first < end && !(cells.nearest[first] < least);
         first += static_cast<std::uint32_t>(lanes())) {
      unsigned met = extent.meets(cells, first, least);
      if (end - first < lanes()) met &= (1u << (end - first)) - 1;
      // Each primitive is a cache line of its own: all are asked for before the first is looked at.
      for (unsigned next = met; next != 0; next &= next - 1)
        prefetch(cells, first + static_cast<std::uint32_t>(std::countr_zero(next)));
      for (; met != 0; met &= met - 1) {
        const std::uint32_t leaf = cells.leaf[first + static_cast<std::uint32_t>(std::countr_zero(met))];
        if (test<false>(cells.primitives[leaf], leaf, asked)) least = least_far(asked);
      }
    }
  }

 private:
  static void prefetch(const Cells& cells, std::uint32_t i) {
    __builtin_prefetch(&cells.primitives[cells.leaf[i]]);
  }

  /// The rays' box in their cell, against as many primitives at once.
  struct Extent {
    Places u_min, u_max, v_min, v_max;
    unsigned meets(const Cells& cells, std::uint32_t first, float least) const {
      const auto box = hn::LoadU(place, reinterpret_cast<const std::int32_t*>(cells.box.data()) + first);
      const auto byte = hn::Set(place, 255);
      const auto part = [&](auto shifted) { return hn::And(shifted, byte); };
      auto apart = hn::Or(hn::Gt(part(box), u_max), hn::Gt(u_min, part(hn::ShiftRight<8>(box))));
      apart = hn::Or(apart, hn::Or(hn::Gt(part(hn::ShiftRight<16>(box)), v_max),
                                   hn::Gt(v_min, part(hn::ShiftRight<24>(box)))));
      const M behind = hn::Lt(hn::LoadU(f, cells.nearest.data() + first), all(least));
      return bits_of(hn::Not(hn::Or(behind, hn::RebindMask(f, apart))));
    }
  };
  Extent extent_of(M asked) const {
    const auto mask = hn::RebindMask(place, asked);
    const auto low = [&](Places v) {
      return hn::MinOfLanes(place, hn::IfThenElse(mask, v, hn::Set(place, 255)));
    };
    const auto high = [&](Places v) { return hn::MaxOfLanes(place, hn::IfThenElseZero(mask, v)); };
    return {low(u_in_cell_), high(u_in_cell_), low(v_in_cell_), high(v_in_cell_)};
  }

  float least_far(M asked) const {
    return hn::GetLane(hn::MinOfLanes(f, hn::IfThenElse(asked, far_, all(inf))));
  }

  /// True when rays have been found to be shadowed.
  template <bool plane>
  bool test(const SeenPrimitive& p, std::uint32_t leaf, M asked) {
    const RayTest rays{Functions(p)};
    const V edge = plane ? all(inf) : rays.least_edge(u_, v_);
    const V edge_error = all(p.edge_error), depth_error = all(p.depth_error);
    const V nearness = rays.nearness(u_, v_);
    const M known = hn::Gt(nearness, all(p.depth_floor));
    const M behind = hn::And(hn::Lt(nearness, hn::Sub(far_, depth_error)), known);
    M contact = hn::AndNot(behind, hn::And(asked, hn::Ge(edge, hn::Neg(edge_error))));
    if (hn::AllFalse(f, contact)) return false;
    // A shape may shadow itself; the double kernels know when.
    const auto own = hn::Eq(own_, hn::Set(ids, p.id & ~never_sure));
    if (p.edge_error < inf) contact = hn::AndNot(hn::RebindMask(f, own), contact);
    const M ahead = hn::And(hn::Gt(nearness, hn::Add(far_, depth_error)), known);
    const M inside = hn::And(contact, hn::And(hn::Gt(edge, edge_error), ahead));
    const unsigned sure = (p.id & never_sure) == 0 ? bits_of(inside) : 0;
    const unsigned open = bits_of(contact) & ~sure;
    unsure_ |= open;
    if (!plane) out_.note(leaf, at_, open);
    if (sure == 0) return false;
    shadowed_ |= sure;
    far_ = hn::IfThenElse(inside, all(inf), far_);
    return true;
  }

  V u_, v_, far_;
  Places u_in_cell_, v_in_cell_;
  hn::Vec<I> own_;
  unsigned alive_, shadowed_ = 0, unsure_ = 0;
  std::size_t at_;
  TileShadows& out_;
};

/// Cell by cell of those that the rays lie in: usually one, at an outline as many as there are rays.
unsigned test_cells(const Cells& cells, int columns, CellShadows& rays) {
  alignas(64) std::int32_t cell[packet_rays];
  const unsigned outside = rays.find_cells(cells, columns, cell);
  for (unsigned left = rays.alive() & ~outside & ~rays.shadowed(); left != 0;) {
    const std::int32_t first = cell[std::countr_zero(left)];
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(place, hn::Eq(hn::Load(place, cell), hn::Set(place, first)), bytes);
    std::uint32_t same = 0;
    std::memcpy(&same, bytes, sizeof same);
    rays.test_list(cells, static_cast<std::size_t>(first), left & same);
    left &= ~same;
  }
  return outside;
}

void shadows_kernel(const Cells& cells, const Seen& seen, const TileRays& rays, TileShadows& out,
                    std::array<std::uint16_t, tile_packets>& outside) {
  out.doubt_count = 0;
  const int columns = cells.columns();
  for (std::size_t p = 0; p < tile_packets; ++p) {
    unsigned shadowed = 0, unsure = 0, out_of_cells = 0;
    for (std::size_t i = 0; i < packet_rays && rays.alive[p] != 0; i += lanes()) {
      CellShadows some(rays, p * packet_rays + i, out);
      if (some.alive() == 0) continue;
      for (const SeenPrimitive& plane : seen.planes) some.test_plane(plane);
      out_of_cells |= test_cells(cells, columns, some) << i;
      shadowed |= some.shadowed() << i, unsure |= some.unsure() << i;
    }
    out.shadowed[p] = static_cast<std::uint16_t>(shadowed & rays.alive[p]);
    outside[p] = static_cast<std::uint16_t>(out_of_cells & ~shadowed & rays.alive[p]);
    out.unsure[p] = static_cast<std::uint16_t>((unsure | outside[p]) & ~shadowed & rays.alive[p]);
  }
}

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(shadows_kernel);

void shadows_in_cells(const Cells& cells, const Seen& seen, const TileRays& rays, TileShadows& shadows,
                      std::array<std::uint16_t, tile_packets>& outside) {
  HWY_DYNAMIC_DISPATCH(shadows_kernel)(cells, seen, rays, shadows, outside);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
