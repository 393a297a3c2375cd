#include "scene/light.h"

namespace gnomon {

double spot_ramp(const Light& light) {
  return std::max(1e-9, std::cos(light.inner_angle) - std::cos(light.outer_angle));
}

double spot_falloff(const Light& light, const Vec3& to_light) {
  if (light.type != LightType::spot) return 1.0;
  const double cos_outer = std::cos(light.outer_angle);
  const double cos_angle = -glm::dot(light.direction, to_light);
  const double ramp = (cos_angle - cos_outer) / spot_ramp(light);
  const double clamped = std::clamp(ramp, 0.0, 1.0);
  return clamped * clamped;
}

LightAtPoint light_at(const Light& light, const Vec3& position) {
  if (light.type == LightType::directional) return {-light.direction, infinity, light.intensity};
  const Vec3 offset = light.position - position;
  const double distance = glm::length(offset);
  const Vec3 to_light = offset / distance;
  const double strength = spot_falloff(light, to_light) / (distance * distance);
  return {to_light, distance, light.intensity * static_cast<float>(strength)};
}

bool light_cannot_reach(const Light& light, const Vec3& position, const Vec3& normal) {
  const Vec3 to_light = light.type == LightType::directional ? -light.direction : light.position - position;
  if (!(glm::dot(normal, to_light) > 0.0)) return true;
  return light.type == LightType::spot && !(spot_falloff(light, glm::normalize(to_light)) > 0.0);
}

}  // namespace gnomon
