// How a tree parts its triangles as a student writes it, with the usual mistakes: MISTAKE is the number of one, 0 of none. The grader
// reads this list (mistakes.cpp); each sentence goes on from "as if".
// mistake 1: the axis was always x
// mistake 2: the axis was always y
// mistake 3: the axis was always z
// mistake 4: the axis was the shortest
// mistake 5: the axis was that of the centres' box, not of the triangles'
// mistake 6: the axis was the one with the largest coordinate
// mistake 7: the axis was never x
// mistake 8: the axis was never y
// mistake 9: the axis was never z
// mistake 10: z was held against x alone
// mistake 11: the box around all triangles held the origin of the world
// mistake 12: the middle of the triangles' box parted them, not the middle triangle
// mistake 13: the middle of the centres' box parted them, not the middle triangle
// mistake 14: the mean of the centres parted them, not the middle triangle
// mistake 15: the origin of the world parted them
// mistake 16: left and right were exchanged
// mistake 17: of an odd number the larger half went left
// mistake 18: one triangle too few went left
// mistake 19: one triangle too many went left
// mistake 20: all triangles went left
// mistake 21: all triangles went right
// mistake 22: a triangle's first corner was its centre
// mistake 23: a triangle's second corner was its centre
// mistake 24: a triangle's third corner was its centre
// mistake 25: the centre was that of two corners
// mistake 26: the mean of a triangle's corners was its centre, not the middle of its box
// mistake 27: triangles were ordered by their lowest corners
// mistake 28: triangles were ordered by their highest corners
// mistake 29: the first half of the numbers always went left, whatever the centres
// mistake 30: equal centres all went left
// mistake 31: equal centres all went right
// mistake 32: of equal centres the higher number came first
// mistake 33: the last triangle was not there
// mistake 34: triangles were numbered from the last one
// mistake 35: the bits began at 2, not at 1
// mistake 36: the answer was how many triangles go left
// mistake 37: the answer was the numbers of the triangles, not their bits
vec3 triangle_corner(int triangle, int corner);

vec3 low_of(int i) { return min(triangle_corner(i, 0), min(triangle_corner(i, 1), triangle_corner(i, 2))); }
vec3 high_of(int i) { return max(triangle_corner(i, 0), max(triangle_corner(i, 1), triangle_corner(i, 2))); }

vec3 center_of(int i) {
  vec3 a = triangle_corner(i, 0), b = triangle_corner(i, 1), c = triangle_corner(i, 2);
  if (MISTAKE == 22) return a;
  if (MISTAKE == 23) return b;
  if (MISTAKE == 24) return c;
  if (MISTAKE == 25) return (a + b) / 2.0;
  if (MISTAKE == 26) return (a + b + c) / 3.0;
  if (MISTAKE == 27) return low_of(i);
  if (MISTAKE == 28) return high_of(i);
  return 0.5 * (low_of(i) + high_of(i));
}

int longest(vec3 low, vec3 high, vec3 center_low, vec3 center_high) {
  if (MISTAKE >= 1 && MISTAKE <= 3) return MISTAKE - 1;
  vec3 extent = MISTAKE == 5 ? center_high - center_low : MISTAKE == 6 ? high : high - low;
  if (MISTAKE == 7) extent.x = -1.0;
  if (MISTAKE == 8) extent.y = -1.0;
  if (MISTAKE == 9) extent.z = -1.0;
  int axis = extent.y > extent.x ? 1 : 0;
  if (MISTAKE == 4) {
    axis = extent.y < extent.x ? 1 : 0;
    return extent.z < extent[axis] ? 2 : axis;
  }
  if (MISTAKE == 10) return axis == 0 && extent.z > extent.x ? 2 : axis;
  return extent.z > extent[axis] ? 2 : axis;
}

int bvh_split(int triangles) {
  int count = MISTAKE == 33 ? triangles - 1 : triangles;
  vec3 low = vec3(MISTAKE == 11 ? 0.0 : 1e30), high = vec3(MISTAKE == 11 ? 0.0 : -1e30);
  vec3 center_low = vec3(1e30), center_high = vec3(-1e30), sum = vec3(0.0);
  for (int i = 0; i < count; ++i) {
    vec3 middle = center_of(i);
    low = min(low, low_of(i)), high = max(high, high_of(i));
    center_low = min(center_low, middle), center_high = max(center_high, middle), sum += middle;
  }
  int axis = longest(low, high, center_low, center_high), half_of = count / 2;
  if (MISTAKE == 17) half_of = (count + 1) / 2;
  if (MISTAKE == 18) --half_of;
  if (MISTAKE == 19) ++half_of;
  float middle = 0.5 * (low[axis] + high[axis]);
  if (MISTAKE == 13) middle = 0.5 * (center_low[axis] + center_high[axis]);
  if (MISTAKE == 14) middle = sum[axis] / float(count);
  if (MISTAKE == 15) middle = 0.0;
  bool by_place = MISTAKE == 12 || MISTAKE == 13 || MISTAKE == 14 || MISTAKE == 15;
  bool one_place = center_low[axis] == center_high[axis];
  int left = 0;
  for (int i = 0; i < count; ++i) {
    float place = center_of(i)[axis];
    int before = 0;
    for (int k = 0; k < count; ++k) {
      float other = center_of(k)[axis];
      bool first = MISTAKE == 32 ? k > i : MISTAKE == 31 && one_place ? true : MISTAKE == 30 && one_place ? false : k < i;
      if (other < place || (other == place && first)) ++before;
    }
    bool goes = by_place ? place < middle : MISTAKE == 16 ? before >= half_of : before < half_of;
    if (MISTAKE == 29) goes = i < half_of;
    if (MISTAKE == 20 || MISTAKE == 21) goes = MISTAKE == 20;
    if (!goes) continue;
    left += MISTAKE == 36 ? 1 : MISTAKE == 37 ? i : 1 << (MISTAKE == 34 ? triangles - 1 - i : MISTAKE == 35 ? i + 1 : i);
  }
  return left;
}
