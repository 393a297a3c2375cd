#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packet/cell_cover.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <bit>

#include "raytrace/packet/cell_cover.h"
#include "raytrace/packet/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {

/// The most of a linear function over a row of cells: its part in v is the same for all.
struct RowFunction {
  float u, in_v;
  const float* most_u;
  RowFunction(const float (&n)[3], const CellLines& columns, float v_lo, float v_hi)
      : u(n[0]), most_u(n[0] > 0.0f ? columns.hi.data() : columns.lo.data()) {
    const auto one = hn::CappedTag<float, 1>();
    in_v = hn::GetLane(
        hn::MulAdd(hn::Set(one, n[1]), hn::Set(one, n[1] > 0.0f ? v_hi : v_lo), hn::Set(one, n[2])));
  }
  V at(std::size_t x) const { return hn::MulAdd(all(u), hn::LoadU(f, most_u + x), all(in_v)); }
};

std::size_t cover_kernel(const SeenPrimitive& p, std::uint32_t leaf, float nearest, const CellLines& columns,
                         const CellLines& rows, const CellRect& rect, CoveredCell* out) {
  const std::size_t stride = columns.lo.size() - packet_rays;
  const auto x0 = static_cast<std::size_t>(rect.x0), end = static_cast<std::size_t>(rect.x1) + 1;
  const float u_size = std::max(std::abs(columns.lo[x0]), std::abs(columns.hi[end - 1]));
  const bool by_depth = !(p.depth_floor > -1e30f) && p.depth_error < inf;
  std::size_t count = 0;
  for (auto y = static_cast<std::size_t>(rect.y0); y <= static_cast<std::size_t>(rect.y1); ++y) {
    const float lo = rows.lo[y], hi = rows.hi[y];
    const RowFunction edge[3] = {
        {p.edge[0], columns, lo, hi}, {p.edge[1], columns, lo, hi}, {p.edge[2], columns, lo, hi}};
    const RowFunction depth(p.nearness, columns, lo, hi);
    const float v_size = std::max(std::abs(lo), std::abs(hi));
    constexpr float rounding = 0x1p-18f;
    const float slack = p.depth_error * (1.0f + rounding) +
                        rounding * (std::abs(p.nearness[0]) * u_size + std::abs(p.nearness[1]) * v_size +
                                    std::abs(p.nearness[2]));
    for (std::size_t x = x0; x < end; x += lanes()) {
      const V least = hn::Min(edge[0].at(x), hn::Min(edge[1].at(x), edge[2].at(x)));
      unsigned met = bits_of(hn::Not(hn::Lt(least, all(-p.edge_error))));
      if (end - x < lanes()) met &= (1u << (end - x)) - 1;
      if (met == 0) continue;
      V near = all(nearest);
      if (by_depth) near = hn::Min(near, hn::Add(depth.at(x), all(slack)));
      alignas(64) float key[packet_rays];
      hn::Store(near, f, key);
      for (; met != 0; met &= met - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(met));
        out[count++] = {static_cast<std::uint32_t>(y * stride + x + i), leaf, key[i], 0};
      }
    }
  }
  return count;
}

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(cover_kernel);

std::size_t cover_cells(const SeenPrimitive& primitive, std::uint32_t leaf, float nearest,
                        const CellLines& columns, const CellLines& rows, const CellRect& rect,
                        CoveredCell* out) {
  return HWY_DYNAMIC_DISPATCH(cover_kernel)(primitive, leaf, nearest, columns, rows, rect, out);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
