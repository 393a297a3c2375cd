// When a ray crosses an axis-aligned wall, as bounds that hold whatever the rounding and wherever in its
// error interval the ray's origin truly lies. A structure that enters a cell at `entry_bound` and leaves it
// at `exit_bound` passes through both cells on a tie, and so through none too few. A ray along the wall
// (1/d infinite) is on one side for ever, or, with its origin ambiguous, on both.
#pragma once

#include "raytrace/accel/even_cells.h"
#include "raytrace/bvh/traverse.h"

namespace gnomon::raytrace {

/// The ray's parameter at the wall, or just before.
inline float entry_bound(const BoxRay& ray, std::size_t axis, float wall) {
  const float t = (wall - ray.near_origin[axis]) * ray.inverse[axis];
  const float lower = t * (t > 0.0f ? 1.0f - wall_slack : 1.0f + wall_slack);
  return lower >= -FLT_MAX ? lower : -std::numeric_limits<float>::infinity();  // NaN: already there
}

/// The ray's parameter at the wall, or just after.
inline float exit_bound(const BoxRay& ray, std::size_t axis, float wall) {
  const float t = (wall - ray.far_origin[axis]) * ray.inverse[axis];
  const float upper = t * (t > 0.0f ? 1.0f + wall_slack : 1.0f - wall_slack);
  return upper <= FLT_MAX ? upper : std::numeric_limits<float>::infinity();  // NaN: never leaves
}

inline bool goes_backwards(const BoxRay& ray, std::size_t axis) {
  return std::signbit(ray.inverse[axis]);
}

/// The part of the ray that may lie in a box.
struct RaySpan {
  float begin, end;
  bool empty() const { return !(begin <= end); }
};

inline RaySpan clip(const BoxRay& ray, const CellBox& box) {
  RaySpan span{ray.t_min, ray.t_max};
  for (std::size_t a = 0; a < 3; ++a) {
    const bool backwards = goes_backwards(ray, a);
    span.begin = std::max(span.begin, entry_bound(ray, a, backwards ? box.max[a] : box.min[a]));
    span.end = std::min(span.end, exit_bound(ray, a, backwards ? box.min[a] : box.max[a]));
  }
  return span;
}

/// Primitives hit lately, so that one which lies in several cells is mostly tested once. Forgetting costs a
/// test, never a hit. (Amanatides and Woo 1987 keep one mailbox per primitive; this one is private to the
/// ray: Shevtsov et al. 2007, "Highly parallel fast kd-tree construction".)
class Mailbox {
 public:
  Mailbox() { recent_.fill(no_id); }
  bool is_new(std::uint32_t item) {
    std::uint32_t& place = recent_[item % size];
    if (place == item) return false;
    place = item;
    return true;
  }

 private:
  static constexpr std::uint32_t size = 64;
  std::array<std::uint32_t, size> recent_;
};

/// Offers a cell's items to `visit`; true when it ends the traversal.
template <class Stats, class Visit>
bool visit_cell(std::span<const std::uint32_t> items, Mailbox& mailbox, Stats& stats, const Visit& visit) {
  for (const std::uint32_t item : items) {
    if (!mailbox.is_new(item)) continue;
    stats.primitive();
    if (visit(item)) return true;
  }
  return false;
}

}  // namespace gnomon::raytrace
