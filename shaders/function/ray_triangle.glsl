// A function to fill in: where a ray meets a triangle.
//
// The ray's points are origin + t * direction, with t >= 0; the direction may have any length but 0. Returns the t at which the
// ray meets the triangle a b c, from whichever side, and -1.0 where it does not.

float ray_triangle(vec3 origin, vec3 direction, vec3 a, vec3 b, vec3 c) {
  // TODO 1: the triangle's points are a + u (b - a) + v (c - a). Which u, v and t give the same point on both? (Cramer's rule,
  //         or first the plane's t and then u and v in the plane.)
  // TODO 2: when is there no such point? A triangle may be small: what is small enough to be 0?
  // TODO 3: which u and v are inside the triangle, which t on the ray?
  return -1.0;
}
