// What the fits of a directional light's map share of plane geometry: frames of light space, the camera's frustum in it, and
// convex polygons cut with rectangles.
#include "scene/light_map/light_fit_parts.h"

#include <algorithm>

namespace gnomon::light_fit {
namespace {

// Sutherland-Hodgman against one side: keeps sign * p[axis] <= sign * bound.
std::vector<Vec2> clip_side(const std::vector<Vec2>& polygon, int axis, double bound, double sign) {
  std::vector<Vec2> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& a = polygon[i];
    const Vec2& b = polygon[(i + 1) % polygon.size()];
    const double da = sign * (bound - a[axis]);
    const double db = sign * (bound - b[axis]);
    if (da >= 0.0) out.push_back(a);
    if ((da >= 0.0) != (db >= 0.0)) out.push_back(a + (b - a) * (da / (da - db)));
  }
  return out;
}

std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<Vec2> hull;
  const auto turn = [](const Vec2& o, const Vec2& a, const Vec2& b) {
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
  };
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0.0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

}  // namespace

LightFace face_along(const Vec3& forward, const Vec3& hint) {
  LightFace face;
  face.right = glm::normalize(glm::cross(forward, hint));
  face.up = glm::cross(face.right, forward), face.forward = forward;
  return face;
}

LightFace face_along(const Vec3& forward) {
  return face_along(forward, std::abs(forward.y) < 0.999 ? Vec3(0.0, 1.0, 0.0) : Vec3(0.0, 0.0, -1.0));
}

Vec3 to_light_space(const LightFace& f, const Vec3& d) {
  return {glm::dot(f.right, d), glm::dot(f.up, d), glm::dot(f.forward, d)};
}

std::vector<Vec2> frustum_corners(const View& view, double from, double to, const LightFace& face,
                                  const Vec3& reference) {
  std::vector<Vec2> corners;
  for (const double depth : {from, to})
    for (const Vec2 s : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)})
      corners.push_back(
          Vec2(to_light_space(face, view.ray_origin(s) + depth * view.ray_direction(s) - reference)));
  return corners;
}

std::vector<Vec2> hull_in_rect(std::vector<Vec2> points, const Rect& rect) {
  std::vector<Vec2> polygon = convex_hull(std::move(points));
  for (int axis = 0; axis < 2; ++axis) {
    polygon = clip_side(polygon, axis, rect.max[axis], 1.0);
    polygon = clip_side(polygon, axis, rect.min[axis], -1.0);
  }
  return polygon;
}

double finite_reach(const World& world, const View& view) {
  double reach = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1) ? world.finite_bounds.max.x : world.finite_bounds.min.x,
                 (corner & 2) ? world.finite_bounds.max.y : world.finite_bounds.min.y,
                 (corner & 4) ? world.finite_bounds.max.z : world.finite_bounds.min.z);
    reach = std::max(reach, glm::dot(p - view.eye, view.forward));
  }
  return reach;
}

View view_of(const Camera& camera, double aspect) {
  return make_view(camera, {std::max(1, static_cast<int>(std::lround(1024 * aspect))), 1024});
}

}  // namespace gnomon::light_fit
