#include "raytrace/sheets/shape_sheets.h"

#include <optional>

#include "raytrace/shapes/along_ray.h"
#include "raytrace/shapes/solid.h"

namespace gnomon::raytrace {
namespace {

constexpr double shape_gamma = error_gamma(64);

/// The distance of the column's rays from a sphere's centre: in the plane (orthographic), or as a part of the
/// sphere of directions, given by the angle between ray and centre. Both ends conservative.
Interval off_axis(const LightVertex& center, const TexelColumn& column, double slack) {
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

void append_sphere_sheets(const Sphere& sphere, std::uint32_t id, bool masked, const TexelColumn& column,
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
  if (distance + slack < r) {  // the light is inside: the far side alone, hit by every ray
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

namespace {

/// Depths, along forward, between which the rays through the corners of a widened column intersect a convex
/// solid.
struct ConvexRange {
  double last_entry = -infinity, first_exit = infinity;
};

// None unless each of these rays surely crosses the solid ahead of the light. Its shadow is convex, so every
// ray of the column crosses it then; and since the hull of the four entries lies in the solid, no ray enters
// it behind that hull, nor leaves it before the hull of the exits. The widening is far beyond the rounding of
// the crossings themselves.
std::optional<ConvexRange> convex_range(const ShapeGeometry& solid, const TexelColumn& column, double slack,
                                        double nearest_depth) {
  constexpr double steepest = 1e-4;  // cosine: below, rounding moves a crossing too far
  const double size = local_box(solid).diagonal();
  const double widening = 8.0 * slack + 1e-9 * size;
  if (column.perspective() && !(nearest_depth > widening)) return std::nullopt;
  const double wider = column.perspective() ? widening / nearest_depth : widening;
  const Vec2 middle = 0.5 * (column.min() + column.max());
  const LightFace& face = column.face();
  ConvexRange range;
  for (const Vec3& corner : column.corners()) {
    const Vec2 c = Vec2(corner) + wider * glm::sign(Vec2(corner) - middle);
    const Vec3 sideways = c.x * face.right + c.y * face.up;
    const Ray ray = column.perspective() ? Ray{column.origin(), face.forward + sideways}
                                         : Ray{column.origin() + sideways, face.forward};
    const auto frame = make_ray_frame(ray);
    if (!frame) return std::nullopt;
    const std::vector<double> at = solid_crossings(*frame, solid);
    if (at.size() != 2) return std::nullopt;
    for (std::size_t side = 0; side < 2; ++side) {
      const double depth = at[side] / frame->kernel_t_from_t;
      const double steep =
          std::abs(glm::dot(solid_normal(solid, ray.at(depth)), glm::normalize(ray.direction)));
      if (!(steep > steepest) || (column.perspective() && !(depth > widening))) return std::nullopt;
      const double error = widening / steep;
      if (side == 0)
        range.last_entry = std::max(range.last_entry, depth + error);
      else
        range.first_exit = std::min(range.first_exit, depth - error);
    }
  }
  return range;
}

}  // namespace

// One sheet per side, within the distances of the solid's box.
void append_solid_sheets(const ShapeGeometry& solid, std::uint32_t id, bool masked, const TexelColumn& column,
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
  if (masked || !is_convex(solid)) return;
  const auto range = convex_range(solid, column, slack, center.q.z - radius - slack);
  if (!range) return;
  // A depth becomes a distance by the length of the ray's direction (x, y, 1).
  double longest = 1.0, shortest = 1.0;
  if (column.perspective()) {
    for (const Vec3& corner : column.corners()) longest = std::max(longest, glm::length(corner));
    shortest = glm::length(Vec3(glm::clamp(Vec2(0.0), column.min(), column.max()), 1.0));
  }
  Sheet& front = sheets[sheets.size() - 2];
  Sheet& back = sheets.back();
  const double in = range->last_entry * longest, out = range->first_exit * shortest;
  front.has_boundary = back.has_boundary = false;
  front.farthest = std::min(front.farthest, in + shape_gamma * std::abs(in));
  back.nearest = std::max(back.nearest, out - shape_gamma * std::abs(out));
}

bool hang_together(const ShapeGeometry& solid, const Vec3& a, const Vec3& b, const Vec3& direction_a,
                   const Vec3& direction_b) {
  if (is_convex(solid)) return true;
  constexpr int pieces = 8;
  const ShapeFrame& frame = frame_of(solid);
  const Vec3 p = to_local(frame, a), step = to_local(frame, b) - p;
  const Vec3 d = glm::transpose(frame.axes) * direction_a, e = glm::transpose(frame.axes) * direction_b;
  const double length = glm::length(step), rounding = error_gamma(64) * local_box(solid).diagonal();
  const auto bounds = [&](const Bounds& along, const Bounds& depth) {
    const auto at = [&](int k) {
      const Bounds direction(std::min(d[k], e[k]), std::max(d[k], e[k]));
      return Slope(Bounds(p[k]) + along * Bounds(step[k]) + depth * direction, direction);
    };
    return body_slope(solid, at(0), at(1), at(2));
  };
  // Over every place between the two, from a depth before the chord to one behind it, the rays intersect the
  // surface once: then it is one piece.
  const auto proven = [&](double reach) {
    for (int i = 0; i < pieces; ++i) {
      const Bounds along(i / double(pieces), (i + 1) / double(pieces));
      const Bounds before = bounds(along, Bounds(-reach)).value, behind = bounds(along, Bounds(reach)).value;
      const Slope whole = bounds(along, Bounds(-reach, reach));
      const bool crosses =
          (before.positive() && behind.negative()) || (before.negative() && behind.positive());
      if (!(crosses && whole.value.sure && whole.change.without_zero())) return false;
    }
    return true;
  };
  for (const double share : {0.125, 0.5, 2.0})
    if (proven(share * length + rounding)) return true;
  return false;
}

void append_plane_sheet(const Plane& plane, std::uint32_t id, bool masked, const TexelColumn& column,
                        std::vector<Sheet>& sheets) {
  const LightFace& face = column.face();
  const Vec3 n(glm::dot(face.right, plane.normal), glm::dot(face.up, plane.normal),
               glm::dot(face.forward, plane.normal));
  const LightVertex point = column.vertex(plane.point);
  const double height = glm::dot(n, point.q);  // of the plane over the view's origin, along its normal
  const double height_error = 3.0 * point.error + shape_gamma * glm::dot(glm::abs(n), glm::abs(point.q));
  const bool faces_light = column.perspective() ? height < 0.0 : n.z < 0.0;
  double nearest = infinity, farthest = -infinity;
  int hit = 0, missed = 0;
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
    ++hit;
    const double error = (rise_error + std::abs(s) * slope_error) / (std::abs(slope) - slope_error);
    const double scale = column.perspective() ? glm::length(corner) : 1.0;
    nearest = std::min(nearest, (s - error) * scale);
    farthest = std::max(farthest, (s + error) * scale);
  }
  if (missed == 4) return;
  const bool boundary = masked || hit < 4;
  // The nearest point of a plane may lie between the corners; its height is a bound wherever that is.
  if (column.perspective()) {
    const Vec3 foot = n * height;
    const LightVertex v{foot, foot, height_error};
    const auto [low, high] = std::pair(column.min(), column.max());
    const bool above = column.may_contain(v);
    const bool beside = above || hit < 4 ||
                        (foot.z > 0.0 && ((foot.x >= low.x * foot.z && foot.x <= high.x * foot.z) ||
                                          (foot.y >= low.y * foot.z && foot.y <= high.y * foot.z)));
    if (beside) nearest = std::min(nearest, std::abs(height) - height_error);
  }
  if (hit < 4) {
    farthest = infinity;
    if (!column.perspective()) nearest = -infinity;
  }
  sheets.push_back(sheet(id, faces_light, boundary, nearest, farthest));
}

}  // namespace gnomon::raytrace
