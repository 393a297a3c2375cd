void shadow_ray(vec3 point, vec3 normal, vec4 light, float offset, out vec3 begin, out vec3 direction, out float end) {
  vec3 toLight;
  if (light.w == 0.0) toLight = light.xyz;
  else toLight = light.xyz - point;
  vec3 n = normal;
  if (dot(n, toLight) < 0.0) n = -n;
  begin = point + offset * n;
  if (light.w == 0.0) {
    direction = normalize(light.xyz);
    end = 1e30;
  } else {
    direction = normalize(light.xyz - begin);
    end = distance(light.xyz, begin);
  }
}
