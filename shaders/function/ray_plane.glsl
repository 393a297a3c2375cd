// A function to fill in: where a ray meets a plane.
//
// The ray's points are origin + t * direction, with t >= 0; the direction may have any length but 0. The plane goes through `point`;
// its normal may have any length but 0, too. Returns the t at which the ray meets the plane, from whichever side, and -1.0 where it
// does not, as where it runs beside the plane or in it.

float ray_plane(vec3 origin, vec3 direction, vec3 point, vec3 normal) {
  // TODO 1: a point p is in the plane where dot(p - point, normal) = 0: put the ray's points in.
  // TODO 2: when is there no such t, and when is it behind the ray?
  return -1.0;
}
