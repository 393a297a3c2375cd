// The step to a grid's next cell as a student writes it, with the usual mistakes: MISTAKE is the number of one, 0 of none. The grader
// reads this list (mistakes.cpp); each sentence goes on from "as if".
// mistake 1: every step went up
// mistake 2: the ray left each cell by its lower wall
// mistake 3: the ray left each cell by its upper wall
// mistake 4: a wall that the ray runs along was met (the direction's 0 is divided by)
// mistake 5: the last of the three walls came first
// mistake 6: the grid began at the origin of the world (low is left out)
// mistake 7: cells were 1 wide
// mistake 8: cells were cubes (size.x serves all axes)
// mistake 9: t was a length (the direction is normalized first)
// mistake 10: the step was taken along all three axes at once
// mistake 11: the nearest wall was the first (the distance is not divided by the direction)
// mistake 12: the axis was always the one along which the direction is largest
// mistake 13: the axis was always x
// mistake 14: the ray began at the origin of the world
// mistake 15: the distance to the wall was multiplied by the direction, not divided
// mistake 16: every step went back
// mistake 17: there was no z
// mistake 18: t was where the ray leaves the next cell's opposite wall
// mistake 19: the grid's low corner was added twice
// mistake 20: t was counted from the cell's own wall, not from the ray's begin
// mistake 21: a wall that the ray runs along was met (the direction's 0 is divided by; the last of two such walls counts)
// mistake 22: a wall that the ray runs along was met (the direction's 0 is divided by, and the ray stays in its cell)
// mistake 23: walls stood in the cells' middles
// mistake 24: the farther of the walls of x and y was held against that of z
// mistake 25: the ray's origin was added, not taken away
// mistake 26: t was 0
// mistake 27: t was the way through a whole cell (its size by the direction)
// mistake 28: the step was two cells wide
// mistake 29: the ray stayed in its cell
// mistake 30: t had the wrong sign
// mistake 31: t was the whole of the next wall's place (the origin is left out)
// mistake 32: a ray that goes down left by the wall behind the next cell
// mistake 33: t was divided by the direction without its sign
// mistake 34: low was taken away, not added
// mistake 35: x and y were exchanged in the step
// mistake 36: z came first only where y's wall did not come before x's
// mistake 37: z came first only where x's wall did not come before y's
// mistake 38: t was a whole number
// mistake 39: the cells' size was divided by
// mistake 40: a wall that the ray runs along was met at 0
// mistake 41: the cell was not turned into a place (its size is left out of the wall)
// mistake 42: the distance to the wall was t (it is not divided by the direction)
// mistake 43: t was one cell's width too far on
ivec3 grid_step(ivec3 cell, vec3 origin, vec3 direction, vec3 low, vec3 size, out float t) {
  bool divides = MISTAKE == 4 || MISTAKE == 21 || MISTAKE == 22;
  vec3 d = MISTAKE == 9 ? normalize(direction) : direction, o = MISTAKE == 14 ? vec3(0.0) : origin;
  vec3 begin = MISTAKE == 6 ? vec3(0.0) : MISTAKE == 19 ? 2.0 * low : low;
  vec3 wide = MISTAKE == 7 ? vec3(1.0) : MISTAKE == 8 ? vec3(size.x) : size;
  vec3 next = vec3(1e30);
  for (int i = 0; i < 3; ++i) {
    if (MISTAKE == 40 && d[i] == 0.0) next[i] = 0.0;
    if (d[i] == 0.0 && !divides) continue;
    float upper = MISTAKE == 2 ? 0.0 : MISTAKE == 23 ? 0.5 : MISTAKE == 3 ? 1.0 : d[i] > 0.0 ? 1.0 : 0.0;
    if (MISTAKE == 18) upper += d[i] > 0.0 ? 1.0 : -1.0;
    if (MISTAKE == 32 && d[i] < 0.0) upper = -1.0;
    float wall = (MISTAKE == 34 ? -begin[i] : begin[i]) + (float(cell[i]) + upper) * (MISTAKE == 39 ? 1.0 / wide[i] : MISTAKE == 41 ? 1.0 : wide[i]);
    float way = MISTAKE == 20 ? sign(d[i]) * wide[i] : MISTAKE == 25 ? wall + o[i] : MISTAKE == 31 ? wall : wall - o[i];
    next[i] = MISTAKE == 11 ? abs(way) : MISTAKE == 15 ? way * d[i] : way / (MISTAKE == 33 ? abs(d[i]) : d[i]);
    if (MISTAKE == 42) next[i] = way * sign(d[i]);
    if (divides && d[i] == 0.0) next[i] = way > 0.0 ? 1e30 : -1e30;
  }
  bool last = MISTAKE == 21;
  int axis = next.y < next.x || last && next.y == next.x ? 1 : 0;
  if (MISTAKE == 24) axis = 1 - axis;
  bool asks_z = !(MISTAKE == 36 && axis == 1 || MISTAKE == 37 && axis == 0);
  if (asks_z && (next.z < next[axis] || last && next.z == next[axis]) && MISTAKE != 17) axis = 2;
  if (MISTAKE == 5) {
    axis = d.x != 0.0 ? 0 : d.y != 0.0 ? 1 : 2;
    for (int i = 0; i < 3; ++i)
      if (d[i] != 0.0 && next[i] > next[axis]) axis = i;
  }
  vec3 size_of = abs(d);
  if (MISTAKE == 12) axis = size_of.z > max(size_of.x, size_of.y) ? 2 : size_of.y > size_of.x ? 1 : 0;
  if (MISTAKE == 13) axis = 0;
  t = MISTAKE == 11 ? (begin[axis] + (float(cell[axis]) + (d[axis] > 0.0 ? 1.0 : 0.0)) * wide[axis] - o[axis]) / d[axis] : next[axis];
  if (MISTAKE == 43) t += abs(wide[axis] / d[axis]);
  if (MISTAKE == 38) t = float(int(t));
  if (MISTAKE == 26) t = 0.0;
  if (MISTAKE == 27) t = abs(wide[axis] / d[axis]);
  if (MISTAKE == 30) t = -t;
  ivec3 moved = cell;
  int by = int(sign(d[axis]));
  if (MISTAKE == 1) by = abs(by);
  if ((MISTAKE == 4 || MISTAKE == 21) && by == 0) by = -1;
  if (MISTAKE == 28) by *= 2;
  if (MISTAKE == 29) by = 0;
  if (MISTAKE == 35 && axis < 2) axis = 1 - axis;
  moved[axis] += MISTAKE == 16 ? -by : by;
  if (MISTAKE == 10) moved = cell + ivec3(sign(d));
  return moved;
}
