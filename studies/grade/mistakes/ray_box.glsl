// The slab test as a student writes it (Kay and Kajiya 1986), with the usual mistakes: MISTAKE is the number of one, 0 of none.
// The grader reads this list (mistakes.cpp); each sentence goes on from "as if".
// mistake 1: every direction were positive (the two t of a slab are not ordered)
// mistake 2: the box had no slab of z
// mistake 3: the box had no slab of y
// mistake 4: the box had no slab of x
// mistake 5: one slab was enough (the first begin and the last end are taken)
// mistake 6: a box behind the ray was met, at a negative t
// mistake 7: a box behind the ray was met, at 0
// mistake 8: a ray that begins inside met nothing
// mistake 9: a ray that begins inside met the box where it leaves it
// mistake 10: a ray that begins inside met the box behind its begin (t below 0)
// mistake 11: the answer was where the ray leaves the box
// mistake 12: t was a length (the direction is normalized first)
// mistake 13: the origin of the ray was left out
// mistake 14: a slab that the ray runs along was not there
// mistake 15: a slab that the ray runs along was never met
// mistake 16: a ray that runs in a face met nothing (0 / 0 is no number)
// mistake 17: the order of the slabs' ends did not matter (no test whether the ray is in all at once)
// mistake 18: a ray that misses was answered with 0
// mistake 19: t was multiplied by the direction, not divided
// mistake 20: the box' middle was the place
float ray_box(vec3 origin, vec3 direction, vec3 low, vec3 high) {
  vec3 d = MISTAKE == 12 ? normalize(direction) : direction, o = MISTAKE == 13 ? vec3(0.0) : origin;
  float none = MISTAKE == 18 ? 0.0 : -1.0;
  float begin = -1e30, end = 1e30;
  if (MISTAKE == 5) begin = 1e30, end = -1e30;
  for (int i = 0; i < 3; ++i) {
    if (MISTAKE == 2 && i == 2 || MISTAKE == 3 && i == 1 || MISTAKE == 4 && i == 0) continue;
    if (d[i] == 0.0 && MISTAKE != 16) {
      if (MISTAKE == 15) return none;
      if (MISTAKE != 14 && (o[i] < low[i] || o[i] > high[i])) return none;
      continue;
    }
    float first = (low[i] - o[i]) / d[i], second = (high[i] - o[i]) / d[i];
    if (MISTAKE == 16 && (isnan(first) || isnan(second))) return none;
    if (MISTAKE == 19) first = (low[i] - o[i]) * d[i], second = (high[i] - o[i]) * d[i];
    float near = MISTAKE == 1 ? first : min(first, second), far = MISTAKE == 1 ? second : max(first, second);
    begin = MISTAKE == 5 ? min(begin, near) : max(begin, near);
    end = MISTAKE == 5 ? max(end, far) : min(end, far);
  }
  if (begin > end && MISTAKE != 17) return none;
  if (MISTAKE == 6) return begin < 0.0 && end >= 0.0 ? 0.0 : begin;
  if (MISTAKE == 7) return max(begin, 0.0);
  if (end < 0.0) return none;
  if (MISTAKE == 8 && begin < 0.0) return none;
  if (MISTAKE == 9 && begin < 0.0) return end;
  if (MISTAKE == 10) return begin;
  if (MISTAKE == 11) return end;
  if (MISTAKE == 20) return max(0.5 * (begin + end), 0.0);
  return max(begin, 0.0);
}
