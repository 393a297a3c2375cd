// Local shading, the same arithmetic as the rasterizer's GLSL (Blinn 1977). No pi factors: irradiance 1 on a
// surface facing the light with diffuse 1 gives radiance 1. Whether the light reaches the surface at all is
// light_cannot_reach's decision.
#pragma once

#include "scene/light.h"

namespace gnomon::raytrace {

/// normal: unit shading normal on the viewer's side; to_viewer: unit. The result does not include the shadow.
inline Vec3f blinn_phong(const LightAtPoint& light, const Vec3& normal, const Vec3& to_viewer,
                         const Vec3f& diffuse, const Material& material, bool specular) {
  const double n_dot_l = glm::dot(normal, light.to_light);
  if (!(n_dot_l > 0.0)) return Vec3f(0.0f);
  Vec3f radiance = diffuse * static_cast<float>(n_dot_l);
  if (specular) {
    const Vec3 half_way = light.to_light + to_viewer;
    const double length = glm::length(half_way);
    const double n_dot_h = length > 0.0 ? std::max(0.0, glm::dot(normal, half_way) / length) : 0.0;
    radiance +=
        material.specular * static_cast<float>(std::pow(n_dot_h, static_cast<double>(material.shininess)));
  }
  return radiance * light.irradiance;
}

}  // namespace gnomon::raytrace
