// All three slabs at once.
float ray_box(vec3 origin, vec3 direction, vec3 low, vec3 high) {
  bvec3 along = equal(direction, vec3(0.0));
  vec3 inside = step(low, origin) * step(origin, high);
  if (dot(vec3(along), 1.0 - inside) > 0.0) return -1.0;
  vec3 inverse = 1.0 / mix(direction, vec3(1.0), along);
  vec3 one = (low - origin) * inverse, other = (high - origin) * inverse;
  vec3 near = mix(min(one, other), vec3(-1e30), along), far = mix(max(one, other), vec3(1e30), along);
  float enter = max(near.x, max(near.y, near.z)), leave = min(far.x, min(far.y, far.z));
  if (leave < enter || leave < 0.0) return -1.0;
  return max(enter, 0.0);
}
