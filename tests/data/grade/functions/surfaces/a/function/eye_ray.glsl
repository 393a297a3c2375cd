vec3 eye_ray(vec2 pixel, vec2 size, float degrees, vec3 right, vec3 up, vec3 forward) {
  float t = tan(radians(degrees) / 2.0);
  float u = 2.0 * (pixel.x + 0.5) / size.x - 1.0;
  float v = 1.0 - 2.0 * (pixel.y + 0.5) / size.y;
  float aspect = size.x / size.y;
  return normalize(forward + u * t * aspect * right + v * t * up);
}
