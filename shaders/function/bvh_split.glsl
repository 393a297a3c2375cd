// A function to fill in: how a tree of boxes parts its triangles.
//
// The program gives the corners of each triangle, whose numbers are 0 to triangles - 1 (two to six); corner is 0, 1 or 2.
vec3 triangle_corner(int triangle, int corner);

// A triangle's centre is the middle of its own box. The axis is the one along which the box around all triangles is longest. In the order
// of their centres along it the first half of the triangles goes left (triangles / 2); of equal centres the lower number comes first.
// Returns the sum of 1 << number of those that go left: 5 for the triangles 0 and 2.
int bvh_split(int triangles) {
  // TODO 1: the box around all triangles. Along which axis is it longest?
  // TODO 2: where along that axis is the middle of each triangle's own box?
  // TODO 3: how many triangles come before this one? Does it belong to the first half?
  return 0;
}
