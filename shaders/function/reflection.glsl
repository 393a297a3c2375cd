// A function to fill in: the direction in which a mirror sends a ray on.
//
// `direction` is that of the ray that arrives, of any length; `normal` has length 1, and may point to either side of the surface.
// Returns the mirrored direction, as long as the one that arrives.

vec3 reflection(vec3 direction, vec3 normal) {
  // TODO: which part of the direction turns round at the surface? (GLSL's reflect() is not there.)
  return direction;
}
