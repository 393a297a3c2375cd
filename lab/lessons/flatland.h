// A built-in scene cut by an upright plane, for the live figures in which light is dragged. What is left of the scene is a
// flatland of line segments and circles. Its shadows are computed in the page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "scene/base/expected.h"
#include "scene/world.h"

namespace gnomon::lab::lessons {

/// An upright plane through `origin`; across it x counts along `right` (unit, horizontal), y upwards.
struct CutPlane {
  Vec3 origin{0.0}, right{1.0, 0.0, 0.0};
};

/// The part of the plane that a drawing shows.
struct CutWindow {
  double left = -1.0, right = 1.0, bottom = 0.0, top = 1.0;
};

/// {"segments": [[x0, y0, x1, y1, nx, ny], …], "circles": [[x, y, radius], …]} in world units. A segment's ends lie
/// within the window's width; (nx, ny) is what the plane sees of the surface's outward normal. Triangles give
/// segments, planes one each, spheres circles, other solids segments of their meshes.
nlohmann::ordered_json cut_world(const World& world, const CutPlane& plane, const CutWindow& window);

/// The flatland of that name (boxes, wall, floor, leak, ball, disc). It has its cut, the window, the scene's name, and the first
/// light as the plane sees it. The light is {"direction": [x, y]} or {"position": [x, y]}, with the "radius" of its size. Error
/// (internal): no such name.
Expected<nlohmann::ordered_json> flatland(const std::string& name);

/// The scene `whitted` cut by the upright plane through the centres of its glass and its mirror ball. It is a flatland, and
/// has besides:
/// - "materials" [{name, mirror, transmission, ior}] of its circles
/// - "least_share" of a pixel for which a ray is followed
/// - "fresnel" [{cosine, ratio, reflected}]: what the ray tracer computes
Expected<nlohmann::ordered_json> whitted_cut();

}  // namespace gnomon::lab::lessons
