#include "raytrace/packets/sight.h"

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
  std::span<const QuantisedTile> tiles;
  std::span<const std::uint8_t> wanted;
  bool is_wanted(std::size_t i) const { return tiles[i].any && (wanted.empty() || wanted[i] != 0); }
};

/// A place's (u, v); false: it is not ahead.
bool project_point(const EdgeSetup& setup, const Vec3& position, double& u, double& v) {
  const Vec3 p = position - setup.origin;
  u = glm::dot(p, setup.axes[0]), v = glm::dot(p, setup.axes[1]);
  if (setup.directional) return true;
  const double depth = glm::dot(p, setup.axes[2]);
  u /= depth, v /= depth;
  return depth > 0.0;
}

/// (u, v) of a box, by its corners; false: not all of it ahead.
bool grow_by_box(const EdgeSetup& setup, const Aabb& box, Range& u, Range& v) {
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3 p = box.min;
    for (int a = 0; a < 3; ++a)
      if ((corner >> a & 1) != 0) p[a] = box.max[a];
    double x = 0.0, y = 0.0;
    if (!project_point(setup, p, x, y)) return false;
    u.grow(x), v.grow(y);
  }
  return true;
}

/// (u, v) of what the tiles hold; false: not all of it ahead and within reach.
bool ranges_of(const EdgeSetup& setup, const SightTiles& all, Range& u, Range& v) {
  for (std::size_t i = 0; i < all.tiles.size(); ++i)
    if (all.is_wanted(i) && !grow_by_box(setup, all.tiles[i].bounds, u, v)) return false;
  const auto in_frame = [](const Range& r) { return r.low > -widest_frame && r.high < widest_frame; };
  if (!setup.directional && !(in_frame(u) && in_frame(v))) return false;
  return u.low <= u.high && v.low <= v.high;
}

/// A range with room for what rounding may have moved its ends.
Range with_slack(const Range& range) {
  const double largest = std::max(std::abs(range.low), std::abs(range.high));
  const double slack = 0x1p-18 * largest + 0x1p-12 * (range.high - range.low);
  return {range.low - slack, range.high + slack};
}

/// Infinite where the finite things are not all ahead.
PlaneLimits limits_of(const Structures& s, const EdgeSetup& setup) {
  Range u, v;
  if (!grow_by_box(setup, s.world->finite_bounds, u, v)) return {};
  const Range wide_u = with_slack(u), wide_v = with_slack(v);
  return {static_cast<float>(wide_u.low), static_cast<float>(wide_u.high), static_cast<float>(wide_v.low),
          static_cast<float>(wide_v.high)};
}

/// What of the range lies within the limits; a point of them where that is nothing.
Range within(const Range& range, float low, float high) {
  const Range common{std::max(range.low, static_cast<double>(low)),
                     std::min(range.high, static_cast<double>(high))};
  return common.low <= common.high ? common : Range{static_cast<double>(low), static_cast<double>(low)};
}

std::size_t receivers_in(const SightTiles& all, Aabb& bounds) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < all.tiles.size(); ++i) {
    if (!all.is_wanted(i)) continue;
    const QuantisedTile& tile = all.tiles[i];
    bounds.grow(tile.bounds);
    for (const std::uint16_t bits : tile.present) count += static_cast<std::size_t>(std::popcount(bits));
  }
  return count;
}

BinAxis axis_over(const Range& range, int bins) {
  const Range wide = with_slack(range);
  const double largest = std::max(std::abs(range.low), std::abs(range.high));
  const double low = static_cast<double>(static_cast<float>(wide.low));
  const double width = static_cast<double>(static_cast<float>((wide.high - low) / bins));
  // A ray's step is found in floats: (v - low) / width, right to 2^-22 of it.
  const double error = 0x1p-21 * bins * width + 0x1p-22 * largest;
  return {low - error,
          low + width + error,
          width,
          bins,
          1,
          static_cast<float>(low),
          static_cast<float>(1.0 / width)};
}

/// Bins per axis. Within a bin primitives are told apart by their boxes, so that some sixteen of them in
/// one are no loss, while rays of one packet in several bins are.
int bins_per_axis(const Structures& s) {
  const double wanted = 0.2 * std::sqrt(static_cast<double>(s.bvh.primitives.size()));
  return std::clamp(static_cast<int>(wanted), 64, 512);
}

/// The bin's list that a place reads; 0: it lies beyond the bins.
std::size_t list_length(const LightBins& bins, double u, double v) {
  const auto bin = [](const BinAxis& axis, double value) {
    return std::floor((value - axis.lo) / (axis.width * axis.per_bin));
  };
  const double x = bin(bins.u, u), y = bin(bins.v, v);
  if (!(x >= 0.0 && y >= 0.0 && x < bins.columns() && y < bins.rows())) return 0;
  const auto i =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(bins.columns()) + static_cast<std::size_t>(x);
  return bins.first[i + 1] - bins.first[i];
}

