vec3 reflection(vec3 direction, vec3 normal) {
  return direction - 2.0 * dot(normal, direction) * normal;
}
