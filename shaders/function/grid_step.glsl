// A function to fill in: which cell of a grid a ray enters after this one, and where (Amanatides and Woo 1987).
//
// Cells count from (0, 0, 0), whose lowest corner is `low`; `size` is a cell's along each axis. The ray's points are
// origin + t * direction; the direction may have any length but 0, and is 0 along an axis that the ray does not move along. Returns
// the next cell, one step along one axis, and writes to `t` where on the ray it is entered. A ray never meets two walls at once here.

ivec3 grid_step(ivec3 cell, vec3 origin, vec3 direction, vec3 low, vec3 size, out float t) {
  // TODO 1: which wall of the cell does the ray leave by along x, and at which t? Mind the direction's sign, and a direction of 0.
  // TODO 2: the same of y and z. Which of the three comes first?
  // TODO 3: which cell is behind that wall?
  t = 0.0;
  return cell;
}
