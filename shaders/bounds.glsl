// Interval arithmetic in floats, rounded outwards by more than any driver's rounding: numbers between two ends, together
// with bounds on their change along a ray (Mitchell 1990). And the same functions of a value with its gradient. Twin of
// raytrace/precision/bounds.h; the functions that drivers are free to round coarsely are worked out here (Moshier's Cephes
// library: within 2e-7 of the true ones).

struct Slope {
  vec2 v;  // the value lies between these
  vec2 d;  // and its change per unit of the ray's parameter between these
};

bool ambiguous;   // somewhere in the arguments there was no value, or a jump
bool nothing;  // there was no value at all

const float huge = 3e38;
const float no_value = uintBitsToFloat(0x7fc00000u);  // NaN: of a logarithm below 0, as on the processor
const float outward_share = 4.8e-7;  // four units in the last place

vec2 outward(vec2 b) { return b + vec2(-1.0, 1.0) * (abs(b) * outward_share + 1e-37); }
vec2 anything() {
  ambiguous = true;
  return vec2(-huge, huge);
}
vec2 checked(vec2 b) { return any(isnan(b)) ? anything() : outward(b); }

vec2 i_add(vec2 a, vec2 b) { return checked(a + b); }
vec2 i_sub(vec2 a, vec2 b) { return checked(a - b.yx); }
vec2 i_mul(vec2 a, vec2 b) {
  vec4 p = vec4(a.x * b, a.y * b);
  return checked(vec2(min(min(p.x, p.y), min(p.z, p.w)), max(max(p.x, p.y), max(p.z, p.w))));
}
vec2 i_inverse(vec2 a) {
  if (a.x <= 0.0 && a.y >= 0.0) return anything();
  return checked(1.0 / a.yx);
}
// n from 0 to 64 (Expression::max_whole_power), a constant wherever it is called, so that of this only the products stay.
// As a loop, each call would be one for the compiler to reason about, which took it minutes in larger programs.
float f_power(float a, int n) {
  float a2 = a * a, a4 = a2 * a2, a8 = a4 * a4, a16 = a8 * a8, a32 = a16 * a16;
  float result = (n & 1) != 0 ? a : 1.0;
  if ((n & 2) != 0) result *= a2;
  if ((n & 4) != 0) result *= a4;
  if ((n & 8) != 0) result *= a8;
  if ((n & 16) != 0) result *= a16;
  if ((n & 32) != 0) result *= a32;
  if ((n & 64) != 0) result *= a32 * a32;
  return result;
}
vec2 i_positive_power(vec2 a, int n) {
  if (n == 0) return vec2(1.0);
  if (n == 1) return a;
  vec2 ends = vec2(f_power(a.x, n), f_power(a.y, n));
  float share = 1.0 + outward_share * 12.0;  // up to twelve products
  if ((n & 1) != 0) return checked(mix(ends * share, ends / share, bvec2(ends.x > 0.0, ends.y < 0.0)));
  vec2 size = vec2(min(ends.x, ends.y) / share, max(ends.x, ends.y) * share);
  if (a.x <= 0.0 && a.y >= 0.0) size.x = 0.0;
  return vec2(size.x, outward(size).y);
}
vec2 i_power(vec2 a, int n) {
  vec2 power = i_positive_power(a, abs(n));
  return n < 0 ? i_inverse(power) : power;
}
vec2 i_sqrt(vec2 a) {
  if (a.y < 0.0) nothing = true;
  if (a.x < 0.0) ambiguous = true;
  vec2 root = checked(sqrt(max(a, 0.0)));
  return vec2(max(root.x, 0.0), root.y);
}
vec2 i_abs(vec2 a) {
  if (a.x >= 0.0) return a;
  return a.y <= 0.0 ? -a.yx : vec2(0.0, max(-a.x, a.y));
}

