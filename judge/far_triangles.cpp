#include "judge/far_triangles.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/result/number_text.h"

namespace gnomon::judge {
namespace {

constexpr double absurd = 100.0;  ///< times the reach of most triangles, or of what is seen

/// How far a triangle's corners lie from the middle of what is seen.
double reach_of(const std::array<Vec3, 3>& corners, const Vec3& middle) {
  double reach = 0.0;
  for (const Vec3& corner : corners) reach = std::max(reach, glm::length(corner - middle));
  return reach;
}

Aabb seen_box(const raytrace::RayTracedFrame& traced) {
  Aabb box;
  for (const raytrace::SurfacePoint& point : traced.receiver.data)
    if (point.primitive != no_id) box.grow(point.position);
  return box;
}

}  // namespace

double seen_diagonal(const raytrace::RayTracedFrame& traced) {
  const Aabb box = seen_box(traced);
  return box.empty() ? 0.0 : box.diagonal();
}

std::vector<std::string> far_triangle_notes(const World& world, const raytrace::RayTracedFrame& traced) {
  const Aabb seen = seen_box(traced);
  if (seen.empty() || !(world.finite_bounds.diagonal() > absurd * seen.diagonal())) return {};
  std::vector<double> reaches;
  double farthest = 0.0;
  std::string name;
  for (const WorldPart& part : world.parts)
    for (std::uint32_t k = 0; k < part.triangle_count(); ++k) {
      reaches.push_back(reach_of(part.corners(k), seen.center()));
      if (reaches.back() > farthest) farthest = reaches.back(), name = part.mesh->name;
    }
  if (reaches.empty()) return {};
  std::vector<double> sorted = reaches;
  const auto most = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) * 99 / 100);
  std::nth_element(sorted.begin(), most, sorted.end());
  const double limit = absurd * std::max(*most, seen.diagonal());
  const auto count =
      std::count_if(reaches.begin(), reaches.end(), [limit](double reach) { return reach > limit; });
  if (count == 0) return {};
  return {fmt::format(
      "{} of {} triangles ({}) reach{} absurdly far, up to {:.3g} world units in '{}': a corner is "
      "broken there; lengths are measured by the others",
      compare::grouped(static_cast<std::uint64_t>(count)), compare::grouped(reaches.size()),
      compare::percent(double(count) / double(reaches.size())), count == 1 ? "es" : "", farthest, name)};
}

}  // namespace gnomon::judge
