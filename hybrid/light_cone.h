// What a receiver and a light with size have between them: all that can stand in the way.
#pragma once

#include "scene/light_shape/light_shape.h"

namespace gnomon::hybrid {

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
