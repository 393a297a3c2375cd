// A function to fill in: the direction in which a ray goes on inside another medium (Snell's law).
//
// `direction` and `normal` have length 1; the normal points to the side that the ray comes from. n1 is the refractive index of
// that side, n2 that of the other. Returns a direction of length 1, and vec3(0.0) where nothing passes (total reflection).

vec3 refraction(vec3 direction, vec3 normal, float n1, float n2) {
  // TODO 1: n1 sin(angle 1) = n2 sin(angle 2): what is the cosine of the second angle?
  // TODO 2: when is there none?
  // TODO 3: put the direction together of what runs along the surface and what runs along the normal. (GLSL's refract()
  //         is not there.)
  return direction;
}
