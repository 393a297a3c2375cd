// With the plane as n.p + d = 0, the normal of length 1.
float ray_plane(vec3 origin, vec3 direction, vec3 point, vec3 normal) {
  vec3 n = normalize(normal);
  float d = -dot(n, point), height = dot(n, origin) + d, speed = -dot(n, direction);
  if (abs(speed) < 1e-7) return -1.0;
  float t = height / speed;
  if (t >= 0.0) return t;
  return -1.0;
}