/// Bins of equal size are too coarse where all that is looked at is small and the world is large (a teapot
/// in a stadium): the lists that the tiles' middles read are then longer than a traversal down the tree is.
bool lists_are_short(const EdgeSetup& setup, const LightBins& bins, const SightTiles& all) {
  constexpr double longest_mean = 1024.0;
  constexpr std::size_t samples = 1024;
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < all.tiles.size(); i += 1 + all.tiles.size() / samples) {
    double u = 0.0, v = 0.0;
    if (!all.is_wanted(i) || !project_point(setup, all.tiles[i].bounds.center(), u, v)) continue;
    sum += static_cast<double>(list_length(bins, u, v)), count += 1.0;
  }
  return sum <= longest_mean * count;
}

Sight by_hierarchy(const Structures& s, const Light& light) {
  Sight sight;
  sight.setup = edge_setup_from(s, light);
  return sight;
}

}  // namespace

bool packets_apply(const Tracer& tracer) {
  const Structures& s = tracer.structures();
  const double size = s.world->finite_bounds.diagonal();
  const double far = max_component(glm::abs(s.bvh.center)) + size;
  return s.precision != Precision::fast && !s.bvh.nodes.empty() && size > 1e-9 && far < 1e9;
}

EdgeSetup edge_setup_from(const Structures& s, const Light& light) {
  return light.type == LightType::directional ? edge_setup_along(s, -light.direction)
                                              : edge_setup_from(s, light.position, true);
}

bool blocks_apply(const Tracer& tracer, const View& view) {
  return packets_apply(tracer) && view.tan_half_x < widest_frame && view.tan_half_y < widest_frame;
}

EdgeSetup edge_setup_of_eye(const Tracer& tracer, const View& view) {
  const Structures& s = tracer.structures();
  EdgeSetup setup = open_edge_setup_from(s, view.eye, false);
  frame_edge_setup(s, view.right, view.forward, setup);
  return setup;
}

Sight sight_of_light(const Tracer& tracer, const Light& light, std::span<const QuantisedTile> all_tiles,
                     std::span<const std::uint8_t> wanted) {
  const Structures& s = tracer.structures();
  const SightTiles tiles{all_tiles, wanted};
  Aabb bounds;
  const std::size_t rays = receivers_in(tiles, bounds);
  if (rays == 0 || !bins_pay(s, rays)) return by_hierarchy(s, light);
  Sight sight;
  if (light.type == LightType::directional) {
    sight.setup = open_edge_setup_along(s, -light.direction);
  } else {
    const Vec3 middle = bounds.center() - light.position;
    const double distance = glm::length(middle);
    if (!(distance > 0.0)) return by_hierarchy(s, light);
    sight.setup = open_edge_setup_from(s, light.position, true);
    Vec3 right, up;
    orthonormal_basis(middle / distance, right, up);
    frame_edge_setup(s, right, middle / distance, sight.setup);
  }
  Range u, v;
  if (!ranges_of(sight.setup, tiles, u, v)) return by_hierarchy(s, light);
  const PlaneLimits limits = sight.bins.limits = limits_of(s, sight.setup);
  const int bins = bins_per_axis(s);
  sight.bins.u = axis_over(within(u, limits.u_min, limits.u_max), bins);
  sight.bins.v = axis_over(within(v, limits.v_min, limits.v_max), bins);
  sight.by_bins =
      fill_light_bins(s, sight.setup, sight.bins) && lists_are_short(sight.setup, sight.bins, tiles);
  return sight.by_bins ? std::move(sight) : by_hierarchy(s, light);
}

bool is_beyond_all(const Structures& s, const Sight& sight, const SurfacePoint& receiver) {
  if (!sight.by_bins || s.planes.size() != 1 || receiver.primitive != s.planes.front()) return false;
  double u = 0.0, v = 0.0;
  if (!project_point(sight.setup, receiver.position, u, v)) return false;
  const PlaneLimits& limits = sight.bins.limits;
  return u < static_cast<double>(limits.u_min) || u > static_cast<double>(limits.u_max) ||
         v < static_cast<double>(limits.v_min) || v > static_cast<double>(limits.v_max);
}

bool covers(const Sight& sight, std::span<const QuantisedTile> tiles, std::span<const std::uint8_t> wanted) {
  if (!sight.by_bins) return true;
  Range u, v;
  if (!ranges_of(sight.setup, {tiles, wanted}, u, v)) return false;
  const auto holds = [](const BinAxis& axis, const Range& range) {
    return range.low >= axis.lo && range.high <= axis.lo + axis.count * axis.width;
  };
  const PlaneLimits& limits = sight.bins.limits;
  return holds(sight.bins.u, within(u, limits.u_min, limits.u_max)) &&
         holds(sight.bins.v, within(v, limits.v_min, limits.v_max));
}

}  // namespace gnomon::raytrace
