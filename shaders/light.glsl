// What a light is to a point: direction and irradiance. Twin of scene/light.h. Permutations DIRECTIONAL, SPOT, or
// neither for a point light.

#include "light_map.glsl"

struct LightAtPoint {
  vec3 to_light;    // unit
  vec3 irradiance;  // on a surface that faces the light; zero outside a spot's cone
};

LightAtPoint light_at(vec3 position) {
#ifdef DIRECTIONAL
  return LightAtPoint(light.direction_and_cos_outer.xyz * -1.0, light.intensity_and_cone.rgb);
#else
  vec3 offset = light.origin_and_size.xyz - position;
  float squared = dot(offset, offset);
  vec3 to_light = offset * inversesqrt(squared);
  float strength = 1.0 / squared;
#ifdef SPOT
  float cos_angle = -dot(light.direction_and_cos_outer.xyz, to_light);
  float ramp = clamp((cos_angle - light.direction_and_cos_outer.w) * light.intensity_and_cone.w, 0.0, 1.0);
  strength *= ramp * ramp;
#endif
  return LightAtPoint(to_light, light.intensity_and_cone.rgb * strength);
#endif
}
