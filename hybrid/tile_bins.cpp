#include "hybrid/tile_sheets.h"

#include "scene/base/parallel.h"

namespace gnomon::hybrid {
namespace {

/// Tiles x0 ... x1, y0 ... y1; none when x0 > x1.
struct TileRange {
  std::uint16_t x0 = 1, x1 = 0, y0 = 0, y1 = 0;
};

TileRange rect_of(const SheetGrid& grid, const std::array<ProjectedPoint, 3>& p) {
  const double size = grid.view.size;
  const auto last = static_cast<std::uint16_t>(grid.tiles - 1);
  bool left = true, right = true, below = true, above = true, clipped = false, finite = true;
  for (const ProjectedPoint& q : p) {
    const double slack = grid.grid_error + 2.0 * texel_slack * std::abs(q.w);
    left = left && q.u < -slack, right = right && q.u - size * q.w > slack;
    below = below && q.v < -slack, above = above && q.v - size * q.w > slack;
    clipped = clipped || !(q.w > grid.near_limit);
    finite = finite && std::isfinite(q.u) && std::isfinite(q.v);
  }
  // A triangle that is not finite cannot be hit; its neighbours have a boundary there (light_facing.h).
  if (left || right || below || above || !finite) return {};
  if (clipped) {
    const bool behind =
        std::all_of(p.begin(), p.end(), [&](const auto& q) { return q.w < -grid.near_limit; });
    return behind ? TileRange{} : TileRange{0, last, 0, last};
  }
  const std::array<double, 3> u{p[0].u / p[0].w, p[1].u / p[1].w, p[2].u / p[2].w};
  const std::array<double, 3> v{p[0].v / p[0].w, p[1].v / p[1].w, p[2].v / p[2].w};
  const auto tile = [&](double texel) {
    return static_cast<std::uint16_t>(
        std::clamp(std::floor(texel / tile_texels), 0.0, static_cast<double>(last)));
  };
  constexpr double slack = 2.0 * texel_slack;
  const auto [u_min, u_max] = std::minmax({u[0], u[1], u[2]});
  const auto [v_min, v_max] = std::minmax({v[0], v[1], v[2]});
  return {tile(u_min - slack), tile(u_max + slack), tile(v_min - slack), tile(v_max + slack)};
}

template <class Visit>
void for_each_tile(const TileRange& rect, int tiles, const Visit& visit) {
  for (int y = rect.y0; y <= rect.y1 && rect.x0 <= rect.x1; ++y)
    for (int x = rect.x0; x <= rect.x1; ++x)
      visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(tiles) + static_cast<std::size_t>(x));
}

}  // namespace

TileBins::TileBins(const World& world, const SheetGrid& grid, const std::vector<ProjectedPoint>& points) {
  constexpr std::size_t most_chunks = 64, counter_budget = std::size_t{1} << 22;
  const auto tile_count = static_cast<std::size_t>(grid.tiles) * static_cast<std::size_t>(grid.tiles);
  const std::size_t chunks = std::clamp<std::size_t>(counter_budget / tile_count, 1, most_chunks);
  const std::size_t triangles = world.triangle_count(), chunk = (triangles + chunks - 1) / chunks;
  std::vector<TileRange> rects(triangles);
  std::vector<std::uint64_t> next(chunks * tile_count);  // chunk by chunk, a counter for every tile
  const auto each = [&](std::size_t c, const auto& body) {
    for (std::size_t t = c * chunk; t < std::min(triangles, (c + 1) * chunk); ++t) body(t);
  };
  parallel_for(chunks, [&](std::size_t c) {
    each(c, [&](std::size_t t) {
      const auto v = world.triangle(static_cast<std::uint32_t>(t));
      rects[t] = rect_of(grid, {points[v[0]], points[v[1]], points[v[2]]});
      for_each_tile(rects[t], grid.tiles, [&](std::size_t tile) { ++next[c * tile_count + tile]; });
    });
  });
  first_.assign(tile_count + 1, 0);
  std::uint64_t sum = 0;
  for (std::size_t tile = 0; tile < tile_count; ++tile) {
    first_[tile] = sum;
    for (std::size_t c = 0; c < chunks; ++c) {
      const std::uint64_t count = next[c * tile_count + tile];
      next[c * tile_count + tile] = sum;
      sum += count;
    }
  }
  first_[tile_count] = sum;
  triangles_.resize(sum);
  parallel_for(chunks, [&](std::size_t c) {
    each(c, [&](std::size_t t) {
      for_each_tile(rects[t], grid.tiles, [&](std::size_t tile) {
        triangles_[next[c * tile_count + tile]++] = static_cast<std::uint32_t>(t);
      });
    });
  });
}

}  // namespace gnomon::hybrid
