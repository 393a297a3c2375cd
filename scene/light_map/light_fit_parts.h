// What the fits of a directional light's map share: the casters' rectangle and depths in light space, and
// what the camera can see of them. Light space: x along right, y along up, z along forward of a face,
// measured from a reference point. Private to scene.
#pragma once

#include <span>
#include <vector>

#include "scene/camera.h"
#include "scene/light_map/light_view.h"

namespace gnomon::light_fit {

struct Rect {
  Vec2 min{infinity}, max{-infinity};
  void grow(const Vec2& p) { min = glm::min(min, p), max = glm::max(max, p); }
  bool empty() const { return !(min.x <= max.x && min.y <= max.y); }
  bool overlaps(const Rect& o) const {
    return min.x <= o.max.x && o.min.x <= max.x && min.y <= o.max.y && o.min.y <= max.y;
  }
  Vec2 middle() const { return 0.5 * (min + max); }
  Vec2 extent() const { return max - min; }
};

/// A frame with this forward direction and up as near to `hint` as it gets.
LightFace face_along(const Vec3& forward, const Vec3& hint);
LightFace face_along(const Vec3& forward);

Vec3 to_light_space(const LightFace& face, const Vec3& offset);

/// Returns the rectangle around all finite casters.
Rect casters_rect(const World& world, const LightFace& face, const Vec3& reference);

/// Depths of the finite casters over `casters`, and of the infinite planes over `rect`. Empty for none.
Interval depths_over(const World& world, const LightFace& face, const Vec3& reference, const Rect& casters,
                     const Rect& rect);

/// What the camera sees between two depths, by its eight corners in light space.
std::vector<Vec2> frustum_corners(const View& view, double from, double to, const LightFace& face,
                                  const Vec3& reference);
/// The convex polygon around `points`, cut with the rectangle.
std::vector<Vec2> hull_in_rect(std::vector<Vec2> points, const Rect& rect);

/// From a point to the nearest surface, at most, and to the farthest finite one, at least; 0 where there is none.
double closest_distance(const World& world, const Vec3& p);
double farthest_distance(const World& world, const Vec3& p);

/// A picture's view for the fit, 1024 pixels high; `aspect` is width over height.
View view_of(const Camera& camera, double aspect);

/// The largest depth along the view direction at which the camera can see anything finite.
double finite_reach(const World& world, const View& view);

}  // namespace gnomon::light_fit
