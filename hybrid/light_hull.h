// A light with size as the hybrid sees it: a convex body around all that it samples, by its corners and by a
// ball. A sun's disc stands so far away that all the world sees it under nearly the same angle; the little
// that is missing is added to its radius.
#pragma once

#include <vector>

#include "scene/light.h"
#include "scene/world.h"

namespace gnomon::hybrid {

struct LightHull {
  std::vector<Vec3> corners;  ///< their convex hull holds the whole light
  Vec3 center{0.0};
  double radius = 0.0;  ///< of a ball around the center that holds the whole light
};

/// The light has a size. `reach`: no coordinate of a receiver is larger.
LightHull light_hull(const Light& light, const World& world, double reach);

/// The convex hull of a point (or a ball around it) and the light's ball.
class LightCone {
 public:
  LightCone(const Vec3& point, double point_radius, const LightHull& hull);
  /// The point's ball and the light's lie in one another: there is no cone.
  bool is_everything() const { return everything_; }
  /// Conservative.
  bool may_intersect_ball(const Vec3& center, double radius) const;
  /// `margin`: how far beside the cone still counts.
  bool may_intersect_segment(const Vec3& a, const Vec3& b, double margin) const;

 private:
  double beside(double lateral, double along) const {
    return lateral * cosine_ - along * sine_ - point_radius_;
  }

  Vec3 point_, axis_{0.0};
  double point_radius_, light_radius_, length_ = 0.0, sine_ = 0.0, cosine_ = 1.0;
  bool everything_ = false;
};

}  // namespace gnomon::hybrid
