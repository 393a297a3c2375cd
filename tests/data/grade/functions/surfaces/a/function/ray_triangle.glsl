// First the plane, then on which side of each edge the place lies.
float ray_triangle(vec3 origin, vec3 direction, vec3 a, vec3 b, vec3 c) {
  vec3 n = cross(b - a, c - a);
  float slant = dot(n, direction);
  if (slant == 0.0) return -1.0;
  float t = dot(n, a - origin) / slant;
  if (t < 0.0) return -1.0;
  vec3 p = origin + t * direction;
  if (dot(n, cross(b - a, p - a)) < 0.0) return -1.0;
  if (dot(n, cross(c - b, p - b)) < 0.0) return -1.0;
  if (dot(n, cross(a - c, p - c)) < 0.0) return -1.0;
  return t;
}
