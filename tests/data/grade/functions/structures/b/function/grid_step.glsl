// All axes at once, in units of cells.
ivec3 grid_step(ivec3 cell, vec3 origin, vec3 direction, vec3 low, vec3 size, out float t) {
  vec3 up = step(vec3(0.0), direction);
  vec3 rest = vec3(cell) + up - (origin - low) / size;
  vec3 next = rest * size / direction;
  next = mix(next, vec3(1.0 / 0.0), equal(direction, vec3(0.0)));
  t = min(next.x, min(next.y, next.z));
  return cell + ivec3(equal(next, vec3(t))) * ivec3(sign(direction));
}
