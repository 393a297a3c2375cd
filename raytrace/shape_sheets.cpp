#include "raytrace/shape_sheets.h"

namespace gnomon::raytrace {
namespace {

constexpr double shape_gamma = error_gamma(64);

/// The distance of the column's rays from a sphere's centre: in the plane (orthographic), or as a part of the
/// sphere of directions, given by the angle between ray and centre. Both ends conservative.
Interval off_axis(const LightVertex& center, const Column& column, double slack) {
  const Vec2 lo = column.min(), hi = column.max();
  if (!column.perspective()) {
    const Vec2 c(center.q);
    const Vec2 outside = glm::max(Vec2(0.0), glm::max(lo - c, c - hi));
    const Vec2 farthest = glm::max(glm::abs(lo - c), glm::abs(hi - c));
    return {std::max(0.0, glm::length(outside) - slack), glm::length(farthest) + slack};
  }
  // The angle to a fixed direction is quasiconvex: its maximum over the column is at a corner.
  const auto angle = [](const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
  };
  const Vec3 middle(0.5 * (lo + hi), 1.0);
  double radius = 0.0, farthest = 0.0;
  for (const Vec3& corner : column.corners()) {
    radius = std::max(radius, angle(middle, corner));
    farthest = std::max(farthest, angle(center.q, corner));
  }
  return {std::max(0.0, angle(center.q, middle) - radius - slack), std::min(pi, farthest + slack)};
}

Sheet sheet(std::uint32_t id, bool faces_light, bool has_boundary, double nearest, double farthest) {
  return {{id}, faces_light, has_boundary, nearest, farthest};
}

}  // namespace

void append_sphere_sheets(const Sphere& sphere, std::uint32_t id, bool masked, const Column& column,
                          std::vector<Sheet>& sheets) {
  const LightVertex center = column.vertex(sphere.center);
  const double r = sphere.radius;
  const double slack = center.error + shape_gamma * (r + column.grid_error());
  if (!column.perspective()) {
    const Interval off = off_axis(center, column, slack + column.grid_error());
    if (off.min > r) return;
    const double half_max = std::sqrt(std::max(0.0, (r - off.min) * (r + off.min)));
    const double half_min = off.max < r ? std::sqrt((r - off.max) * (r + off.max)) : 0.0;
    const bool boundary = masked || off.max >= r;
    const double z = center.q.z;
    sheets.push_back(sheet(id, true, boundary, z - half_max - slack, z - half_min + slack));
    sheets.push_back(sheet(id, false, boundary, z + half_min - slack, z + half_max + slack));
    return;
  }
  const double distance = glm::length(center.q);
  const Interval angle =
      off_axis(center, column, shape_gamma + column.grid_error() + (distance > 0.0 ? slack / distance : pi));
  // Entry and exit at an angle; beyond the silhouette's angle both are at the tangent point.
  const auto half = [&](double a) {
    const double s = distance * std::sin(a);
    return a < pi / 2.0 || distance < r ? std::sqrt(std::max(0.0, (r - s) * (r + s))) : 0.0;
  };
  const auto middle = [&](double a) { return distance * std::cos(a); };
  if (distance + slack < r) {  // the light is inside: the far side alone, met by every ray
    sheets.push_back(sheet(id, false, masked, middle(angle.max) + half(angle.max) - slack,
                           middle(angle.min) + half(angle.min) + slack));
    return;
  }
  if (distance - slack <= r) {  // the light may be on the sphere
    sheets.push_back(sheet(id, true, true, 0.0, slack));
    sheets.push_back(sheet(id, false, true, 0.0, 2.0 * r + slack));
    return;
  }
  const double silhouette = std::asin(r / distance);
  if (angle.min > silhouette) return;
  const bool boundary = masked || angle.max >= silhouette - shape_gamma;
  const double last = std::min(angle.max, silhouette);
  sheets.push_back(sheet(id, true, boundary, middle(angle.min) - half(angle.min) - slack,
                         middle(last) - half(last) + slack));
  sheets.push_back(sheet(id, false, boundary, middle(last) + half(last) - slack,
                         middle(angle.min) + half(angle.min) + slack));
  // Near the silhouette the root magnifies rounding: both sides reach to the tangent point, which bounds
  // them.
  if (boundary) {
    const double tangent = std::sqrt((distance - r) * (distance + r));
    Sheet& front = sheets[sheets.size() - 2];
    front.farthest = std::max(front.farthest, tangent + slack);
    sheets.back().nearest = std::min(sheets.back().nearest, tangent - slack);
  }
}

// One sheet per side, within the distances of the solid's box.
void append_solid_sheets(const ShapeGeometry& solid, std::uint32_t id, bool, const Column& column,
                         std::vector<Sheet>& sheets) {
  const Aabb box = local_box(solid);
  const LightVertex center = column.vertex(solid_center(solid));
  const double radius = 0.5 * box.diagonal();
  const double slack = center.error + shape_gamma * (radius + column.grid_error());
  const double reach = column.perspective() ? radius : reach_along(solid, column.face().forward);
  const double middle = column.perspective() ? glm::length(center.q) : center.q.z;
  const double least = middle - reach - slack;
  const double nearest = column.perspective() ? std::max(0.0, least) : least;
  sheets.push_back(sheet(id, true, true, nearest, middle + reach + slack));
  sheets.push_back(sheet(id, false, true, nearest, middle + reach + slack));
}

void append_plane_sheet(const Plane& plane, std::uint32_t id, bool masked, const Column& column,
                        std::vector<Sheet>& sheets) {
  const LightFace& face = column.face();
  const Vec3 n(glm::dot(face.right, plane.normal), glm::dot(face.up, plane.normal),
               glm::dot(face.forward, plane.normal));
  const LightVertex point = column.vertex(plane.point);
  const double height = glm::dot(n, point.q);  // of the plane over the view's origin, along its normal
  const double height_error = 3.0 * point.error + shape_gamma * glm::dot(glm::abs(n), glm::abs(point.q));
  const bool faces_light = column.perspective() ? height < 0.0 : n.z < 0.0;
  double nearest = infinity, farthest = -infinity;
  int met = 0, missed = 0;
  for (const Vec3& corner : column.corners()) {
    // Perspective: rays s * corner from the light. Orthographic: rays (corner.x, corner.y, s).
    const Vec3 direction = column.perspective() ? corner : Vec3(0.0, 0.0, 1.0);
    const double start = column.perspective() ? 0.0 : n.x * corner.x + n.y * corner.y;
    const double slope = glm::dot(n, direction);
    const double slope_error =
        shape_gamma * glm::dot(glm::abs(n), glm::abs(direction)) + 2.0 * column.grid_error();
    const double rise = height - start;
    const double rise_error = height_error + shape_gamma * std::abs(start) + 2.0 * column.grid_error();
    if (std::abs(slope) <= slope_error || (column.perspective() && std::abs(rise) <= rise_error)) continue;
    const double s = rise / slope;
    if (column.perspective() && s < 0.0) {
      ++missed;
      continue;
    }
    ++met;
    const double error = (rise_error + std::abs(s) * slope_error) / (std::abs(slope) - slope_error);
    const double scale = column.perspective() ? glm::length(corner) : 1.0;
    nearest = std::min(nearest, (s - error) * scale);
    farthest = std::max(farthest, (s + error) * scale);
  }
  if (missed == 4) return;
  const bool boundary = masked || met < 4;
  // The nearest point of a plane may lie between the corners; its height is a bound wherever that is.
  if (column.perspective()) {
    const Vec3 foot = n * height;
    const LightVertex v{foot, foot, height_error};
    const auto [low, high] = std::pair(column.min(), column.max());
    const bool above = column.may_contain(v);
    const bool beside = above || met < 4 ||
                        (foot.z > 0.0 && ((foot.x >= low.x * foot.z && foot.x <= high.x * foot.z) ||
                                          (foot.y >= low.y * foot.z && foot.y <= high.y * foot.z)));
    if (beside) nearest = std::min(nearest, std::abs(height) - height_error);
  }
  if (met < 4) {
    farthest = infinity;
    if (!column.perspective()) nearest = -infinity;
  }
  sheets.push_back(sheet(id, faces_light, boundary, nearest, farthest));
}

}  // namespace gnomon::raytrace
