// A function to fill in: how a tree of boxes parts its triangles.
//
// The program gives the corners of each triangle, whose numbers are 0 to triangles - 1 (two to six); corner is 0, 1 or 2.
vec3 triangle_corner(int triangle, int corner);

// A triangle's centre is the mean of its corners. The axis is the one along which the centres reach farthest; the triangles whose centre
// lies below the middle between the lowest and the highest centre go left. Where all centres are one place the first half of them goes
// left (triangles / 2). Returns the sum of 1 << number of those that go left: 5 for the triangles 0 and 2.
int bvh_split(int triangles) {
  // TODO 1: the lowest and the highest coordinates of the centres. Along which axis are they farthest apart?
  // TODO 2: where is the middle? Which centres lie below it?
  // TODO 3: what if all centres are one place?
  return 0;
}