float quarter_turns(float x, out int quadrant) {  // Cody and Waite: pi / 2 in three parts
  float n = floor(x * 0.636619772 + 0.5);
  quadrant = int(n) & 3;
  return ((x - n * 1.5703125) - n * 4.837512969970703125e-4) - n * 7.54978995489188216e-8;
}
float f_sin(float x) {
  int quadrant;
  float r = quarter_turns(x, quadrant), s = r * r, wave;
  if ((quadrant & 1) == 0)
    wave = r + r * s * (-1.6666654611e-1 + s * (8.3321608736e-3 - s * 1.9515295891e-4));
  else
    wave = 1.0 - 0.5 * s + s * s * (4.166664568298827e-2 + s * (-1.388731625493765e-3 + s * 2.443315711809948e-5));
  return (quadrant & 2) == 0 ? wave : -wave;
}
float f_cos(float x) {
  int quadrant;
  float r = quarter_turns(x, quadrant), s = r * r, wave;
  if ((quadrant & 1) == 1)
    wave = r + r * s * (-1.6666654611e-1 + s * (8.3321608736e-3 - s * 1.9515295891e-4));
  else
    wave = 1.0 - 0.5 * s + s * s * (4.166664568298827e-2 + s * (-1.388731625493765e-3 + s * 2.443315711809948e-5));
  return quadrant == 1 || quadrant == 2 ? -wave : wave;
}
float f_exp(float x) {
  if (isnan(x)) return x;
  if (!(x < 88.0)) return huge;
  if (x < -87.0) return 0.0;
  float n = floor(x * 1.44269504 + 0.5);
  float r = (x - n * 0.693359375) + n * 2.12194440e-4;
  float p = ((((1.9875691500e-4 * r + 1.3981999507e-3) * r + 8.3334519073e-3) * r + 4.1665795894e-2) * r +
             1.6666665459e-1) * r + 5.0000001201e-1;
  return ldexp(1.0 + r + r * r * p, int(n));
}
float f_log(float x) {
  if (!(x > 0.0)) return x == 0.0 ? -huge : no_value;
  int n;
  float m = frexp(x, n);
  if (m < 0.707106781) {
    m = 2.0 * m;
    n -= 1;
  }
  m -= 1.0;
  float s = m * m;
  float p = ((((((((7.0376836292e-2 * m - 1.1514610310e-1) * m + 1.1676998740e-1) * m - 1.2420140846e-1) * m +
                 1.4249322787e-1) * m - 1.6668057665e-1) * m + 2.0000714765e-1) * m - 2.4999993993e-1) * m +
             3.3333331174e-1) * m * s;
  return float(n) * 0.693147181 + (m - 0.5 * s + p);
}

bool holds_whole(vec2 turns) { return floor(turns.y) >= ceil(turns.x); }
// crest: the turn at which the wave is 1.
vec2 i_wave(vec2 a, float crest, vec2 ends) {
  if (any(greaterThan(abs(a), vec2(1e4)))) return vec2(-1.0, 1.0);
  vec2 turns = a * 0.159154943 + vec2(-1e-3, 1e-3);
  vec2 wave = vec2(min(ends.x, ends.y), max(ends.x, ends.y)) + vec2(-1e-6, 1e-6);
  if (holds_whole(turns - crest)) wave.y = 1.0;
  if (holds_whole(turns - crest - 0.5)) wave.x = -1.0;
  return wave;
}
vec2 i_sin(vec2 a) { return i_wave(a, 0.25, vec2(f_sin(a.x), f_sin(a.y))); }
vec2 i_cos(vec2 a) { return i_wave(a, 0.0, vec2(f_cos(a.x), f_cos(a.y))); }
vec2 i_exp(vec2 a) {
  vec2 power = checked(vec2(f_exp(a.x), f_exp(a.y)));
  return vec2(max(power.x, 0.0), power.y);
}
vec2 i_log(vec2 a) {
  if (a.y <= 0.0) nothing = true;
  if (a.x <= 0.0) ambiguous = true;
  vec2 ends = vec2(a.x > 0.0 ? f_log(a.x) : -huge, a.y > 0.0 ? f_log(a.y) : -huge);
  return outward(ends) + vec2(-1e-6, 1e-6);
}

