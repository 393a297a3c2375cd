// Fresnel's equations as a student writes them, with the usual mistakes: MISTAKE is the number of one, 0 of none. The grader reads
// this list (mistakes.cpp); each sentence goes on from "as if".
// mistake 1: Schlick's approximation were the answer
// mistake 2: the two indices were exchanged
// mistake 3: the amplitudes were the shares (they are not squared)
// mistake 4: the first polarisation (across) was all of the light
// mistake 5: the second polarisation (along) was all of the light
// mistake 6: the shares of both polarisations were added (the half is left out)
// mistake 7: the answer was what passes
// mistake 8: total reflection reflected nothing
// mistake 9: total reflection was not tested (the root of a negative number is no number)
// mistake 10: the cosine on the other side was that on this side
// mistake 11: the product of both polarisations was their mean
// mistake 12: the angle had no influence (the share of a ray that arrives straight)
// mistake 13: a negative number under the root was 0
// mistake 14: the mean was taken before squaring
// mistake 15: the cosine was not squared where the sine is found
// mistake 16: the root was left out of the second cosine
// mistake 17: the indices were exchanged above the line of the first polarisation
// mistake 18: the indices were exchanged below the line of the first polarisation
// mistake 19: the indices were exchanged above the line of the second polarisation
// mistake 20: the indices were exchanged below the line of the second polarisation
// mistake 21: Schlick's approximation were the answer, its first share not squared
// mistake 22: Schlick's approximation were the answer, with the cosine in the thinner medium
// mistake 23: total reflection was answered with -1
// mistake 24: the larger share was that of all light
// mistake 25: the two polarisations were multiplied
// mistake 26: the mean of the amplitudes was squared, not their squares averaged
// mistake 27: the half was taken twice
// mistake 28: the indices were exchanged in Snell's law
// mistake 29: the root was left out of the first sine
// mistake 30: a negative number under the root lost its sign (total reflection is not tested)
// mistake 31: the test of total reflection was turned round
// mistake 32: Schlick's approximation were the answer, with another power
// mistake 33: total reflection reflected half of the light
// mistake 34: the ratio was not squared in Snell's law
// mistake 35: the second amplitude came in once, the first twice
// mistake 36: n2 alone stood in the second polarisation
// mistake 37: the amplitudes were added (they are not squared, and may cancel)
// mistake 38: the root of the mean was the answer
float fresnel(float cosine, float n1, float n2) {
  if (MISTAKE == 2) { float n = n1; n1 = n2; n2 = n; }
  float c1 = MISTAKE == 12 ? 1.0 : cosine, eta = n1 / n2;
#if MISTAKE == 1 || MISTAKE == 32
  float r0 = (n1 - n2) / (n1 + n2);
  r0 *= r0;
  return r0 + (1.0 - r0) * pow(1.0 - c1, MISTAKE == 32 ? 4.0 : 5.0);
#endif
  float rest = 1.0 - eta * eta * (MISTAKE == 15 ? 1.0 - c1 : 1.0 - c1 * c1);
#if MISTAKE == 21 || MISTAKE == 22
  float first = (n1 - n2) / (n1 + n2), c = MISTAKE == 22 && n1 > n2 ? sqrt(max(rest, 0.0)) : c1;
  if (rest < 0.0) return 1.0;
  if (MISTAKE == 22) first *= first;
  return first + (1.0 - first) * pow(1.0 - c, 5.0);
#endif
  if (MISTAKE == 28) rest = 1.0 - (1.0 - c1 * c1) / (eta * eta);
  if (MISTAKE == 29) rest = 1.0 - eta * eta * (1.0 - c1 * c1) * (1.0 - c1 * c1);
  if (MISTAKE == 34) rest = 1.0 - eta * (1.0 - c1 * c1);
  if (MISTAKE == 30) rest = abs(rest);
  if (MISTAKE == 31) {
    if (rest > 0.0) return 1.0;
    rest = -rest;
  }
  if (MISTAKE == 33 && rest < 0.0) return 0.5;
  if (MISTAKE == 13) rest = max(rest, 0.0);
  if (rest < 0.0 && MISTAKE != 9) return MISTAKE == 8 ? 0.0 : MISTAKE == 23 ? -1.0 : 1.0;
  float c2 = MISTAKE == 10 ? c1 : MISTAKE == 16 ? rest : sqrt(rest);
  float across = n1 * c1 - n2 * c2, below_across = n1 * c1 + n2 * c2, along = n2 * c1 - n1 * c2, below_along = n2 * c1 + n1 * c2;
  if (MISTAKE == 17) across = along;
  if (MISTAKE == 18) below_across = below_along;
  if (MISTAKE == 19) along = n1 * c1 - n2 * c2;
  if (MISTAKE == 20) below_along = n1 * c1 + n2 * c2;
  if (MISTAKE == 36) along = n2 * c1 - n2 * c2, below_along = n2 * c1 + n2 * c2;
  float a = across / below_across, b = along / below_along;
  if (MISTAKE == 3) return 0.5 * (abs(a) + abs(b));
  if (MISTAKE == 4) return a * a;
  if (MISTAKE == 5) return b * b;
  if (MISTAKE == 6) return a * a + b * b;
  if (MISTAKE == 7) return 1.0 - 0.5 * (a * a + b * b);
  if (MISTAKE == 26) return 0.25 * (abs(a) + abs(b)) * (abs(a) + abs(b));
  if (MISTAKE == 38) return sqrt(0.5 * (a * a + b * b));
  if (MISTAKE == 27) return 0.25 * (a * a + b * b);
  if (MISTAKE == 35) return 0.5 * (a * a + a * b);
  if (MISTAKE == 37) return 0.5 * (a + b);
  if (MISTAKE == 24) return max(a * a, b * b);
  if (MISTAKE == 25) return a * a * b * b;
  if (MISTAKE == 11) return abs(a * b);
  if (MISTAKE == 14) return 0.25 * (a + b) * (a + b);
  return 0.5 * (a * a + b * b);
}
