// By angles: the sine along the surface, the cosine against the normal.
vec3 refraction(vec3 direction, vec3 normal, float n1, float n2) {
  vec3 along = direction - dot(direction, normal) * normal;
  float sine = length(along);
  if (sine < 1e-6) return direction;
  float sine2 = sine * n1 / n2;
  if (sine2 > 1.0) return vec3(0.0);
  return sine2 * along / sine - cos(asin(sine2)) * normal;
}
