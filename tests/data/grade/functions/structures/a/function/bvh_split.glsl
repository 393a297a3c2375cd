vec3 triangle_corner(int triangle, int corner);

vec3 center_of(int i) {
  return (triangle_corner(i, 0) + triangle_corner(i, 1) + triangle_corner(i, 2)) / 3.0;
}

int bvh_split(int triangles) {
  vec3 lo = center_of(0), hi = center_of(0);
  for (int i = 1; i < triangles; i++) {
    lo = min(lo, center_of(i));
    hi = max(hi, center_of(i));
  }
  vec3 d = hi - lo;
  int axis = 0;
  if (d.y > d[axis]) axis = 1;
  if (d.z > d[axis]) axis = 2;
  float mid = (lo[axis] + hi[axis]) / 2.0;
  int left = 0;
  for (int i = 0; i < triangles; i++)
    if (d[axis] == 0.0 ? i < triangles / 2 : center_of(i)[axis] < mid) left |= 1 << i;
  return left;
}
