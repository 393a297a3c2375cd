#include "hybrid/light_cone.h"

namespace gnomon::hybrid {

LightCone::LightCone(const Vec3& point, double point_radius, const LightHull& hull)
    : point_(point), point_radius_(point_radius), light_radius_(hull.radius) {
  const Vec3 to_light = hull.center - point;
  length_ = glm::length(to_light);
  everything_ = !(length_ > light_radius_ + point_radius_);
  if (everything_) return;
  axis_ = to_light / length_;
  sine_ = (light_radius_ - point_radius_) / length_;
  cosine_ = std::sqrt((1.0 - sine_) * (1.0 + sine_));
}

bool LightCone::may_intersect_ball(const Vec3& center, double radius) const {
  if (everything_) return true;
  const Vec3 d = center - point_;
  const double along = glm::dot(d, axis_);
  if (along < -(point_radius_ + radius) || along > length_ + light_radius_ + radius) return false;
  return beside(glm::length(d - along * axis_), along) <= radius;
}

// beside() of a point of the segment is convex along it: its least value is at an end or where its slope
// vanishes.
bool LightCone::may_intersect_segment(const Vec3& a, const Vec3& b, double margin) const {
  if (everything_) return true;
  const Vec3 from = a - point_, step = b - a;
  const double along = glm::dot(from, axis_), along_step = glm::dot(step, axis_);
  // The part with -margin <= along <= length + radius + margin.
  double first = 0.0, last = 1.0;
  const double low = -(margin + point_radius_), high = length_ + light_radius_ + margin;
  if (along_step == 0.0) {
    if (along < low || along > high) return false;
  } else {
    const double t0 = (low - along) / along_step, t1 = (high - along) / along_step;
    first = std::max(first, std::min(t0, t1)), last = std::min(last, std::max(t0, t1));
    if (first > last) return false;
  }
  const Vec3 lateral = from - along * axis_, lateral_step = step - along_step * axis_;
  const auto value = [&](double t) {
    return beside(glm::length(lateral + t * lateral_step), along + t * along_step);
  };
  double least = std::min(value(first), value(last));
  const double speed = glm::length(lateral_step);
  if (speed > 0.0) {
    const double start = glm::dot(lateral, lateral_step) / speed;
    const double off = glm::length(lateral - (start / speed) * lateral_step);
    const double slope = sine_ * along_step / speed;
    const double square = cosine_ * cosine_ - slope * slope;
    if (square > 0.0) {
      const double t = (slope * off / std::sqrt(square) - start) / speed;
      if (t > first && t < last) least = std::min(least, value(t));
    }
  }
  return least <= margin;
}

}  // namespace gnomon::hybrid
