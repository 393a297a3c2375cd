// A function to fill in: where a ray meets a sphere.
//
// The ray's points are origin + t * direction, with t >= 0; the direction may have any length but 0. Returns the least t at
// which the ray meets the sphere's surface, and -1.0 where it meets it nowhere. A ray may begin inside the sphere.

float ray_sphere(vec3 origin, vec3 direction, vec3 center, float radius) {
  // TODO 1: put the ray's points into |p - center|^2 = radius^2: that is a t^2 + 2 b t + c = 0. What are a, b and c?
  // TODO 2: when has it no solution?
  // TODO 3: of its two solutions, which one is the answer? Think of a sphere behind the ray, and of a ray that begins inside.
  return -1.0;
}
