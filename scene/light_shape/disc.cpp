// A disc, sampled by area (Shirley, Wang and Zimmerman 1996, "Monte Carlo Techniques for Direct Lighting Calculations",
// section 4).
#include "scene/scene.h"

namespace gnomon {

bool DiscLight::resize(double size) {
  radius = size;
  return true;
}

ShapeMeasures DiscLight::measures() {
  return {{"radius", ShapeMeasure::Kind::length, &radius},
          {"normal", ShapeMeasure::Kind::normal, nullptr, &normal}};
}

Vec3 DiscLight::half_extent() const {
  return radius * glm::sqrt(glm::max(Vec3(0.0), 1.0 - normal * normal));
}

LightHull DiscLight::hull(const Light& light, const LitWorld&) const {
  return {square_around_disc(light.position, normal, radius), light.position, radius};
}

void DiscLight::set_up(LightSampler& sampler, const Light&) const {
  orthonormal_basis(normal, sampler.u, sampler.v);
  sampler.u *= radius, sampler.v *= radius;
  sampler.aim = [](const LightSampler& s, const Vec2& square) {
    const Vec2 p = concentric_disc(square);
    return s.center + p.x * s.u + p.y * s.v;
  };
}

ShaderArea DiscLight::shader_area(const LightFace&) const {
  const Vec3 least =
      std::abs(normal.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);  // an axis that it is not along
  const Vec3 u = glm::normalize(glm::cross(normal, least));
  return {radius * u, radius * glm::cross(normal, u)};
}

}  // namespace gnomon
