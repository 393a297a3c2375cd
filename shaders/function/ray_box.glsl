// A function to fill in: where a ray meets a box along the axes (the slab test).
//
// The ray's points are origin + t * direction, with t >= 0; the direction may have any length but 0. Returns the least t at
// which the ray is in the box from low to high, whose faces belong to it. It is 0.0 if it begins inside, -1.0 if it never is.

float ray_box(vec3 origin, vec3 direction, vec3 low, vec3 high) {
  // TODO 1: between which two t is the ray in the slab from low.x to high.x? Mind the direction's sign, and a direction along
  //         the slab (0.0 / 0.0 is no number).
  // TODO 2: the same of y and z. When is the ray in all three at once?
  // TODO 3: which t is the answer where the box is behind the ray, and where the ray begins inside?
  return -1.0;
}
