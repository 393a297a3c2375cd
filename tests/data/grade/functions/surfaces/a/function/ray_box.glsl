// Axis by axis.
float ray_box(vec3 origin, vec3 direction, vec3 low, vec3 high) {
  float tmin = 0.0, tmax = 1e30;
  for (int axis = 0; axis < 3; axis++) {
    if (direction[axis] == 0.0) {
      if (origin[axis] < low[axis] || origin[axis] > high[axis]) return -1.0;
    } else {
      float t0 = (low[axis] - origin[axis]) / direction[axis];
      float t1 = (high[axis] - origin[axis]) / direction[axis];
      if (t0 > t1) { float s = t0; t0 = t1; t1 = s; }
      tmin = max(tmin, t0);
      tmax = min(tmax, t1);
    }
  }
  if (tmin > tmax) return -1.0;
  return tmin;
}
