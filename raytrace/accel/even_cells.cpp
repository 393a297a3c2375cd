#include "raytrace/accel/even_cells.h"

#include <limits>

namespace gnomon::raytrace {
namespace {

constexpr int projection_operations = 16;  // roundings of a corner's projection on an axis, with its inputs'

/// Any axis on which the projections do not intersect proves the two apart, so the axis itself need not be
/// exact.
bool surely_apart(const Vec3& axis, const std::array<Vec3, 3>& corners, const Vec3& middle, const Vec3& half,
                  const Vec3& reach) {
  double lo = infinity, hi = -infinity;
  for (const Vec3& corner : corners) {
    const double at = glm::dot(axis, corner - middle);
    lo = std::min(lo, at), hi = std::max(hi, at);
  }
  const Vec3 size = glm::abs(axis);
  const double radius = glm::dot(size, half) + error_gamma(projection_operations) * glm::dot(size, reach);
  return lo > radius || hi < -radius;
}

bool triangle_may_overlap(const std::array<Vec3, 3>& corners, const CellBox& cell) {
  const Vec3 lo(cell.min[0], cell.min[1], cell.min[2]), hi(cell.max[0], cell.max[1], cell.max[2]);
  const Vec3 middle = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
  Vec3 reach = glm::abs(lo) + glm::abs(hi);
  for (const Vec3& corner : corners) reach = reach + glm::abs(corner);
  const std::array<Vec3, 3> edges{corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]};
  if (surely_apart(glm::cross(edges[0], edges[1]), corners, middle, half, reach)) return false;
  for (const Vec3& e : edges)
    for (const Vec3& axis : {Vec3(0.0, -e.z, e.y), Vec3(e.z, 0.0, -e.x), Vec3(-e.y, e.x, 0.0)})
      if (surely_apart(axis, corners, middle, half, reach)) return false;
  return true;
}

}  // namespace

CellItems::CellItems(const World& world) : world_(&world), finite_(finite_primitives(world)) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  bounds_ = {{inf, inf, inf}, {-inf, -inf, -inf}};
  for (const BoxRef& box : finite_.boxes)
    for (std::size_t a = 0; a < 3; ++a) {
      bounds_.min[a] = std::min(bounds_.min[a], box.min[a]);
      bounds_.max[a] = std::max(bounds_.max[a], box.max[a]);
    }
}

std::array<Vec3, 3> CellItems::corners(std::uint32_t item) const {
  const auto [a, b, c] = world_->corners(finite_.boxes[item].id);
  return {a - finite_.center, b - finite_.center, c - finite_.center};
}

bool CellItems::may_overlap(std::uint32_t item, const CellBox& cell) const {
  const BoxRef& box = finite_.boxes[item];
  bool inside = true;
  for (std::size_t a = 0; a < 3; ++a) {
    if (box.max[a] < cell.min[a] || box.min[a] > cell.max[a]) return false;
    inside = inside && box.min[a] >= cell.min[a] && box.max[a] <= cell.max[a];
  }
  return inside || !is_triangle(item) || triangle_may_overlap(corners(item), cell);
}

}  // namespace gnomon::raytrace
