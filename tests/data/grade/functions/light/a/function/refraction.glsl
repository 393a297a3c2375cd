vec3 refraction(vec3 direction, vec3 normal, float n1, float n2) {
  float r = n1 / n2;
  float c = -dot(normal, direction);
  float k = 1.0 - r * r * (1.0 - c * c);
  if (k < 0.0) return vec3(0.0);
  return r * direction + (r * c - sqrt(k)) * normal;
}
