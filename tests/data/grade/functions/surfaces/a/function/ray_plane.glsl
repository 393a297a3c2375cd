float ray_plane(vec3 origin, vec3 direction, vec3 point, vec3 normal) {
  float slant = dot(direction, normal);
  if (slant == 0.0) return -1.0;
  float t = dot(point - origin, normal) / slant;
  return t < 0.0 ? -1.0 : t;
}
