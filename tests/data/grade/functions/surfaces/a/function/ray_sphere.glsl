// The quadratic formula of school.
float ray_sphere(vec3 origin, vec3 direction, vec3 center, float radius) {
  vec3 oc = origin - center;
  float a = dot(direction, direction);
  float b = 2.0 * dot(oc, direction);
  float c = dot(oc, oc) - radius * radius;
  float disc = b * b - 4.0 * a * c;
  if (disc < 0.0) return -1.0;
  float t0 = (-b - sqrt(disc)) / (2.0 * a);
  float t1 = (-b + sqrt(disc)) / (2.0 * a);
  if (t0 >= 0.0) return t0;
  if (t1 >= 0.0) return t1;
  return -1.0;
}
