#include "hybrid/light_hull.h"

namespace gnomon::hybrid {
namespace {

/// A sun stands this many reaches away: parallax across the world is then 2^-14 of a radian.
constexpr double sun_distance = 0x1p16;

/// The corners of a square of directions u and v, widened against the rounding of samples on its rim.
std::vector<Vec3> square(const Vec3& center, const Vec3& u, const Vec3& v) {
  constexpr double wider = 1.0 + 0x1p-40;
  const Vec3 a = wider * u, b = wider * v;
  return {center - a - b, center + a - b, center + a + b, center - a + b};
}

std::vector<Vec3> cube(const Vec3& center, double radius) {
  const Vec3 up(0.0, 0.0, (1.0 + 0x1p-40) * radius);
  std::vector<Vec3> corners = square(center - up, Vec3(radius, 0.0, 0.0), Vec3(0.0, radius, 0.0));
  for (std::size_t i = 0; i < 4; ++i) corners.push_back(corners[i] + 2.0 * up);
  return corners;
}

std::vector<Vec3> disc_square(const Vec3& center, const Vec3& normal, double radius) {
  Vec3 u, v;
  orthonormal_basis(normal, u, v);
  return square(center, radius * u, radius * v);
}

}  // namespace

LightHull light_hull(const Light& light, const World& world, double reach) {
  LightHull hull;
  hull.center = light.position;
  if (const auto* sphere = std::get_if<SphereLight>(&light.extent)) {
    hull.corners = cube(hull.center, sphere->radius);
    hull.radius = sphere->radius;
  } else if (const auto* disc = std::get_if<DiscLight>(&light.extent)) {
    hull.corners = disc_square(hull.center, disc->normal, disc->radius);
    hull.radius = disc->radius;
  } else if (const auto* rectangle = std::get_if<RectangleLight>(&light.extent)) {
    hull.corners = square(hull.center, rectangle->half_width, rectangle->half_height);
    hull.radius = glm::length(rectangle->half_width + rectangle->half_height);
  } else if (const auto* sun = std::get_if<SunDisc>(&light.extent)) {
    const double distance = sun_distance * reach;
    const Vec3 middle = world.finite_bounds.empty() ? Vec3(0.0) : world.finite_bounds.center();
    hull.center = middle - distance * light.direction;
    hull.radius = distance * std::tan(0.5 * sun->angular_diameter) + 4.0 * reach;
    hull.corners = disc_square(hull.center, light.direction, hull.radius);
  }
  hull.radius *= 1.0 + 0x1p-40;
  return hull;
}

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
