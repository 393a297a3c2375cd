// A reflection as a student writes it, with the usual mistakes: MISTAKE is the number of one, 0 of none. The grader reads this
// list (mistakes.cpp); each sentence goes on from "as if".
// mistake 1: the result pointed back to where the ray comes from (the sign is wrong)
// mistake 2: the 2 was left out
// mistake 3: the part along the normal was added, not taken away
// mistake 4: the normal had to point against the ray (the dot product's absolute value, or none from the back)
// mistake 5: the result had length 1 (it is normalized)
// mistake 6: the ray went on as it came
// mistake 7: the ray went back the way it came
// mistake 8: the ray left along the normal
// mistake 9: a ray from the back was not mirrored
// mistake 10: 2 (d.n) d was taken away in place of 2 (d.n) n
// mistake 11: the factor was 4, not 2
// mistake 12: the dot product was left out (twice the normal is taken away)
// mistake 13: the whole normal was added
// mistake 14: the normal was taken away once
// mistake 15: the direction was turned round, but not what is taken away
// mistake 16: the factor was a half, not 2
// mistake 17: the factor was 3, not 2
// mistake 18: direction and normal were exchanged
// mistake 19: the dot product was divided by the direction's length
// mistake 20: the direction itself was left out
// mistake 21: direction and normal were multiplied part by part, in place of the dot product
// mistake 22: the normal was not multiplied with (its dot product is taken away from each part)
// mistake 23: the normal had to point along the ray (the dot product's absolute value)
// mistake 24: the direction itself was left out, and the sign is wrong
vec3 reflection(vec3 direction, vec3 normal) {
  float d = dot(direction, normal);
  vec3 right = direction - 2.0 * d * normal;
#if MISTAKE == 1
  return -right;
#elif MISTAKE == 2
  return direction - d * normal;
#elif MISTAKE == 3
  return direction + 2.0 * d * normal;
#elif MISTAKE == 4
  return direction + 2.0 * abs(d) * normal;
#elif MISTAKE == 5
  return normalize(right);
#elif MISTAKE == 6
  return direction;
#elif MISTAKE == 7
  return -direction;
#elif MISTAKE == 8
  return normal;
#elif MISTAKE == 9
  return d > 0.0 ? direction : right;
#elif MISTAKE == 11
  return direction - 4.0 * d * normal;
#elif MISTAKE == 12
  return direction - 2.0 * normal;
#elif MISTAKE == 13
  return direction + normal;
#elif MISTAKE == 14
  return direction - normal;
#elif MISTAKE == 15
  return -direction - 2.0 * d * normal;
#elif MISTAKE == 16
  return direction - 0.5 * d * normal;
#elif MISTAKE == 17
  return direction - 3.0 * d * normal;
#elif MISTAKE == 18
  return normal - 2.0 * d * direction;
#elif MISTAKE == 19
  return direction - 2.0 * d / length(direction) * normal;
#elif MISTAKE == 20
  return -2.0 * d * normal;
#elif MISTAKE == 21
  return direction - 2.0 * direction * normal;
#elif MISTAKE == 22
  return direction - 2.0 * d;
#elif MISTAKE == 23
  return direction - 2.0 * abs(d) * normal;
#elif MISTAKE == 24
  return 2.0 * d * normal;
#elif MISTAKE == 10
  return direction - 2.0 * d * direction;
#endif
  return right;
}
