// What runs along the surface stays, what runs along the normal turns round.
vec3 reflection(vec3 direction, vec3 normal) {
  vec3 through = normal * dot(direction, normal);
  vec3 along = direction - through;
  return along - through;
}
