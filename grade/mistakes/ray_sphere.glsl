// A ray against a sphere as a student writes it, with the usual mistakes: MISTAKE is the number of one, 0 of none. The grader
// reads this list (mistakes.cpp); each sentence goes on from "as if".
// mistake 1: the direction had length 1 whatever it is (a is left out)
// mistake 2: t was a length (the direction is normalized first)
// mistake 3: the sphere was around the origin of the world
// mistake 4: the farther of the two places was the first
// mistake 5: the nearer place was the answer even behind the ray's begin
// mistake 6: a ray that begins inside met nothing
// mistake 7: t was its absolute value (what is behind the ray is before it)
// mistake 8: the radius was not squared
// mistake 9: b had the wrong sign
// mistake 10: the discriminant was b b - 4 a c where b is half of the usual one
// mistake 11: the root was left out
// mistake 12: the discriminant's sign did not matter (its absolute value has a root, too)
// mistake 13: the division by a was by 2 a
// mistake 14: the ray went on behind its begin, and only the farther place had to be before it
// mistake 15: a ray that touches had to pass well inside (0.1 in place of 0)
// mistake 16: the place of least distance to the center was the answer
// mistake 17: the discriminant was not tested (the root of a negative number is no number)
// mistake 18: a ray that meets nothing was answered with 0
// mistake 19: the sphere had no radius (it is left out)
// mistake 20: the radius was the diameter, or twice the radius
// mistake 21: the square of the radius was added, not taken away
// mistake 22: the division was by a where b has its 2 (t is twice as long)
// mistake 23: the discriminant was b b - a c where b has its 2 (the 4 is left out)
// mistake 24: the discriminant was b b + 4 a c
// mistake 25: only the 2 of 2 a was divided by (brackets are left out, a is multiplied by)
// mistake 26: only the root was divided, not b (brackets are left out)
// mistake 27: t was -t (the answer has the wrong sign)
// mistake 28: the distance to the center was not squared
// mistake 29: a hit was none within 0.01 of the ray's begin (what counts as 0 is too large)
// mistake 30: a ray that meets nothing was answered with a very large number
// mistake 31: only the root was divided by 2 a, not b (brackets are left out)
// mistake 32: the radius was half as large
// mistake 33: a sphere whose center is behind the ray's begin was not there
// mistake 34: the way to the place nearest to the center was not squared
// mistake 35: a ray that begins inside met the sphere at 0
// mistake 36: what is behind the ray's begin was at 0
// mistake 37: a ray that touches had to pass well inside (0.25 in place of 0)
// mistake 38: a was left out of the discriminant
// mistake 39: the division by a was left out
// mistake 40: b lacked its 2 where 4 a c and 2 a are those of the whole formula
// mistake 41: a hit was none within 0.1 of the ray's begin (what counts as 0 is too large)
// mistake 42: a hit was none within 0.001 of the ray's begin (what counts as 0 is too large)
// mistake 43: the test of the discriminant was turned round
// mistake 44: the nearer of the two places was taken by its absolute value
// mistake 45: the nearer place was half as far
// mistake 46: the center's distance from the origin of the world was taken for that from the ray's begin
// mistake 47: the radius was cubed, not squared
// mistake 48: t was -t at the nearer place (the answer has the wrong sign)
// mistake 49: a ray that passes the sphere was answered with a very large number
float ray_sphere(vec3 origin, vec3 direction, vec3 center, float radius) {
  vec3 o = origin - center, d = direction;
#if MISTAKE == 2
  d = normalize(d);
#elif MISTAKE == 3
  o = origin;
#endif
  float none = MISTAKE == 18 ? 0.0 : MISTAKE == 30 ? 1e30 : -1.0;
  if (MISTAKE == 20) radius *= 2.0;
  if (MISTAKE == 32) radius *= 0.5;
  float a = MISTAKE == 1 ? 1.0 : dot(d, d);
  float b = MISTAKE == 9 ? -dot(o, d) : dot(o, d);
  float c = (MISTAKE == 28 ? length(o) : MISTAKE == 46 ? dot(center, center) : dot(o, o)) - (MISTAKE == 8 ? radius : MISTAKE == 19 ? 0.0 : (MISTAKE == 21 ? -radius : MISTAKE == 47 ? radius * radius : radius) * radius);
  float discriminant = b * b - (MISTAKE == 10 ? 4.0 : MISTAKE == 23 ? 0.25 : MISTAKE == 24 ? -1.0 : 1.0) * a * c;
#if MISTAKE == 12
  discriminant = abs(discriminant);
#endif
  if (MISTAKE == 38) discriminant = b * b - c;
  if (MISTAKE == 40) discriminant = b * b - 4.0 * a * c;
  if (MISTAKE == 43 && discriminant > 0.0) return none;
  if (MISTAKE == 49 && discriminant < 0.0) return 1e30;
  if (MISTAKE == 33 && b > 0.0) return none;
  if (MISTAKE == 34) discriminant = -b * sqrt(a) - a * c;
  if (MISTAKE != 17 && discriminant < (MISTAKE == 15 ? 0.1 : MISTAKE == 37 ? 0.25 : 0.0) && MISTAKE != 43) return none;
  float root = MISTAKE == 11 ? discriminant : sqrt(discriminant);
  if (MISTAKE == 13 || MISTAKE == 40) a *= 2.0;
  if (MISTAKE == 39) a = 1.0;
  if (MISTAKE == 22) a *= 0.5;
  if (MISTAKE == 25) a = 1.0 / a;
  float near = (-b - root) / a, far = (-b + root) / a, least = MISTAKE == 29 ? 0.01 : MISTAKE == 41 ? 0.1 : MISTAKE == 42 ? 0.001 : 0.0;
  if (MISTAKE == 26) near = -b - root / a, far = -b + root / a;
  if (MISTAKE == 31) near = -2.0 * b - root / a, far = -2.0 * b + root / a;
  if (MISTAKE == 45) near *= 0.5;
#if MISTAKE == 4
  return far >= 0.0 ? far : none;
#elif MISTAKE == 5
  return near;
#elif MISTAKE == 6
  return near >= 0.0 ? near : none;
#elif MISTAKE == 7
  return min(abs(near), abs(far));
#elif MISTAKE == 35
  return near >= 0.0 ? near : far >= 0.0 ? 0.0 : none;
#elif MISTAKE == 36
  return max(near, 0.0);
#elif MISTAKE == 44
  return abs(near);
#elif MISTAKE == 14
  return far >= 0.0 ? near : none;
#elif MISTAKE == 16
  return -b / a >= 0.0 ? -b / a : none;
#endif
  float sign = MISTAKE == 27 ? -1.0 : 1.0;
  if (MISTAKE == 48 && near >= least) return -near;
  if (near >= least) return sign * near;
  return far >= least || MISTAKE == 17 && isnan(far) ? sign * far : none;
}
