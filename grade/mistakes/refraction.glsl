// Snell's law as a student writes it, with the usual mistakes: MISTAKE is the number of one, 0 of none. The grader reads this
// list (mistakes.cpp); each sentence goes on from "as if".
// mistake 1: the two indices were exchanged
// mistake 2: total reflection was not tested (the root of a negative number is no number)
// mistake 3: a ray that is totally reflected went on along the mirrored direction
// mistake 4: a ray that is totally reflected went straight on
// mistake 5: the normal pointed the other way
// mistake 6: the cosine had the wrong sign
// mistake 7: the ratio of the indices was not squared
// mistake 8: the cosine was left out of the part along the normal
// mistake 9: the root was left out
// mistake 10: the ray went straight on
// mistake 11: the ray was mirrored
// mistake 12: the direction was not shortened by the ratio of the indices
// mistake 13: the ratio of the indices was left out everywhere but under the root
// mistake 14: the total reflection's test let nothing pass that leaves the denser medium
// mistake 15: a negative number under the root was 0
// mistake 16: the cosine was not squared
// mistake 17: the cosine was taken for the sine under the root
// mistake 18: the refracted ray was the ratio times the ray, less the normal, made to length 1
// mistake 19: a ray that is totally reflected went along the normal
// mistake 20: the first medium was always air (n1 is left out)
// mistake 21: the second medium was always air (n2 is left out)
// mistake 22: a negative number under the root lost its sign (total reflection is not tested)
// mistake 23: the test of total reflection was turned round (with the root of what is left)
// mistake 24: the test of total reflection was turned round (the root of a negative number is no number)
// mistake 25: a ray that is totally reflected was answered with -1
// mistake 26: a ray that is totally reflected went against the normal
// mistake 27: the 1 - was left out under the root
// mistake 28: the ratio of the indices was left out of the cosine
// mistake 29: the ratio of the indices was left out, and the result made to length 1
// mistake 30: the two indices were exchanged under the root
// mistake 31: the two indices were exchanged everywhere but under the root
// mistake 32: the part along the normal was taken away, not added
// mistake 33: the ratio of the indices was always that of the smaller to the larger
vec3 refraction(vec3 direction, vec3 normal, float n1, float n2) {
  float eta = MISTAKE == 1 ? n2 / n1 : (MISTAKE == 20 ? 1.0 : n1) / (MISTAKE == 21 ? 1.0 : n2);
  if (MISTAKE == 33) eta = min(eta, 1.0 / eta);
  vec3 n = MISTAKE == 5 ? -normal : normal;
  float c = MISTAKE == 6 ? dot(direction, n) : -dot(direction, n);
  float rest = 1.0 - (MISTAKE == 7 ? eta : eta * eta) * (MISTAKE == 16 ? 1.0 - c : MISTAKE == 17 ? c * c : 1.0 - c * c);
  if (MISTAKE == 27) rest = eta * eta * (1.0 - c * c);
  if (MISTAKE == 30) rest = 1.0 - (1.0 - c * c) / (eta * eta);
  if (MISTAKE == 22) rest = abs(rest);
  if (MISTAKE == 23 || MISTAKE == 24) {
    if (rest > 0.0) return vec3(0.0);
    return eta * direction + (eta * c - sqrt(MISTAKE == 23 ? -rest : rest)) * n;
  }
  vec3 mirrored = direction - 2.0 * dot(direction, n) * n;
  if (MISTAKE == 10) return direction;
  if (MISTAKE == 11) return mirrored;
  if (MISTAKE == 14 && n1 > n2) return vec3(0.0);
  if (rest < 0.0 && MISTAKE == 25) return vec3(-1.0);
  if (rest < 0.0 && MISTAKE == 26) return -n;
  if (MISTAKE == 31) eta = 1.0 / eta;
  if (rest < 0.0 && MISTAKE != 2 && MISTAKE != 15)
    return MISTAKE == 3 ? mirrored : MISTAKE == 19 ? n : MISTAKE == 4 ? direction : vec3(0.0);
  float root = MISTAKE == 9 ? rest : sqrt(MISTAKE == 15 ? max(rest, 0.0) : rest);
  if (MISTAKE == 18) return normalize(eta * direction - n);
  if (MISTAKE == 28) return eta * direction + (c - root) * n;
  if (MISTAKE == 29) return normalize(direction + (c - root) * n);
  if (MISTAKE == 32) return eta * direction - (eta * c - root) * n;
  float along = MISTAKE == 8 ? -root : (MISTAKE == 13 ? c : eta * c) - root;
  return (MISTAKE == 12 || MISTAKE == 13 ? 1.0 : eta) * direction + along * n;
}
