// A sun's disc: a cone of directions, sampled by solid angle (Shirley, Wang and Zimmerman 1996, "Monte Carlo Techniques for
// Direct Lighting Calculations", section 3).
#include "scene/light_map/light_view.h"

namespace gnomon {

double SunDisc::size() const {
  return angular_diameter * 180.0 / pi;
}

bool SunDisc::resize(double size) {
  angular_diameter = size * pi / 180.0;
  return true;
}

ShapeMeasures SunDisc::measures() {
  return {{"angular_diameter", ShapeMeasure::Kind::angle, &angular_diameter, nullptr,
           "angular_diameter_degrees"}};
}

Vec3 SunDisc::half_extent() const {
  const double angle = 0.5 * angular_diameter;
  return Vec3(2.0 * std::sin(0.5 * angle));  // the chord of the cone's half-angle
}

// It stands so far away that all the world sees it under nearly the same angle: parallax across the world is 2^-14 of a
// radian. The little that is missing is added to its radius.
LightHull SunDisc::hull(const Light& light, const LitWorld& world) const {
  constexpr double reaches_away = 0x1p16;
  const double distance = reaches_away * world.reach;
  const Vec3 center = world.middle - distance * light.direction;
  const double radius = distance * std::tan(0.5 * angular_diameter) + 4.0 * world.reach;
  return {square_around_disc(center, light.direction, radius), center, radius};
}

void SunDisc::set_up(LightSampler& sampler, const Light& light) const {
  sampler.axis = -light.direction;
  const double half_sine = std::sin(0.25 * angular_diameter);
  sampler.cap = 2.0 * half_sine * half_sine;
  orthonormal_basis(sampler.axis, sampler.u, sampler.v);
  sampler.aim = [](const LightSampler& s, const Vec2& square) { return cone_direction(s, square).direction; };
}

ShaderArea SunDisc::shader_area(const LightFace& face) const {
  const double radius = std::tan(0.5 * angular_diameter);
  return {radius * face.right, radius * face.up};
}

}  // namespace gnomon
