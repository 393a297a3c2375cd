vec3 triangle_corner(int triangle, int corner);

// Sums of a box's two ends, twice its middle: the order is the same. The least one that is left is taken, again and again.
int bvh_split(int triangles) {
  vec3 sums[6];
  vec3 low = vec3(1.0 / 0.0), high = -low;
  for (int i = 0; i < triangles; ++i) {
    vec3 from = vec3(1.0 / 0.0), to = -from;
    for (int k = 0; k < 3; ++k) from = min(from, triangle_corner(i, k)), to = max(to, triangle_corner(i, k));
    sums[i] = from + to;
    low = min(low, from);
    high = max(high, to);
  }
  vec3 reach = high - low;
  vec3 along = reach.x >= reach.y && reach.x >= reach.z ? vec3(1.0, 0.0, 0.0) : reach.y >= reach.z ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
  int mask = 0;
  for (int taken = 0; taken < triangles / 2; ++taken) {
    int least = -1;
    for (int i = 0; i < triangles; ++i)
      if ((mask & 1 << i) == 0 && (least < 0 || dot(sums[i], along) < dot(sums[least], along))) least = i;
    mask += 1 << least;
  }
  return mask;
}
