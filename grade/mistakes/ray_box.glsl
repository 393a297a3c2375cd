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
// mistake 21: the ray was in the box from the first of the three begins on
// mistake 22: the ray was in the box up to the last of the three ends
// mistake 23: the origin of the ray was left out of each slab's first end
// mistake 24: the origin of the ray was left out of each slab's second end
// mistake 25: a slab that the ray runs nearly along was as one that it runs along (what counts as 0 is too large)
// mistake 26: high was the size of the box, not its corner
// mistake 27: a ray that meets nothing was answered with a very large number
// mistake 28: a slab that the ray runs nearly along was never met (what counts as 0 is too large)
// mistake 29: the last slab alone said where the ray enters
// mistake 30: the last slab alone said where the ray leaves
// mistake 31: each slab's begin and end were exchanged
// mistake 32: the box had a slab of x alone
// mistake 33: a ray along a slab was held against its low face alone
// mistake 34: a ray along a slab was held against its high face alone
// mistake 35: t could be below 0 (behind the ray as from inside)
// mistake 36: the first slab alone decided
// mistake 37: the box had slabs of x and y alone, of which the second decided
// mistake 38: a box was met where the ray leaves it before it enters it (the test is turned round)
// mistake 39: the ray never left a slab (no test of where it ends)
float ray_box(vec3 origin, vec3 direction, vec3 low, vec3 high) {
  vec3 d = MISTAKE == 12 ? normalize(direction) : direction, o = MISTAKE == 13 ? vec3(0.0) : origin;
  float none = MISTAKE == 18 ? 0.0 : MISTAKE == 27 ? 1e30 : -1.0;
  if (MISTAKE == 26) high += low;
  float begin = -1e30, end = 1e30;
  if (MISTAKE == 5 || MISTAKE == 21) begin = 1e30;
  if (MISTAKE == 5 || MISTAKE == 22) end = -1e30;
  for (int i = 0; i < 3; ++i) {
    if (MISTAKE == 2 && i == 2 || MISTAKE == 3 && i == 1 || MISTAKE == 4 && i == 0 || (MISTAKE == 32 || MISTAKE == 36) && i > 0 || MISTAKE == 37 && i == 2) continue;
    float zero = MISTAKE == 25 || MISTAKE == 28 ? 0.03 : 0.0;
    if (abs(d[i]) <= zero && MISTAKE != 16) {
      if (MISTAKE == 15 || MISTAKE == 28) return none;
      if (MISTAKE != 14 && (o[i] < low[i] && MISTAKE != 34 || o[i] > high[i] && MISTAKE != 33)) return none;
      continue;
    }
    float first = (low[i] - o[i]) / d[i], second = (high[i] - o[i]) / d[i];
    if (MISTAKE == 16 && (isnan(first) || isnan(second))) return none;
    if (MISTAKE == 19) first = (low[i] - o[i]) * d[i], second = (high[i] - o[i]) * d[i];
    if (MISTAKE == 23) first = low[i] / d[i];
    if (MISTAKE == 24) second = high[i] / d[i];
    float near = MISTAKE == 1 ? first : min(first, second), far = MISTAKE == 1 ? second : max(first, second);
    if (MISTAKE == 31) {
      float least = near;
      near = far, far = least;
    }
    if (MISTAKE == 29 || MISTAKE == 37) begin = near;
    if (MISTAKE == 30 || MISTAKE == 37) end = far;
    begin = MISTAKE == 5 || MISTAKE == 21 ? min(begin, near) : max(begin, near);
    end = MISTAKE == 5 || MISTAKE == 22 ? max(end, far) : min(end, far);
  }
  if (MISTAKE == 29) return max(begin, 0.0) > end ? none : begin;
  if (MISTAKE == 39) return max(begin, 0.0);
  if (MISTAKE == 38) return max(begin, 0.0) < end ? none : max(begin, 0.0);
  if (begin > end && MISTAKE != 17) return none;
  if (MISTAKE == 35) return begin;
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
