// A lamp's way is subtracted by w, so that one line serves both lights.
void shadow_ray(vec3 point, vec3 normal, vec4 light, float offset, out vec3 begin, out vec3 direction, out float end) {
  begin = point + offset * faceforward(normal, light.w * point - light.xyz, normal);
  direction = light.xyz - light.w * begin;
  float size = length(direction);
  direction /= size;
  end = light.w > 0.5 ? size : 1.0 / 0.0;
}
