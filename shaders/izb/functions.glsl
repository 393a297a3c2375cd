// The functions of expressions in double precision, each of a value (w) and its gradient (xyz): GLSL has no sine,
// exponential or logarithm of doubles. After Moshier's Cephes library, within two units in the last place.

double d_whole_power(double a, int n) {  // n from 0 to 64, a constant wherever it is called: see f_power in bounds.glsl
  double a2 = a * a, a4 = a2 * a2, a8 = a4 * a4, a16 = a8 * a8, a32 = a16 * a16;
  double result = (n & 1) != 0 ? a : 1.0LF;
  if ((n & 2) != 0) result *= a2;
  if ((n & 4) != 0) result *= a4;
  if ((n & 8) != 0) result *= a8;
  if ((n & 16) != 0) result *= a16;
  if ((n & 32) != 0) result *= a32;
  if ((n & 64) != 0) result *= a32 * a32;
  return result;
}

// Sine and cosine.
dvec2 d_wave(double x) {
  double n = floor(x * 0.63661977236758134308LF + 0.5LF);
  double r = ((x - n * 1.57079625129699707031LF) - n * 7.54978941586159635335e-8LF) - n * 5.39030285815811905290e-15LF;
  double z = r * r;
  double s = r + r * z * (-1.66666666666666307295e-1LF + z * (8.33333333332211858878e-3LF + z * (-1.98412698295895385996e-4LF +
                 z * (2.75573136213857245213e-6LF + z * (-2.50507477628578072866e-8LF + z * 1.58962301576546568060e-10LF)))));
  double c = 1.0LF - 0.5LF * z + z * z * (4.16666666666665929218e-2LF + z * (-1.38888888888730564116e-3LF +
                 z * (2.48015872888517045348e-5LF + z * (-2.75573141792967388112e-7LF + z * (2.08757008419747316778e-9LF -
                 z * 1.13585365213876817300e-11LF)))));
  int quadrant = int(n - 4.0LF * floor(0.25LF * n));
  if (quadrant == 1) return dvec2(c, -s);
  if (quadrant == 2) return dvec2(-s, -c);
  return quadrant == 3 ? dvec2(-c, s) : dvec2(s, c);
}

double d_exponential(double x) {
  if (isnan(x)) return x;
  if (!(x < 709.0LF)) return 1e300LF * 1e300LF;
  if (x < -708.0LF) return 0.0LF;
  double n = floor(1.4426950408889634073599LF * x + 0.5LF);
  double r = (x - n * 6.93145751953125e-1LF) - n * 1.42860682030941723212e-6LF, z = r * r;
  double p = r * (9.99999999999999999910e-1LF + z * (3.02994407707441961300e-2LF + z * 1.26177193074810590878e-4LF));
  double q = 2.00000000000000000005LF + z * (2.27265548208155028766e-1LF + z * (2.52448340349684104192e-3LF +
                 z * 3.00198505138664455042e-6LF));
  return ldexp(1.0LF + 2.0LF * (p / (q - p)), int(n));
}

double d_logarithm(double x) {
  if (!(x > 0.0LF)) return x == 0.0LF ? -1e300LF * 1e300LF : double(uintBitsToFloat(0x7fc00000u));
  int n;
  double m = frexp(x, n);
  if (m < 0.70710678118654752440LF) {
    m = 2.0LF * m;
    n -= 1;
  }
  m -= 1.0LF;
  double z = m * m;
  double p = 7.70838733755885391666LF + m * (1.79368678507819816313e1LF + m * (1.44989225341610930846e1LF +
                 m * (4.70579119878881725854LF + m * (4.97494994976747001425e-1LF + m * 1.01875663804580931796e-4LF))));
  double q = 2.31251620126765340583e1LF + m * (7.11544750618563894466e1LF + m * (8.29875266912776603211e1LF +
                 m * (4.52279145837532221105e1LF + m * (1.12873587189167450590e1LF + m))));
  double y = m * (z * p / q) - double(n) * 2.121944400546905827679e-4LF - 0.5LF * z;
  return (m + y) + double(n) * 0.693359375LF;
}

dvec4 d_constant(double c) { return dvec4(0.0LF, 0.0LF, 0.0LF, c); }
dvec4 d_mul(dvec4 a, dvec4 b) { return dvec4(b.w * a.xyz + a.w * b.xyz, a.w * b.w); }
dvec4 d_div(dvec4 a, dvec4 b) {
  double quotient = a.w / b.w;
  return dvec4((a.xyz - quotient * b.xyz) / b.w, quotient);
}
dvec4 d_power(dvec4 a, int n) {
  double power = n >= 0 ? d_whole_power(a.w, n) : 1.0LF / d_whole_power(a.w, -n);
  double before = n >= 1 ? d_whole_power(a.w, n - 1) : 1.0LF / d_whole_power(a.w, 1 - n);
  return dvec4(n == 0 ? dvec3(0.0LF) : double(n) * before * a.xyz, power);
}
dvec4 d_sqrt(dvec4 a) {
  double root = sqrt(a.w);
  return dvec4(a.xyz * (0.5LF / root), root);
}
dvec4 d_abs(dvec4 a) { return a.w < 0.0LF ? -a : a; }
dvec4 d_sin(dvec4 a) {
  dvec2 wave = d_wave(a.w);
  return dvec4(wave.y * a.xyz, wave.x);
}
dvec4 d_cos(dvec4 a) {
  dvec2 wave = d_wave(a.w);
  return dvec4(-wave.x * a.xyz, wave.y);
}
dvec4 d_exp(dvec4 a) {
  double power = d_exponential(a.w);
  return dvec4(power * a.xyz, power);
}
dvec4 d_log(dvec4 a) { return dvec4(a.xyz / a.w, d_logarithm(a.w)); }
dvec4 d_min(dvec4 a, dvec4 b) { return b.w < a.w ? b : a; }
dvec4 d_max(dvec4 a, dvec4 b) { return a.w < b.w ? b : a; }
dvec4 d_real_power(dvec4 a, dvec4 b) { return d_exp(d_mul(b, d_log(a))); }
