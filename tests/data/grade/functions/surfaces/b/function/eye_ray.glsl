// In pixels: the picture stands as far away as makes its height fit the angle.
vec3 eye_ray(vec2 pixel, vec2 size, float degrees, vec3 right, vec3 up, vec3 forward) {
  float away = 0.5 * size.y / tan(0.5 * radians(degrees));
  vec2 from_middle = pixel + vec2(0.5) - 0.5 * size;
  vec3 to = away * forward + from_middle.x * right - from_middle.y * up;
  return to / length(to);
}