Slope s_constant(float lo, float hi) { return Slope(vec2(lo, hi), vec2(0.0)); }
Slope s_neg(Slope a) { return Slope(-a.v.yx, -a.d.yx); }
Slope s_add(Slope a, Slope b) { return Slope(i_add(a.v, b.v), i_add(a.d, b.d)); }
Slope s_sub(Slope a, Slope b) { return Slope(i_sub(a.v, b.v), i_sub(a.d, b.d)); }
Slope s_mul(Slope a, Slope b) { return Slope(i_mul(a.v, b.v), i_add(i_mul(a.v, b.d), i_mul(b.v, a.d))); }
Slope s_div(Slope a, Slope b) {
  vec2 inverse = i_inverse(b.v), quotient = i_mul(a.v, inverse);
  return Slope(quotient, i_mul(inverse, i_sub(a.d, i_mul(quotient, b.d))));
}
Slope s_power(Slope a, int n) {
  return Slope(i_power(a.v, n), i_mul(i_mul(vec2(float(n)), i_power(a.v, n - 1)), a.d));
}
Slope s_sqrt(Slope a) {
  vec2 root = i_sqrt(a.v);
  vec2 half_inverse = root.x > 0.0 ? i_mul(vec2(0.5), i_inverse(root)) : vec2(0.5 / max(root.y, 1e-37), huge);
  return Slope(root, i_mul(half_inverse, a.d));
}
Slope s_abs(Slope a) {
  if (a.v.x >= 0.0) return a;
  if (a.v.y <= 0.0) return s_neg(a);
  return Slope(i_abs(a.v), i_mul(vec2(-1.0, 1.0), a.d));
}
Slope s_sin(Slope a) { return Slope(i_sin(a.v), i_mul(i_cos(a.v), a.d)); }
Slope s_cos(Slope a) { return Slope(i_cos(a.v), i_mul(-i_sin(a.v).yx, a.d)); }
Slope s_exp(Slope a) {
  vec2 power = i_exp(a.v);
  return Slope(power, i_mul(power, a.d));
}
Slope s_log(Slope a) { return Slope(i_log(a.v), i_mul(i_inverse(a.v), a.d)); }
Slope s_min(Slope a, Slope b) {
  if (a.v.y < b.v.x) return a;
  if (b.v.y < a.v.x) return b;
  return Slope(min(a.v, b.v), vec2(min(a.d.x, b.d.x), max(a.d.y, b.d.y)));
}
Slope s_max(Slope a, Slope b) { return s_neg(s_min(s_neg(a), s_neg(b))); }
Slope s_real_power(Slope a, Slope b) { return s_exp(s_mul(b, s_log(a))); }

// A value (w) and its gradient (xyz).
vec4 g_constant(float c) { return vec4(0.0, 0.0, 0.0, c); }
vec4 g_mul(vec4 a, vec4 b) { return vec4(b.w * a.xyz + a.w * b.xyz, a.w * b.w); }
vec4 g_div(vec4 a, vec4 b) {
  float quotient = a.w / b.w;
  return vec4((a.xyz - quotient * b.xyz) / b.w, quotient);
}
vec4 g_power(vec4 a, int n) {
  float power = n >= 0 ? f_power(a.w, n) : 1.0 / f_power(a.w, -n);
  float before = n >= 1 ? f_power(a.w, n - 1) : 1.0 / f_power(a.w, 1 - n);
  return vec4(n == 0 ? vec3(0.0) : float(n) * before * a.xyz, power);
}
vec4 g_sqrt(vec4 a) {
  float root = sqrt(a.w);
  return vec4(a.xyz * (0.5 / root), root);
}
vec4 g_abs(vec4 a) { return a.w < 0.0 ? -a : a; }
vec4 g_sin(vec4 a) { return vec4(f_cos(a.w) * a.xyz, f_sin(a.w)); }
vec4 g_cos(vec4 a) { return vec4(-f_sin(a.w) * a.xyz, f_cos(a.w)); }
vec4 g_exp(vec4 a) {
  float power = f_exp(a.w);
  return vec4(power * a.xyz, power);
}
vec4 g_log(vec4 a) { return vec4(a.xyz / a.w, f_log(a.w)); }
vec4 g_min(vec4 a, vec4 b) { return b.w < a.w ? b : a; }
vec4 g_max(vec4 a, vec4 b) { return a.w < b.w ? b : a; }
vec4 g_real_power(vec4 a, vec4 b) { return g_exp(g_mul(b, g_log(a))); }
