vec3 triangle_corner(int triangle, int corner);

vec3 center_of(int i) {
  vec3 a = triangle_corner(i, 0), b = triangle_corner(i, 1), c = triangle_corner(i, 2);
  return (min(a, min(b, c)) + max(a, max(b, c))) / 2.0;
}

int bvh_split(int triangles) {
  vec3 lo = triangle_corner(0, 0), hi = triangle_corner(0, 0);
  for (int i = 0; i < triangles; i++)
    for (int k = 0; k < 3; k++) {
      lo = min(lo, triangle_corner(i, k));
      hi = max(hi, triangle_corner(i, k));
    }
  vec3 d = hi - lo;
  int axis = 0;
  if (d.y > d[axis]) axis = 1;
  if (d.z > d[axis]) axis = 2;
  int left = 0;
  for (int i = 0; i < triangles; i++) {
    int before = 0;
    for (int k = 0; k < triangles; k++) {
      float here = center_of(i)[axis], there = center_of(k)[axis];
      if (there < here || (there == here && k < i)) before++;
    }
    if (before < triangles / 2) left |= 1 << i;
  }
  return left;
}
