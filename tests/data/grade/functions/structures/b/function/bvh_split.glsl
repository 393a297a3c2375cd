vec3 triangle_corner(int triangle, int corner);

// Sums of corners, three times a centre: the division changes nothing.
int bvh_split(int triangles) {
  vec3 sums[6];
  vec3 low = vec3(1.0 / 0.0), high = -low;
  for (int i = 0; i < triangles; ++i) {
    sums[i] = vec3(0.0);
    for (int k = 0; k < 3; ++k) sums[i] += triangle_corner(i, k);
    low = min(low, sums[i]);
    high = max(high, sums[i]);
  }
  vec3 reach = high - low;
  vec3 along = reach.x >= reach.y && reach.x >= reach.z ? vec3(1.0, 0.0, 0.0) : reach.y >= reach.z ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
  int mask = 0, count = 0;
  for (int i = 0; i < triangles; ++i)
    if (2.0 * dot(sums[i], along) < dot(low + high, along)) mask += 1 << i, ++count;
  return count == 0 ? (1 << triangles / 2) - 1 : mask;
}
