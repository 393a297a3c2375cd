// Axis by axis.
ivec3 grid_step(ivec3 cell, vec3 origin, vec3 direction, vec3 low, vec3 size, out float t) {
  float tMax[3];
  int stepBy[3];
  for (int a = 0; a < 3; a++) {
    if (direction[a] > 0.0) {
      stepBy[a] = 1;
      tMax[a] = (low[a] + float(cell[a] + 1) * size[a] - origin[a]) / direction[a];
    } else if (direction[a] < 0.0) {
      stepBy[a] = -1;
      tMax[a] = (low[a] + float(cell[a]) * size[a] - origin[a]) / direction[a];
    } else {
      stepBy[a] = 0;
      tMax[a] = 1e38;
    }
  }
  int axis;
  if (tMax[0] < tMax[1]) axis = tMax[0] < tMax[2] ? 0 : 2;
  else axis = tMax[1] < tMax[2] ? 1 : 2;
  t = tMax[axis];
  cell[axis] += stepBy[axis];
  return cell;
}
