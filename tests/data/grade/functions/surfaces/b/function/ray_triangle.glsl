// Moeller and Trumbore.
float ray_triangle(vec3 origin, vec3 direction, vec3 a, vec3 b, vec3 c) {
  vec3 e1 = b - a;
  vec3 e2 = c - a;
  vec3 pvec = cross(direction, e2);
  float det = dot(e1, pvec);
  if (abs(det) < 1e-8) return -1.0;
  float inv_det = 1.0 / det;
  vec3 tvec = origin - a;
  float u = dot(tvec, pvec) * inv_det;
  if (u < 0.0 || u > 1.0) return -1.0;
  vec3 qvec = cross(tvec, e1);
  float v = dot(direction, qvec) * inv_det;
  if (v < 0.0 || u + v > 1.0) return -1.0;
  float t = dot(e2, qvec) * inv_det;
  if (t < 0.0) return -1.0;
  return t;
}
