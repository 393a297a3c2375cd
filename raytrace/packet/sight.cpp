#include "raytrace/packet/sight.h"

#include <bit>

namespace gnomon::raytrace {
namespace {

/// How wide the rays of a point may spread for one frame to hold them, with room for rounding.
constexpr double widest_frame = widest_slope - 0x1p-10;

struct Range {
  double low = infinity, high = -infinity;
  void grow(double v) { low = std::min(low, v), high = std::max(high, v); }
};

struct SightTiles {
  std::span<const CompactTile> tiles;
  std::span<const std::uint8_t> wanted;
  bool is_wanted(std::size_t i) const { return tiles[i].any && (wanted.empty() || wanted[i] != 0); }
};

/// (u, v) of what the tiles hold, by the corners of their boxes; false: not all of it ahead and within reach.
bool ranges_of(const Seen& seen, const SightTiles& all, Range& u, Range& v) {
  for (std::size_t i = 0; i < all.tiles.size(); ++i) {
    if (!all.is_wanted(i)) continue;
    const CompactTile& tile = all.tiles[i];
    for (unsigned corner = 0; corner < 8; ++corner) {
      Vec3 p = tile.bounds.min;
      for (int a = 0; a < 3; ++a)
        if ((corner >> a & 1) != 0) p[a] = tile.bounds.max[a];
      p -= seen.origin;
      Vec3 q(glm::dot(p, seen.axes[0]), glm::dot(p, seen.axes[1]), glm::dot(p, seen.axes[2]));
      if (!seen.directional) {
        if (!(q.z > 0.0)) return false;
        q /= q.z;
        if (!(std::abs(q.x) < widest_frame && std::abs(q.y) < widest_frame)) return false;
      }
      u.grow(q.x), v.grow(q.y);
    }
  }
  return u.low <= u.high && v.low <= v.high;
}

std::size_t receivers_in(const SightTiles& all, Aabb& bounds) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < all.tiles.size(); ++i) {
    if (!all.is_wanted(i)) continue;
    const CompactTile& tile = all.tiles[i];
    bounds.grow(tile.bounds);
    for (const std::uint16_t bits : tile.present) count += static_cast<std::size_t>(std::popcount(bits));
  }
  return count;
}

CellAxis axis_over(const Range& range, int cells) {
  // Widened so that no ray in the range falls outside by rounding.
  const double largest = std::max(std::abs(range.low), std::abs(range.high));
  const double slack = 0x1p-18 * largest + 0x1p-12 * (range.high - range.low);
  const double low = static_cast<double>(static_cast<float>(range.low - slack));
  const double width = static_cast<double>(static_cast<float>((range.high + slack - low) / cells));
  // A ray's step is found in floats: (v - low) / width, right to 2^-22 of it.
  const double doubt = 0x1p-21 * cells * width + 0x1p-22 * largest;
  return {low - doubt,
          low + width + doubt,
          width,
          cells,
          1,
          static_cast<float>(low),
          static_cast<float>(1.0 / width)};
}

/// Cells per axis. Within a cell primitives are told apart by their boxes, so that some sixteen of them in
/// one are no loss, while rays of one packet in several cells are.
int cells_per_axis(const Structures& s) {
  const double wanted = 0.2 * std::sqrt(static_cast<double>(s.bvh.primitives.size()));
  return std::clamp(static_cast<int>(wanted), 64, 512);
}

Sight by_hierarchy(const Structures& s, const Light& light) {
  Sight sight;
  sight.seen = seen_from(s, light);
  return sight;
}

}  // namespace

bool packets_apply(const Structures& s) {
  const double size = s.world->finite_bounds.diagonal();
  const double far = max_component(glm::abs(s.bvh.center)) + size;
  return s.precision != Precision::fast && !s.bvh.nodes.empty() && size > 1e-9 && far < 1e9;
}

Seen seen_from(const Structures& s, const Light& light) {
  return light.type == LightType::directional ? seen_along(s, -light.direction)
                                              : seen_from(s, light.position, true);
}

Sight sight_of_eye(const Structures& s, const View& view) {
  Sight sight;
  if (cells_pay(s, view.size.pixels()) && view.tan_half_x < widest_frame && view.tan_half_y < widest_frame) {
    sight.seen = open_seen_from(s, view.eye, false);
    frame_seen(s, view.right, view.forward, sight.seen);
    const auto axis = [](double tan_half, int pixels) {
      const double width = 2.0 * tan_half / pixels, first = 0.5 * width - tan_half;
      return CellAxis{first, first, width, pixels, 4, 0.0f, 0.0f};
    };
    sight.cells.u = axis(view.tan_half_x, view.size.width);
    sight.cells.v = axis(view.tan_half_y, view.size.height);
    sight.by_cells = fill_cells(s, sight.seen, sight.cells);
  }
  if (!sight.by_cells) sight.seen = seen_from(s, view.eye, false), sight.cells = {};
  return sight;
}

Sight sight_of_light(const Structures& s, const Light& light, std::span<const CompactTile> all_tiles,
                     std::span<const std::uint8_t> wanted) {
  const SightTiles tiles{all_tiles, wanted};
  Aabb bounds;
  const std::size_t rays = receivers_in(tiles, bounds);
  if (rays == 0 || !cells_pay(s, rays)) return by_hierarchy(s, light);
  Sight sight;
  if (light.type == LightType::directional) {
    sight.seen = open_seen_along(s, -light.direction);
  } else {
    const Vec3 middle = bounds.center() - light.position;
    const double distance = glm::length(middle);
    if (!(distance > 0.0)) return by_hierarchy(s, light);
    sight.seen = open_seen_from(s, light.position, true);
    Vec3 right, up;
    orthonormal_basis(middle / distance, right, up);
    frame_seen(s, right, middle / distance, sight.seen);
  }
  Range u, v;
  if (!ranges_of(sight.seen, tiles, u, v)) return by_hierarchy(s, light);
  const int cells = cells_per_axis(s);
  sight.cells.u = axis_over(u, cells), sight.cells.v = axis_over(v, cells);
  sight.by_cells = fill_cells(s, sight.seen, sight.cells);
  return sight.by_cells ? std::move(sight) : by_hierarchy(s, light);
}

bool covers(const Sight& sight, std::span<const CompactTile> tiles, std::span<const std::uint8_t> wanted) {
  if (!sight.by_cells) return true;
  Range u, v;
  if (!ranges_of(sight.seen, {tiles, wanted}, u, v)) return false;
  const auto holds = [](const CellAxis& axis, const Range& range) {
    return range.low >= axis.lo && range.high <= axis.lo + axis.count * axis.width;
  };
  return holds(sight.cells.u, u) && holds(sight.cells.v, v);
}

}  // namespace gnomon::raytrace
