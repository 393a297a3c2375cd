// A ray against a plane as a student writes it, with the usual mistakes: MISTAKE is the number of one, 0 of none. The grader reads
// this list (mistakes.cpp); each sentence goes on from "as if".
// mistake 1: t had the wrong sign
// mistake 2: the plane went through the origin of the world
// mistake 3: the ray began at the origin of the world
// mistake 4: a plane behind the ray was met, at a negative t
// mistake 5: a plane that is seen from the back was not there
// mistake 6: a plane that is seen from the front was not there
// mistake 7: t was a length (the direction is normalized first)
// mistake 8: the distance to the plane was t (it is not divided by the slant)
// mistake 9: the normal had length 1 above, but not below the line of the fraction
// mistake 10: a ray that is nearly parallel met nothing (what counts as 0 is too large)
// mistake 11: a parallel ray met the plane (no test for 0)
// mistake 12: t was its absolute value (what is behind the ray is before it)
// mistake 13: a ray that meets nothing was answered with 0
// mistake 14: t was multiplied by the slant, not divided
// mistake 15: the fraction was upside down
// mistake 16: the point and the origin were added, not subtracted
// mistake 17: the constant of the plane had the wrong sign (n.p is taken for -n.p)
// mistake 18: the distance between the two points was taken for that along the normal
// mistake 19: the normal had length 1 below, but not above the line of the fraction
// mistake 20: a ray that meets nothing was answered with a very large number
// mistake 21: a parallel ray met the plane at 0
// mistake 22: a plane behind the ray was met, at 0
// mistake 23: the distance was divided by the square of the normal, not by the slant
// mistake 24: a parallel ray met the plane (no test for 0, and what is no number is the answer)
// mistake 25: the test for a parallel ray was turned round
// mistake 26: direction and normal were exchanged above the line of the fraction
float ray_plane(vec3 origin, vec3 direction, vec3 point, vec3 normal) {
  vec3 d = MISTAKE == 7 ? normalize(direction) : direction;
  vec3 from = MISTAKE == 3 ? vec3(0.0) : origin, to = MISTAKE == 2 ? vec3(0.0) : point;
  float none = MISTAKE == 13 ? 0.0 : MISTAKE == 20 ? 1e30 : -1.0;
  float slant = dot(d, MISTAKE == 19 ? normalize(normal) : normal);
  if (MISTAKE == 21 && slant == 0.0) return 0.0;
  if (MISTAKE == 25 && slant != 0.0) return none;
  if (MISTAKE != 11 && MISTAKE != 24 && MISTAKE != 25 && abs(slant) <= (MISTAKE == 10 ? 0.01 : 0.0)) return none;
  if (MISTAKE == 5 && slant > 0.0 || MISTAKE == 6 && slant < 0.0) return none;
  if (MISTAKE == 16 || MISTAKE == 17) from = -from;
  float apart = dot(to - from, MISTAKE == 9 ? normalize(normal) : normal);
  if (MISTAKE == 18) apart = distance(to, from);
  float t = MISTAKE == 15 ? slant / apart : apart / slant;
  if (MISTAKE == 1 || MISTAKE == 17) t = -t;
  if (MISTAKE == 8) t = abs(apart) * sign(t);
  if (MISTAKE == 12) t = abs(t);
  if (MISTAKE == 14) t = apart * slant;
  if (MISTAKE == 22) return max(t, 0.0);
  if (MISTAKE == 23) t = apart / dot(normal, normal);
  if (MISTAKE == 24) return t < 0.0 ? none : t;
  if (MISTAKE == 26) t = dot(to - from, d) / slant;
  return t >= 0.0 || MISTAKE == 4 ? t : none;
}
