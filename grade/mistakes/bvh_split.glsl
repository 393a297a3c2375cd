// How a tree parts its triangles as a student writes it, with the usual mistakes: MISTAKE is the number of one, 0 of none. The grader
// reads this list (mistakes.cpp); each sentence goes on from "as if".
// mistake 1: the axis was always x
// mistake 2: the axis was the shortest
// mistake 3: the axis was that of the triangles' box, not of their centres
// mistake 4: the middle was that of the triangles' box, not of their centres
// mistake 5: the middle was the mean of the centres
// mistake 6: the middle was the median (as many go left as right)
// mistake 7: left and right were exchanged
// mistake 8: a triangle's first corner was its centre
// mistake 9: the middle of a triangle's box was its centre
// mistake 10: the middle was the origin of the world
// mistake 11: centres in one place all went right (one side is empty)
// mistake 12: centres in one place all went left (one side is empty)
// mistake 13: the middle was half the extent (the lowest centre is left out)
// mistake 14: the axis was the one with the largest coordinate
// mistake 15: triangles were numbered from the last one
// mistake 16: the last triangle was not there
// mistake 17: the first half of the triangles always went left
// mistake 18: a triangle went left only with all of its corners
// mistake 19: a triangle went left with any of its corners
// mistake 20: the axis was never z
// mistake 21: axis and middle were those of the triangles' box, not of their centres
// mistake 22: there was no z, not even for the lowest and the highest centre
// mistake 23: all triangles went left
// mistake 24: all triangles went right
// mistake 25: the answer was how many triangles go left
// mistake 26: the answer was the numbers of the triangles, not their bits
// mistake 27: a triangle's second corner was its centre
// mistake 28: a triangle's third corner was its centre
// mistake 29: the centre was that of two corners
// mistake 30: the middle was the sum of the lowest and the highest (the half is left out)
// mistake 31: the axis was always y
// mistake 32: the axis was always z
// mistake 33: the axis was never x
// mistake 34: the axis was never y
// mistake 35: centres in one place went left by turns
// mistake 36: the second half of centres in one place went left
// mistake 37: the box of the centres held the origin of the world
// mistake 38: the middle was a quarter of the way
// mistake 39: of an odd number of centres in one place the larger half went left
// mistake 40: of centres in one place the first alone went left
// mistake 41: the bits began at 2, not at 1
// mistake 42: z was held against x alone
vec3 triangle_corner(int triangle, int corner);

vec3 center_of(int i) {
  vec3 a = triangle_corner(i, 0), b = triangle_corner(i, 1), c = triangle_corner(i, 2);
  if (MISTAKE == 8) return a;
  if (MISTAKE == 27) return b;
  if (MISTAKE == 28) return c;
  if (MISTAKE == 29) return (a + b) / 2.0;
  if (MISTAKE == 9) return 0.5 * (min(a, min(b, c)) + max(a, max(b, c)));
  return (a + b + c) / 3.0;
}

int bvh_split(int triangles) {
  int count = MISTAKE == 16 ? triangles - 1 : triangles;
  vec3 low = vec3(MISTAKE == 37 ? 0.0 : 1e30), high = vec3(MISTAKE == 37 ? 0.0 : -1e30), box_low = low, box_high = high, sum = vec3(0.0);
  for (int i = 0; i < count; ++i) {
    vec3 a = triangle_corner(i, 0), b = triangle_corner(i, 1), c = triangle_corner(i, 2), middle = center_of(i);
    low = min(low, middle), high = max(high, middle), sum += middle;
    box_low = min(box_low, min(a, min(b, c))), box_high = max(box_high, max(a, max(b, c)));
  }
  vec3 extent = MISTAKE == 3 || MISTAKE == 21 ? box_high - box_low : MISTAKE == 14 ? high : high - low;
  if (MISTAKE == 20 || MISTAKE == 22) extent.z = MISTAKE == 22 ? 0.0 : -1.0;
  if (MISTAKE == 33) extent.x = -1.0;
  if (MISTAKE == 34) extent.y = -1.0;
  int axis = extent.y > extent.x ? 1 : 0;
  if (extent.z > extent[MISTAKE == 42 ? 0 : axis] && !(MISTAKE == 42 && axis == 1)) axis = 2;
  if (MISTAKE == 2) {
    axis = extent.y < extent.x ? 1 : 0;
    if (extent.z < extent[axis]) axis = 2;
  }
  if (MISTAKE == 1) axis = 0;
  if (MISTAKE == 31 || MISTAKE == 32) axis = MISTAKE - 30;
  float middle = 0.5 * (low[axis] + high[axis]);
  if (MISTAKE == 4 || MISTAKE == 21) middle = 0.5 * (box_low[axis] + box_high[axis]);
  if (MISTAKE == 5) middle = sum[axis] / float(triangles);
  if (MISTAKE == 10) middle = 0.0;
  if (MISTAKE == 30) middle *= 2.0;
  if (MISTAKE == 38) middle = 0.75 * low[axis] + 0.25 * high[axis];
  if (MISTAKE == 13) middle = 0.5 * (high[axis] - low[axis]);
  bool one_place = high[axis] == low[axis];
  int left = 0;
  for (int i = 0; i < count; ++i) {
    float place = center_of(i)[axis];
    vec3 at = vec3(triangle_corner(i, 0)[axis], triangle_corner(i, 1)[axis], triangle_corner(i, 2)[axis]);
    if (MISTAKE == 18) place = max(at.x, max(at.y, at.z));
    if (MISTAKE == 19) place = min(at.x, min(at.y, at.z));
    int lower = 0;
    for (int k = 0; k < count; ++k) lower += center_of(k)[axis] < place ? 1 : 0;
    bool goes = MISTAKE == 6 ? lower < triangles / 2 : MISTAKE == 7 ? place > middle : place < middle;
    if (one_place || MISTAKE == 17) goes = i < (MISTAKE == 39 ? (triangles + 1) / 2 : MISTAKE == 40 ? 1 : triangles / 2);
    if (one_place && (MISTAKE == 11 || MISTAKE == 12)) goes = MISTAKE == 12;
    if (one_place && MISTAKE == 35) goes = i % 2 == 0;
    if (one_place && MISTAKE == 36) goes = i >= triangles / 2;
    if (MISTAKE == 23 || MISTAKE == 24) goes = MISTAKE == 23;
    left += goes ? MISTAKE == 25 ? 1 : MISTAKE == 26 ? i : 1 << (MISTAKE == 15 ? triangles - 1 - i : MISTAKE == 41 ? i + 1 : i) : 0;
  }
  return left;
}
