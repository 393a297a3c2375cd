// A sphere, of which a point sees a cone of directions. It is sampled by solid angle (Shirley, Wang and Zimmerman 1996, "Monte
// Carlo Techniques for Direct Lighting Calculations", section 3), and evenly over the sphere from within.
#include "scene/scene.h"

namespace gnomon {

bool SphereLight::resize(double size) {
  radius = size;
  return true;
}

ShapeMeasures SphereLight::measures() {
  return {{"radius", ShapeMeasure::Kind::length, &radius}};
}

Vec3 SphereLight::half_extent() const {
  return Vec3(radius);
}

LightHull SphereLight::hull(const Light& light, const LitWorld&) const {
  const Vec3 up(0.0, 0.0, (1.0 + 0x1p-40) * radius);
  LightHull hull{square_around(light.position - up, Vec3(radius, 0.0, 0.0), Vec3(0.0, radius, 0.0)),
                 light.position, radius};
  for (std::size_t i = 0; i < 4; ++i) hull.corners.push_back(hull.corners[i] + 2.0 * up);
  return hull;
}

namespace {

Vec3 aim_within_sphere(const LightSampler& s, const Vec2& square) {
  const double z = 1.0 - 2.0 * square.x, angle = 2.0 * pi * square.y;
  const double across = std::sqrt(std::max(0.0, (1.0 - z) * (1.0 + z)));
  return s.center + s.radius * Vec3(across * std::cos(angle), across * std::sin(angle), z);
}

Vec3 aim_at_sphere(const LightSampler& s, const Vec2& square) {
  const ConeDirection to = cone_direction(s, square);
  const double off_axis = s.distance * to.spread * to.radius;
  const double depth = std::sqrt(std::max(0.0, (s.radius - off_axis) * (s.radius + off_axis)));
  return s.from + (s.distance * (1.0 - to.versine) - depth) * to.direction;
}

}  // namespace

void SphereLight::set_up(LightSampler& sampler, const Light& light) const {
  const Vec3 offset = light.position - sampler.from;
  sampler.distance = glm::length(offset), sampler.radius = radius;
  sampler.aim = aim_within_sphere;
  if (!(sampler.distance > radius)) return;
  sampler.aim = aim_at_sphere;
  sampler.axis = offset / sampler.distance;
  const double sine = radius / sampler.distance;
  sampler.cap = sine * sine / (1.0 + std::sqrt((1.0 - sine) * (1.0 + sine)));
  orthonormal_basis(sampler.axis, sampler.u, sampler.v);
}

ShaderArea SphereLight::shader_area(const LightFace&) const {
  return {Vec3(radius, 0.0, 0.0), Vec3(0.0)};
}

}  // namespace gnomon
