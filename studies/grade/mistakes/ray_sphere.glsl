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
float ray_sphere(vec3 origin, vec3 direction, vec3 center, float radius) {
  vec3 o = origin - center, d = direction;
#if MISTAKE == 2
  d = normalize(d);
#elif MISTAKE == 3
  o = origin;
#endif
  float none = MISTAKE == 18 ? 0.0 : -1.0;
  float a = MISTAKE == 1 ? 1.0 : dot(d, d);
  float b = MISTAKE == 9 ? -dot(o, d) : dot(o, d);
  float c = dot(o, o) - (MISTAKE == 8 ? radius : radius * radius);
  float discriminant = b * b - (MISTAKE == 10 ? 4.0 : 1.0) * a * c;
#if MISTAKE == 12
  discriminant = abs(discriminant);
#endif
  if (MISTAKE != 17 && discriminant < (MISTAKE == 15 ? 0.1 : 0.0)) return none;
  float root = MISTAKE == 11 ? discriminant : sqrt(discriminant);
  if (MISTAKE == 13) a *= 2.0;
  float near = (-b - root) / a, far = (-b + root) / a;
#if MISTAKE == 4
  return far >= 0.0 ? far : none;
#elif MISTAKE == 5
  return near;
#elif MISTAKE == 6
  return near >= 0.0 ? near : none;
#elif MISTAKE == 7
  return min(abs(near), abs(far));
#elif MISTAKE == 14
  return far >= 0.0 ? near : none;
#elif MISTAKE == 16
  return -b / a >= 0.0 ? -b / a : none;
#endif
  if (near >= 0.0) return near;
  return far >= 0.0 || MISTAKE == 17 && isnan(far) ? far : none;
}
